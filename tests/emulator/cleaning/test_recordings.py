"""Cleaning on public recordings: the known glitches are found, clean movements are left."""

import numpy as np
import pytest

from emulator.cleaning import cleaned
from emulator.recordings.npz import read_recording
from tests.made_takes import same
from tests.recordings import recording


def test_the_glitched_squats_are_found_and_at_most_two_others():
    done = cleaned(read_recording(recording("hdm05_squat_once")))
    glitched = {repair.take for repair in done.repairs if repair.kind == "glitch"}
    known = {"dg/026", "dg/027", "dg/028", "dg/030"}
    assert glitched >= known and len(glitched - known) <= 2
    assert {name for name in done.names if done.verdict(name) == "bad"} >= known


@pytest.mark.parametrize("name", ["uiprmd_deep_squat", "uiprmd_leg_raise", "hdm05_jog_circle", "hdm05_sneak_2steps"])
def test_recordings_without_faults_go_through_to_the_bit(name):
    before = read_recording(recording(name))
    done = cleaned(before)
    assert same(before, done.recording) and not any(repair.mended or repair.bad for repair in done.repairs)


def test_a_spike_in_a_real_squat_is_mended_to_a_few_millimetres():
    before = read_recording(recording("uiprmd_deep_squat"))
    take = before.takes[3]
    wrist = take.names.index("left_wrist")
    spoiled = take.positions_m.copy()
    spoiled[60:64, wrist] += [0.1, 0.2, -0.1]
    from dataclasses import replace

    changed = replace(before, takes=(*before.takes[:3], replace(take, positions_m=spoiled), *before.takes[4:]))
    done = cleaned(changed)
    assert [(r.kind, r.joints, r.first_frame, r.last_frame) for r in done.repairs if r.mended] == [
        ("glitch", ("left_wrist",), 60, 63)
    ]
    assert np.linalg.norm(done.recording.takes[3].positions_m - take.positions_m, axis=-1).max() < 0.003
