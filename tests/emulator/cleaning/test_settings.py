from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import POLICIES, CleaningSettings, cleaned, settings_of
from emulator.cleaning.settings import beyond_rate, mistakes
from emulator.recordings.body_size import size_m
from tests.made.takes import clean


def test_the_first_policy_is_what_is_done_unless_asked():
    usual = CleaningSettings()
    assert {name: getattr(usual, name) for name in POLICIES} == {name: known[0] for name, known in POLICIES.items()}


def test_everything_that_is_wrong_is_said_at_once_with_the_nearest_word():
    with pytest.raises(ValueError) as said:
        settings_of({"jump": "off", "bones": "rigid", "rigid_m": float("nan"), "kept_share": 2.0, "noise_m": True})
    lines = str(said.value).splitlines()
    assert lines[0] == "no setting 'jump'; did you mean 'jumps'?"
    assert "bones: found 'rigid', expected tell or mend or off" in lines
    assert "rigid_m: found nan, expected a positive number" in lines
    assert "kept_share: found 2.0, expected a share up to 1" in lines
    assert "noise_m: found True, expected a positive number" in lines


@pytest.mark.parametrize(
    ("given", "said"),
    [({"filled_gap_s": 0.1}, "bridged_gap_s or more"), ({"tallest_m": 0.5}, "more than shortest_m")],
)
def test_numbers_that_contradict_each_other_are_refused(given, said):
    with pytest.raises(ValueError, match=said):
        settings_of(given)


def test_a_time_in_frames_does_not_lose_one_to_rounding():
    assert CleaningSettings().frames(0.3, 10.0) == 3 and CleaningSettings().frames(0.2, 60.0) == 12


def test_numbers_beyond_all_reason_and_contradictions_are_said_together():
    with pytest.raises(ValueError) as said:
        settings_of({"noise_m": -1.0, "tolerance_deg": 400.0, "kept_share": float("nan"), "filled_gap_s": 0.1})
    lines = str(said.value).splitlines()
    assert "noise_m: found -1.0, expected a positive number" in lines
    assert "tolerance_deg: found 400.0, expected 180 at most" in lines
    assert "kept_share: found nan, expected a positive number" in lines
    assert "filled_gap_s: found 0.1, expected bridged_gap_s or more (0.2)" in lines


def test_a_cut_off_needs_room_below_half_the_frame_rate():
    assert beyond_rate(29.9, 60.0) == [] == beyond_rate(None, 60.0)
    said = "cut_off_hz: found 30, expected less than 30, half of the recording's 60 frames a second"
    assert beyond_rate(30.0, 60.0) == [said]
    with pytest.raises(ValueError, match="expected less than 25"):
        cleaned(clean(), CleaningSettings(cut_off_hz=500.0))


def changed(change):
    made = clean()
    return replace(made, takes=tuple(replace(take, positions_m=change(take.positions_m)) for take in made.takes))


@pytest.mark.parametrize(
    ("times", "unit"), [(1000.0, "millimetres"), (100.0, "centimetres"), (39.37, "inches"), (10.0, "decimetres")]
)
def test_a_body_in_another_unit_is_refused_with_the_unit_it_would_be(times, unit):
    with pytest.raises(ValueError) as said:
        cleaned(changed(lambda positions: times * positions))
    first = str(said.value).splitlines()[0]
    assert first.startswith("take w1/r1: found ") and "expected 0.6 to 2.6 m" in first and f"in {unit}" in first


def test_all_takes_are_named_but_not_more_than_a_few():
    assert mistakes(changed(lambda p: 1000 * p), CleaningSettings())[-1] == "and 3 more takes of 8"


@pytest.mark.parametrize(("axes", "said"), [([0, 2, 1], "along y"), ([2, 1, 0], "along x")])
def test_a_body_that_stands_along_another_axis_is_refused(axes, said):
    found = mistakes(changed(lambda p: p[..., axes]), CleaningSettings())
    assert len(found) == 1 and said in found[0] and "expected z up" in found[0]


def test_a_body_on_its_head_is_refused():
    assert "on their heads" in mistakes(changed(lambda p: p * [1, -1, -1]), CleaningSettings())[0]


def test_a_joint_that_is_never_seen_is_named():
    def unseen(positions):
        positions = positions.copy()
        positions[:, clean().names.index("left_hand")] = np.nan
        return positions

    assert mistakes(changed(unseen), CleaningSettings()) == [
        "left_hand: found in no frame, expected joints that are seen, or none of this name"
    ]


def test_a_take_in_which_nothing_is_seen_is_refused():
    assert "found no frame" in mistakes(changed(lambda p: np.full_like(p, np.nan)), CleaningSettings())[0]


def test_switched_off_anything_passes():
    assert mistakes(changed(lambda p: 10 * p), CleaningSettings(plausible="off")) == []


def test_the_size_of_a_body_is_that_between_its_farthest_joints():
    assert 1.4 < size_m(clean().takes[0].positions_m) < 2.0
