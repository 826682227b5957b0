from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import CleaningSettings, Repair, verdict_of
from emulator.cleaning.report import impossible, told
from emulator.motion import turn
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


def test_a_body_that_does_not_move_is_told_of_and_not_called_good():
    take = clean("reach", 1, 1).takes[0]
    shaking_m = np.random.default_rng(0).normal(0, 5e-4, (90, *take.positions_m.shape[1:]))
    frozen = np.repeat(take.positions_m[:1], 90, axis=0) + shaking_m
    found = told(replace(take, positions_m=frozen, contact=None), CleaningSettings())
    assert [repair.kind for repair in found] == ["still"] and verdict_of(found) == "told"
    sliding = frozen + np.linspace(0, 1, 90)[:, None, None] * [1.0, 0.0, 0.0]
    assert told(replace(take, positions_m=sliding, contact=None), CleaningSettings()) == ()


def test_what_was_mended_does_not_hide_what_was_left():
    jump = Repair("w/1", "jump", ("head",), 3, 4, 0.1, "m", "jumps; bridged")
    over = Repair("w/1", "angle", ("left_ankle",), 3, 9, 46.0, "deg", "46 deg over; left as it is", False)
    cut = Repair("w/1", "cut", ("head",), 0, 29, 0.6, "s", "not seen; 0.60 s cut off", shortens=True)
    assert verdict_of([jump]) == "repaired" and verdict_of([jump, over]) == "repaired, told"
    assert verdict_of([jump, cut]) == "shortened" and verdict_of([jump, cut, over]) == "shortened, told"


def test_a_bone_that_breathes_much_is_told_of_and_one_that_breathes_a_little_is_not():
    bone = Repair("w/1", "bone", ("left_knee",), 0, 99, 6.7, "%", "breathes; left as it is", False)
    assert verdict_of([bone]) == "told" and verdict_of([replace(bone, size=1.3)]) == "good"
