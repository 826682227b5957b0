from types import SimpleNamespace

import numpy as np
import pytest

from emulator.covariates.body import (
    HEIGHT_SHARES,
    LENGTH_SHARES,
    Body,
    BodyError,
    bone_lengths_m,
    not_in_the_table,
    stature_m,
)
from emulator.skeleton import CANONICAL, Skeleton, standard_skeleton
from emulator.synthetic.choreography import REST, STATURE_M, joints_m
from emulator.synthetic.choreography import Body as LimbBody


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


SKELETON = standard_skeleton()
MADE_M = SKELETON.bone_lengths(joints_m({name: value[None] for name, value in REST.items()}, LimbBody()))[0]


def lengths(height_m, **named):
    return dict(zip(SKELETON.bone_names, bone_lengths_m(SKELETON, height_m, MADE_M, **named)))


def test_limbs_are_those_of_the_table():
    bone = lengths(1.80)
    for side in ("left", "right"):
        assert bone[f"{side}_knee"] == pytest.approx(0.245 * 1.80)
        assert bone[f"{side}_ankle"] == pytest.approx(0.246 * 1.80)
        assert bone[f"{side}_elbow"] == pytest.approx(0.186 * 1.80)
        assert bone[f"{side}_wrist"] == pytest.approx(0.146 * 1.80)


def test_the_table_agrees_with_itself():
    at, long = HEIGHT_SHARES, LENGTH_SHARES
    assert at["hip"] - at["knee"] == pytest.approx(long["thigh"])
    assert at["knee"] - at["ankle"] == pytest.approx(long["shank"])
    assert at["elbow"] - at["wrist"] == pytest.approx(long["forearm"], abs=0.002)
    assert at["wrist"] - at["fingertip"] == pytest.approx(long["hand"])
    assert at["shoulder"] - at["elbow"] == pytest.approx(long["upper_arm"], abs=0.003)


@pytest.mark.parametrize("height_m", [1.5, 1.75, 2.0])
def test_the_chain_from_floor_to_crown_is_the_stature(height_m):
    """Sole to ankle by the table, leg, trunk and head, and 10 cm in 1.75 m from the head joint to the crown."""
    bone = lengths(height_m, reference_height_m=STATURE_M)
    legs = HEIGHT_SHARES["ankle"] * height_m + bone["left_ankle"] + bone["left_knee"]
    above = 0.05 / STATURE_M * height_m + sum(bone[name] for name in ("spine", "chest", "neck", "head"))
    assert legs + above + 0.10 / STATURE_M * height_m == pytest.approx(height_m, rel=0.02)


def test_every_bone_grows_with_stature():
    short, tall = (np.array(list(lengths(height_m).values())) for height_m in (1.6, 1.61))
    assert np.all(tall > short)
    assert np.allclose(tall / short, 1.61 / 1.6)


def test_bones_that_the_table_does_not_give_keep_the_reference_s_proportion():
    bone = lengths(1.575, reference_height_m=STATURE_M)
    reference = dict(zip(SKELETON.bone_names, MADE_M))
    missing = not_in_the_table(SKELETON)
    assert len(missing) == 12
    assert all(bone[name] == pytest.approx(0.9 * reference[name]) for name in missing)


def test_the_stature_of_bones_from_the_table_is_found_again():
    assert stature_m(SKELETON, bone_lengths_m(SKELETON, 1.68, MADE_M)) == pytest.approx(1.68)


def test_a_height_that_nobody_has_is_refused():
    with pytest.raises(BodyError, match=r"height_m: found 168, expected 0\.9 to 2\.4"):
        bone_lengths_m(SKELETON, 168, MADE_M)


def test_lengths_of_another_skeleton_are_refused():
    with pytest.raises(ValueError, match=r"found \(3,\), expected \(20,\) lengths"):
        stature_m(SKELETON, np.ones(3))
    tail = Skeleton(CANONICAL[:3], (-1, 0, 1))
    with pytest.raises(ValueError, match="none of left_knee, left_ankle"):
        stature_m(tail, np.ones(2))


def test_the_reference_is_left_alone():
    before = MADE_M.tobytes()
    bone_lengths_m(SKELETON, 1.9, MADE_M)
    assert MADE_M.tobytes() == before
