from types import SimpleNamespace

import pytest

from emulator.covariates.body import Body, BodyError


def test_everything_is_optional():
    assert Body().known == {}
    assert Body(height_m=1.7, other={"grip_n": 400}).known == {"height_m": 1.7, "grip_n": 400.0}


def test_all_mistakes_are_said_at_once_with_what_was_perhaps_meant():
    with pytest.raises(BodyError) as wrong:
        Body(height_m=162, mass_kg=5, age_years=True, sex="", pace=110, other={"grip": float("nan"), "height": 1.7})
    assert wrong.value.mistakes == (
        "body: height_m: found 162, expected 0.9 to 2.4 (metres); did you mean 1.62?",
        "body: mass_kg: found 5, expected 25 to 300 (kilograms)",
        "body: age_years: found True, expected a number",
        "body: pace: found 110, expected 0.3 to 3 (a ratio: 1.1 is a tenth faster than usual); did you mean 1.1?",
        "body: sex: found '', expected a word: 'f', 'm' or another",
        "body: other: height_m has a place of its own",
        "body: grip: found nan, expected a number",
    )


@pytest.mark.parametrize("word, is_", [("Female", "f"), ("w", "f"), (" man ", "m"), ("Diverse", "diverse")])
def test_words_for_sexes_are_understood(word, is_):
    assert Body(sex=word).sex == is_


def test_a_body_comes_from_a_mapping_an_object_or_nothing():
    assert Body.of({"stature": 1.6, "weight": 60, "gender": "m"}) == Body(1.6, 60, sex="m")
    assert Body.of(SimpleNamespace(height_m=1.6, walk=1.2)) == Body(1.6)
    assert Body.of(None) == Body()
    assert Body.of({"height_m": 1.6, "grip_n": 300, "reach_m": None}, ("grip_n", "reach_m")).other == {"grip_n": 300}


def test_unknown_words_of_a_mapping_are_refused_with_the_nearest():
    with pytest.raises(BodyError, match="no 'heigth'; did you mean 'height_m'") as wrong:
        Body.of({"heigth": 1.6, "zzz": 1})
    assert len(wrong.value.mistakes) == 2


def test_a_tenth_faster_takes_an_eleventh_less_time():
    assert 2.718281828459045 ** Body(pace=1.1).log_duration_shift == pytest.approx(1 / 1.1)
    assert Body().log_duration_shift == 0.0
