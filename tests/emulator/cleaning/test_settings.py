import pytest

from emulator.cleaning import POLICIES, CleaningSettings, cleaned, settings_of
from emulator.cleaning.settings import beyond_rate
from tests.made_takes import clean


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
