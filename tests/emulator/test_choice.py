from functools import cache

import numpy as np
import pytest

from emulator.fitting.registration import registered
from emulator.fitting.settings import FitSettings
from emulator.judge.prediction import Choice, chosen, dealt_folds, energy_scores, people_folds
from emulator.model.emulator import SCHEME, SCHEMES, MotionEmulator
from emulator.synthetic.tasks import make


def scored(draws, real):
    return energy_scores(np.abs(draws[:, None] - real), np.abs(draws[:, None] - draws)).mean()


def test_the_energy_score_of_a_normal_law_is_known():
    """E|X - y| - E|X - X'| / 2 for standard normal X at y = 0: sqrt(2 / pi) - 1 / sqrt(pi) (Gneiting & Raftery)."""
    draws = np.random.default_rng(0).standard_normal(4000)
    assert scored(draws, np.zeros(1)) == pytest.approx(np.sqrt(2 / np.pi) - 1 / np.sqrt(np.pi), abs=0.02)


@pytest.mark.parametrize("wrong", [0.0, 0.4, 2.0])
def test_draws_that_vary_too_little_or_too_much_score_worse_than_the_truth(wrong):
    rng = np.random.default_rng(1)
    real, draws = rng.standard_normal(500), rng.standard_normal(500)
    assert scored(draws, real) < scored(wrong * draws, real) - 0.02


def test_repetitions_are_dealt_once_each_and_never_all_of_a_person():
    index = np.repeat([0, 1, 2, 3], [7, 5, 2, 1])
    folds = dealt_folds(index, np.random.default_rng(0))
    assert np.array_equal(np.sum(folds, axis=0), index != 3)
    for fold in folds:
        assert all(np.any(~fold[index == worker]) for worker in range(4))


def test_people_are_held_out_whole_and_once():
    index = np.repeat(np.arange(23), 2)
    folds = people_folds(index)
    assert len(folds) == 10 and np.array_equal(np.sum(folds, axis=0), np.ones(46))
    assert all(len({bool(fold[i]) for i in np.flatnonzero(index == w)}) == 1 for fold in folds for w in range(23))
    assert people_folds(np.zeros(5, int)) == []


def test_the_smallest_mean_over_the_best_is_chosen_and_the_reason_counts_people():
    index = np.repeat([0, 1, 2], 2)
    scores = {
        "a": {"repetitions": np.full(6, 1.0), "workers": np.array([2.0, 2, 2, 2, 5, 5])},
        "b": {"repetitions": np.full(6, 1.2), "workers": np.array([3.0, 3, 3, 3, 3, 3])},
    }
    found = chosen(scores, index)
    assert found.scheme == "a" and found.scores["a"] == {"repetitions": 1.0, "workers": 3.0}
    assert found.why == (
        "a rather than b: energy score of repetitions held out 1.000 against 1.200 (better for 3 of 3 people); "
        "people held out 3.000 against 3.000 (better for 2 of 3 people, less apart than the standard error over people)"
    )


def test_what_was_never_held_out_does_not_count():
    values = {"repetitions": np.array([1.0, np.nan, 3.0])}
    assert chosen({"a": values}, np.array([0, 0, 1])) == Choice(
        "a", {"a": {"repetitions": 2.0}}, "a: the only one asked about"
    )


@cache
def fitted():
    motions, _ = make("pick", 3, 4, seed=2)
    return MotionEmulator.fit(motions, scheme="auto", n_times=21, n_knots=8)


@pytest.mark.slow
def test_auto_gives_one_of_the_schemes_and_says_why():
    report = fitted().report
    assert report.scheme in SCHEMES
    assert report.methods["scheme"].startswith(f"{report.scheme} (best of {len(SCHEMES)}, next ")
    assert "repetitions held out" in report.methods["scheme"] and "people held out" in report.methods["scheme"]
    assert ("scheme, chosen", report.methods["scheme"]) in report.rows()


@pytest.mark.slow
def test_auto_is_the_chosen_scheme_and_nothing_else():
    motions, _ = make("pick", 3, 4, seed=2)
    named = MotionEmulator.fit(motions, scheme=fitted().report.scheme, n_times=21, n_knots=8)
    drawn = [model.sample(5, np.random.default_rng(0)) for model in (fitted(), named)]
    assert np.array_equal(drawn[0].scores, drawn[1].scores)


@pytest.mark.slow
def test_one_person_is_judged_by_his_repetitions_alone():
    motions, _ = make("pick", 1, 6, seed=2)
    said = MotionEmulator.fit(motions, scheme="auto", n_times=21, n_knots=8).report.methods["scheme"]
    assert "repetitions held out" in said and "people held out" not in said


def test_where_nothing_can_be_held_out_auto_is_refused():
    motions, _ = make("pick", 3, 1, seed=2)
    with pytest.raises(ValueError, match="nothing can be held out of so few repetitions; name a scheme"):
        MotionEmulator.fit(motions, scheme="auto", n_times=21, n_knots=8)


def test_a_subset_is_the_same_repetitions():
    motions, _ = make("pick", 2, 3, seed=2)
    made = registered(motions, FitSettings(SCHEME, None, 21, 8, 0.0, 0, ""), None)
    part = made.subset(np.array([True, False, True, False, True, False]))
    assert [m.name for m in part.moving.motions] == [made.moving.motions[i].name for i in (0, 2, 4)]
    assert np.array_equal(part.warps, made.warps[::2]) and len(part.holds) == 3
