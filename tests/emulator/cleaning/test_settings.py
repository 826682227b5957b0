import pytest

from emulator.cleaning import POLICIES, CleaningSettings, settings_of


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
