from dataclasses import dataclass

import numpy as np
import pytest

from emulator.fitting.registration import registered
from emulator.fitting.settings import FitSettings
from emulator.judge.prediction import Unseen
from emulator.judge.sequence_distances import distances_numpy
from emulator.model.emulator import SCHEME
from emulator.synthetic.tasks import make
from tests.emulator.judge.made import sequences


@dataclass
class Drawn:
    """Draws as ``MotionPerformances`` has them: their scores are the postures."""

    scores: np.ndarray
    duration_s: np.ndarray

    def aligned_directions(self):
        return self.scores


def unseen(directions, log_s, posture_rad=1.0, log_time=1.0):
    return Unseen(directions, np.asarray(log_s), np.array(["w"] * len(directions)), posture_rad, log_time)


def drawn(n, seed, log_s=0.0, spread=0.4):
    rng = np.random.default_rng([seed, 1])
    return Drawn(sequences(n, spread=spread, seed=seed), np.exp(log_s + rng.normal(size=n)))


def test_scores_are_the_energy_scores_of_posture_and_log_duration_over_their_scales():
    real, draws = sequences(3, seed=0), drawn(5, seed=0)
    log_s, own = np.array([0.3, -0.2, 0.1]), np.log(draws.duration_s)
    got = unseen(real, log_s, posture_rad=2.0, log_time=4.0).scores(draws, np.array([2, 0]))
    for row, i in zip(got, (2, 0)):
        pairs = [(a, b) for a in range(5) for b in range(5) if a != b]
        across, among = distances_numpy(draws.scores, real[[i]]).mean(), distances_numpy(draws.scores)
        posture = across - np.mean([among[pair] for pair in pairs]) / 2
        time = np.mean(np.abs(own - log_s[i])) - np.mean([abs(own[a] - own[b]) for a, b in pairs]) / 2
        assert row == pytest.approx([posture / 2, time / 4], abs=1e-5)


def test_the_law_of_the_recordings_scores_better_than_another():
    there = unseen(sequences(40, seed=0), np.random.default_rng(0).normal(size=40))
    every = np.arange(40)
    true = there.scores(drawn(200, seed=0), every).mean(axis=0)
    assert np.all(true < there.scores(drawn(200, seed=3, log_s=2.0), every).mean(axis=0))
    assert true[0] < there.scores(drawn(200, seed=0, spread=0.01), every).mean(axis=0)[0]
    assert true[0] < there.scores(drawn(200, seed=0, spread=2.0), every).mean(axis=0)[0]


def test_scales_are_the_mean_distances_of_two_recordings():
    made = registered(make("reach", 2, 3, seed=0)[0], FitSettings(SCHEME, None, 21, 8, 0.0, 0, ""), None)
    there = Unseen.of(made)
    among, pairs = distances_numpy(made.directions), ~np.eye(6, dtype=bool)
    assert there.posture_rad == pytest.approx(among[pairs].mean(), rel=1e-5)
    log_s = np.log(made.whole.duration_s)
    assert there.log_time == pytest.approx(np.abs(log_s[:, None] - log_s)[pairs].mean())
    assert there.names.tolist() == ["w1"] * 3 + ["w2"] * 3 and np.array_equal(there.log_s, log_s)


def test_recordings_that_are_all_the_same_have_scale_one():
    motions = make("reach", 1, 1, seed=0)[0]
    made = registered(motions.subset(np.array([0, 0])), FitSettings(SCHEME, None, 21, 8, 0.0, 0, ""), None)
    there = Unseen.of(made)
    assert there.posture_rad == pytest.approx(1.0) and there.log_time == 1.0
