from dataclasses import replace

import numpy as np
import pytest

from emulator.clean import turn
from emulator.cleaning import CleaningSettings
from emulator.cleaning.told import impossible, told
from tests.made_takes import clean


def test_a_full_turn_is_told_as_one():
    take = clean("walk", 1, 1).takes[0]
    yaw = np.linspace(0, 2 * np.pi, take.n_frames)[:, None]
    found = told(replace(take, positions_m=turn(take.positions_m, yaw)), CleaningSettings())
    heading = [repair for repair in found if repair.kind == "heading"]
    assert len(heading) == 1 and heading[0].size == pytest.approx(360, abs=15) and not heading[0].mended


def test_a_pause_is_told_where_it_is():
    take = clean("reach", 1, 1).takes[0]
    held = np.concatenate(
        [take.positions_m[:40], np.repeat(take.positions_m[40:41], 50, axis=0), take.positions_m[40:]]
    )
    found = told(replace(take, positions_m=held, contact=None), CleaningSettings(heading="off"))
    assert [repair.kind for repair in found] == ["hold"]
    assert abs(found[0].first_frame - 40) <= 4 and abs(found[0].last_frame - 90) <= 4
    assert told(replace(take, positions_m=held, contact=None), CleaningSettings(holds="off", heading="off")) == ()


def test_points_without_hips_have_no_heading_and_no_pauses():
    take = clean("reach", 1, 1).takes[0]
    assert told(replace(take, parents=None), CleaningSettings()) == ()


def test_what_is_still_faster_than_any_body_is_bad():
    take = clean("reach", 1, 1).takes[0]
    assert impossible(take) == ()
    flying = take.positions_m + np.arange(take.n_frames)[:, None, None] * [0.5, 0.0, 0.0]
    found = impossible(replace(take, positions_m=flying))
    assert found[0].bad and "at most 13" in found[0].words
