import numpy as np
import pytest

from emulator.judge.clips import Clips
from emulator.judge.kinematic_test import (
    area_under_curve,
    feature_names,
    features,
    filled,
    kinematic_test,
    logistic,
)
from tests.emulator.judge.made_clips import NO_FEET, clips, still, waved


def test_two_samples_of_one_law_cannot_be_told_apart():
    found = [
        kinematic_test(waved(20, rng), waved(20, rng), rng, n_permutations=9)
        for rng in (np.random.default_rng(seed) for seed in range(6))
    ]
    assert abs(np.mean([test.auc for test in found]) - 0.5) < 0.1
    assert sum(test.p <= 0.1 for test in found) <= 2


def test_a_sample_that_trembles_is_told_apart():
    rng = np.random.default_rng(1)
    found = kinematic_test(waved(15, rng), waved(15, rng, shake_m=0.005), rng, n_permutations=19)
    assert found.auc > 0.98 and found.p == 0.05 and found.null_95 < 0.8
    assert found.telling[1] > 0.95


def test_a_sample_of_other_spread_but_one_mean_is_told_by_the_squares():
    rng = np.random.default_rng(2)
    assert kinematic_test(waved(40, rng, size=0.02), waved(40, rng, size=0.6), rng, n_permutations=0).auc > 0.8


def test_of_pairs_that_hardly_differ_nothing_is_learnt_by_heart():
    rng = np.random.default_rng(3)
    recorded = waved(20, rng)
    again = Clips(
        recorded.skeleton,
        tuple(p + 1e-7 * rng.normal(size=p.shape) for p in recorded.positions_m),
        recorded.duration_s,
    )
    found = kinematic_test(recorded, again, rng, pairs=True, n_permutations=9)
    assert abs(found.auc - 0.5) < 0.15 and 0.3 < found.null_mean < 0.7


def test_what_lies_above_six_hertz_is_not_looked_at():
    time_s = np.linspace(0, 2, 241)
    rates = []
    for hz in (1.0, 25.0):
        body = still(241)
        body[:, :, 0] += 0.001 * np.sin(2 * np.pi * hz * time_s)[:, None]
        rates.append(np.exp(features(clips(body))[0, 4]) - 0.01)
    assert rates[1] < 0.1 * rates[0]  # as drawn it would be 25 times as fast


def test_features_of_a_body_without_feet_leave_the_feet_out():
    body = np.cumsum(np.random.default_rng(0).normal(size=(40, 3, 3)), axis=0)
    made = clips(body, skeleton=NO_FEET)
    assert features(made).shape == (1, len(feature_names(made))) == (1, 21)
    assert features(clips(still(3))).shape == (1, 24) and np.isfinite(filled(features(clips(still(3))))).all()


def test_the_area_under_the_curve_counts_pairs():
    score, positive = np.array([1.0, 2.0, 2.0, 3.0]), np.array([False, True, False, True])
    pairs = [(s > t) + 0.5 * (s == t) for s in score[positive] for t in score[~positive]]
    assert area_under_curve(score, positive) == np.mean(pairs) == 0.875


def test_the_logistic_curve_is_at_its_least():
    rng = np.random.default_rng(4)
    x, y = rng.normal(size=(60, 3)), rng.random(60) < 0.3
    beta = logistic(x, y, ridge=0.7)
    weight = np.where(y, 0.5 / y.mean(), 0.5 / (1 - y.mean()))

    def loss(b):
        line = b[0] + x @ b[1:]
        return np.sum(weight * (np.log1p(np.exp(line)) - y * line)) + 0.35 * np.sum(b[1:] ** 2)

    assert all(loss(beta) <= loss(beta + 0.02 * step) for step in rng.normal(size=(50, 4)))


@pytest.mark.parametrize(("n", "m", "pairs"), [(2, 9, False), (9, 2, False), (9, 8, True)])
def test_too_few_or_unequal_pairs_are_refused(n, m, pairs):
    rng = np.random.default_rng(0)
    with pytest.raises(ValueError, match=f"found {n} recorded and {m} drawn"):
        kinematic_test(waved(n, rng), waved(m, rng), rng, pairs=pairs)
