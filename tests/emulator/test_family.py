"""A family: recordings of one movement at different places, pooled, fitted together, and told where there is a gap."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from emulator import MotionEmulator, Target, family
from emulator.model.reach import LocalRegression, gaps_m
from emulator.model.recorded_reach import Reach
from emulator.motion import MotionSet
from emulator.synthetic.shelf import MARK, crew, make_shelf
from tests.emulator.test_reach import draws, shelf

MIDDLE_M = 0.9


@cache
def halves():
    """The recordings of ``shelf()``, parted by height into two sets of three people or more."""
    rng = np.random.default_rng(3)
    whole = make_shelf(crew(6, rng), 10, rng=rng)
    low = [motion.covariates["cov_shelf_m"] < MIDDLE_M for motion in whole.motions]
    return tuple(
        replace(whole.subset(np.flatnonzero(np.array(low) == side)), task=name, selection="all")
        for side, name in ((True, "low"), (False, "high"))
    )


def trunk_deg(emulator, height_m):
    given = emulator.given(Target("hands", MARK, height_m=height_m))
    drawn = draws(given, 64)
    bodies = drawn.positions_m(drawn.mark_s)[:, 0]
    pelvis, neck = (emulator.skeleton.names.index(name) for name in ("pelvis", "neck"))
    trunk = bodies[:, neck] - bodies[:, pelvis]
    return np.degrees(np.arccos(trunk[:, 2] / np.linalg.norm(trunk, axis=1))).mean(), drawn.duration_s.mean()


@pytest.mark.slow
def test_halves_pooled_are_as_good_as_fitted_together():
    pooled = MotionEmulator.fit(family("shelf", halves()))
    for height_m in (0.4, 0.9, 1.5):
        (bent, seconds), (true_bent, true_seconds) = trunk_deg(pooled, height_m), trunk_deg(shelf(), height_m)
        assert bent == pytest.approx(true_bent, abs=3.0) and seconds == pytest.approx(true_seconds, rel=0.04)
        assert pooled.reach("hands", MARK).verdict(Target("hands", MARK, height_m=height_m)).word == "fine"


def test_people_of_one_name_are_one_person_and_trials_tell_whose_they_were():
    pooled = family("shelf", halves())
    assert pooled.workers == halves()[0].workers == ("w1", "w2", "w3", "w4", "w5", "w6")
    assert len(pooled) == 60 and len({motion.name for motion in pooled.motions}) == 60
    assert {motion.trial.split("/")[0] for motion in pooled.motions} == {"low", "high"}
    assert pooled.notes[0].endswith("6 people, 6 of them in all") and pooled.source == halves()[0].source


def test_marks_in_another_order_are_put_into_the_first_ones():
    low, high = (with_marks(one, ("grasp", "turn"), (0.5, 0.6)) for one in halves())
    turned = with_marks(high, ("turn", "grasp"), (0.6, 0.5))
    for one, other in zip(family("f", (low, high)).motions, family("f", (low, turned)).motions):
        assert np.array_equal(one.mark_s, other.mark_s)


def with_marks(one: MotionSet, names: tuple[str, ...], shares: tuple[float, ...]) -> MotionSet:
    motions = (replace(motion, mark_s=motion.duration_s * np.array(shares)) for motion in one.motions)
    return replace(one, motions=tuple(motions), mark_names=names)


def other_body(one: MotionSet) -> MotionSet:
    skeleton = one.skeleton
    names = tuple("nose" if name == "head" else name for name in skeleton.names)
    return replace(one, motions=tuple(replace(m, skeleton=replace(skeleton, names=names)) for m in one.motions))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda low, high: [low], "found a family of 1, expected two or more"),
        (lambda low, high: [low, replace(high, task="low")], "found 'low' twice"),
        (
            lambda low, high: [low, with_marks(high, ("grap",), (0.5,))],
            "high: found the marks grap, expected those of low: grasp; is 'grap' low's 'grasp'?",
        ),
        (lambda low, high: [with_marks(low, (), ()), with_marks(high, (), ())], "low: found no marks, expected one"),
        (lambda low, high: [low, other_body(high)], "high: found no head and also nose, expected the skeleton of low"),
    ],
)
def test_sets_that_are_no_family_are_told(change, said):
    with pytest.raises(ValueError) as caught:
        family("shelf", change(*halves()))
    assert said in str(caught.value)


def test_all_that_is_wrong_with_a_family_is_told_at_once():
    low, high = halves()
    with pytest.raises(ValueError) as caught:
        family("shelf", [low, other_body(with_marks(high, ("turn",), (0.5,)))])
    assert len(str(caught.value).splitlines()) == 2


# gaps


@pytest.mark.parametrize(
    ("heights_m", "gaps"),
    [
        ([0.1, 0.2, 0.3, 0.4], []),
        ([0.1, 0.2, 0.3, 1.0, 1.1, 1.2], [(0.3, 1.0)]),
        ([0.1, 0.2, 0.3, 0.6, 1.0, 1.1, 1.2], [(0.3, 1.0)]),
        ([0.1, 0.2, 0.3, 1.0], []),
    ],
)
def test_a_gap_has_recordings_on_both_sides_and_hardly_any_within(heights_m, gaps):
    assert gaps_m(np.array(heights_m)[::-1]) == gaps


def reached(*heights_m):
    heights_m = np.array(heights_m)
    return Reach(shelf(), "hands", MARK, np.column_stack([0.0 * heights_m, 0.0 * heights_m, heights_m]))


@pytest.mark.parametrize(
    ("heights_m", "said"),
    [
        ((0.25, 0.3, 0.35, 1.25, 1.3, 1.35), "Between 0.35 and 1.25 m no hand was recorded: heights there are bridged"),
        ((0.2, 0.3, 0.35, 0.8, 1.25, 1.3, 1.35), "only 1 of 7 recordings had a hand there"),
        ((0.1, 0.15, 0.2, 1.4, 1.5, 1.6), "bridged from both sides, those from 0.70 to 0.90 m refused."),
    ],
)
def test_a_gap_is_told_in_a_sentence(heights_m, said):
    (sentence,) = reached(*heights_m).gap_sentences()
    assert said in sentence


@pytest.mark.parametrize(("height_m", "word"), [(0.3, "fine"), (0.8, "stretched"), (1.30, "fine"), (1.50, "refused")])
def test_recordings_on_the_other_side_of_a_gap_do_not_excuse_a_reach_beyond_its_edge(height_m, word):
    reach = reached(0.28, 0.3, 0.32, 1.28, 1.3, 1.32)
    assert reach.verdict(Target("hands", MARK, height_m=height_m)).word == word


def test_in_a_gap_what_is_foretold_lies_between_what_is_on_both_sides():
    """Each side bends by luck, as a few recordings do: a line through one side alone would lead far astray."""
    rng = np.random.default_rng(1)
    place = np.concatenate([rng.normal(0.2, 0.03, 16), rng.normal(1.6, 0.03, 16)])[:, None]
    z = np.where(place < 1.0, 80.0, 10.0) + 5.0 * rng.normal(size=place.shape)
    low, high = gaps_m(place[:, 0])[0]
    at_places = np.linspace(low, high, 30)[:, None]
    for degree, span in ((1, 0.35), (2, 0.7), (2, np.inf)):
        foretold = LocalRegression(z, place, span, degree)(at_places)[:, 0]
        assert np.all(np.diff(foretold) < 0) and 65 < foretold[0] < 95 and -5 < foretold[-1] < 25
