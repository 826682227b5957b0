from dataclasses import replace

import numpy as np

from emulator.model.smoothed import SmoothedScores, less_told, room
from emulator.people.workers import WorkerEffect, Workforce

K = 4


def smoothed(n_workers=5, n_each=8, h=0.4, seed=0):
    rng = np.random.default_rng(seed)
    owner = np.repeat(np.arange(n_workers), n_each)
    scores = rng.normal(size=(n_workers, K))[owner] * 2 + rng.normal(size=(len(owner), K))
    within = scores - np.stack([scores[owner == w].mean(0) for w in range(n_workers)])[owner]
    factor = h * within / np.sqrt(len(owner) - n_workers)
    spread = np.linalg.norm(factor, axis=0) / h
    return SmoothedScores(scores, owner, np.ones(len(owner)), factor, spread, *rest(scores, owner, factor, spread))


def rest(scores, owner, factor, spread):
    """What is left of deviations, and nothing that curves tell."""
    within = scores - np.stack([scores[owner == w].mean(0) for w in owner])
    drawn_in = room(spread**2 - np.sum(factor**2, axis=0), np.mean(within**2, axis=0))
    return within * drawn_in, np.zeros((K - 1, 1))


def variance(law):
    mean, covariance = law.coordinates(np.arange(K))
    centre = law.weight @ mean
    return law.weight @ (np.diagonal(covariance, axis1=1, axis2=2) + (mean - centre) ** 2)


def test_somebody_unseen_varies_as_much_as_workers_do_about_their_means():
    blurred = smoothed()
    assert np.allclose(variance(blurred.anyone(np.zeros(K))), blurred.spread**2, rtol=0.3)


def test_what_curves_tell_of_the_rest_goes_with_them():
    blurred = smoothed()
    tells = np.array([[0.5], [0.0], [-1.0]])
    plain, told = blurred.deviations, replace(blurred, tells=tells).deviations
    assert np.allclose(told[:, :3], plain[:, :3])
    assert np.allclose(told[:, 3:], plain[:, 3:] + plain[:, :3] @ tells)
    assert np.allclose(less_told(told, tells), plain)


def test_a_known_worker_is_mostly_drawn_about_his_own_repetitions():
    blurred = smoothed(n_each=9)
    law = blurred.known(2, np.zeros(K))
    assert np.isclose(law.weight.sum(), 1.0)
    assert np.isclose(law.weight[:9].sum(), 9 / 9.5)
    mean, _ = law.coordinates(np.arange(K))
    assert np.allclose(mean[:9].mean(0), blurred.means[2])
    assert np.allclose(mean[9:].mean(0), 0.0, atol=1e-12)


def test_the_workforce_takes_own_repetitions_for_names_it_knows_and_all_for_others():
    blurred = smoothed()
    crew = Workforce.fit(blurred.scores, blurred.owner, tuple(f"w{i}" for i in range(5)), 0.2, 0.1)
    crew = replace(crew, smoothed=blurred)
    known = crew.law(WorkerEffect(crew.effects[3], "w3"))
    drawn = crew.law(WorkerEffect(crew.effects[3]))
    assert len(known.weight) == len(drawn.weight) + 8
    assert crew.law(None).people is crew.between and drawn.people is None


def test_kinds_of_execution_stay_apart_where_one_gaussian_fills_the_gap():
    """Two tight kinds, 10 apart: draws lie within 2 of one of them; a quarter of the Gaussian's lies between."""
    rng = np.random.default_rng(0)
    owner = np.zeros(40, int)
    scores = np.where(np.arange(40)[:, None] % 2 == 0, -5.0, 5.0) * [1, 0, 0, 0] + 0.3 * rng.normal(size=(40, K))
    deviation = scores - scores.mean(0)
    factor, spread = 0.1 * deviation / np.sqrt(39), deviation.std(0, ddof=1)
    blurred = SmoothedScores(scores, owner, np.ones(40), factor, spread, *rest(scores, owner, factor, spread))
    z = blurred.known(0, scores.mean(0)).sample(2000, np.random.default_rng(1))[:, 0]
    gauss = Workforce.fit(scores, owner, ("w",), 0.2, 0.1).within.sample(2000, np.random.default_rng(1))[:, 0]
    assert np.mean(np.abs(z) < 3) < 0.001
    assert np.mean(np.abs(gauss) < 3) > 0.4
