from dataclasses import replace

import numpy as np

from emulator.model.smoothed import SmoothedScores, less_told, partners, room
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
    """What deviations are drawn in by, the nearest recordings to mix with, and nothing that curves tell."""
    variance = np.mean((scores - np.stack([scores[owner == w].mean(0) for w in owner])) ** 2, axis=0)
    apart = np.linalg.norm(scores[:, None] - scores[None], axis=-1)
    drawn_in = room(spread**2 - np.sum(factor**2, axis=0), variance)
    return drawn_in, partners(owner, apart), np.zeros((K - 1, 1))


def variance(law):
    mean, covariance = law.coordinates(np.arange(K))
    centre = law.weight @ mean
    return law.weight @ (np.diagonal(covariance, axis1=1, axis2=2) + (mean - centre) ** 2)


def test_somebody_unseen_varies_as_much_as_workers_do_about_their_means():
    blurred = smoothed()
    assert np.allclose(variance(blurred.anyone(np.zeros(K))), blurred.spread**2, rtol=0.3)


def test_each_component_is_a_mixture_with_a_near_repetition_of_the_same_worker_mostly_of_the_first():
    blurred = smoothed()
    assert np.array_equal(blurred.owner[blurred.partner], np.repeat(blurred.owner[:, None], 3, axis=1))
    first, deviation = blurred.sources
    assert np.array_equal(first, np.repeat(np.arange(len(blurred.scores)), 3))
    own = (blurred.scores - blurred.means[blurred.owner]) * blurred.drawn_in
    assert np.allclose(np.mean(deviation**2, axis=0), np.mean(own**2, axis=0))
    assert all(np.allclose(deviation[blurred.owner[first] == w].mean(axis=0), 0.0) for w in range(5))
    alike = np.sum(deviation * own[first], axis=1), np.sum(deviation * own[blurred.partner.ravel()], axis=1)
    assert np.mean(alike[0] > alike[1]) > 0.75


def test_a_mixture_tells_the_rest_what_its_curves_do():
    blurred = smoothed()
    tells = np.array([[0.5], [0.0], [-1.0]])
    (_, plain), (_, told) = blurred.sources, replace(blurred, tells=tells).sources
    assert np.allclose(told[:, :3], plain[:, :3])
    rest = replace(blurred, scores=less_told(blurred.scores, tells)).sources[1][:, 3:]
    assert np.allclose(told[:, 3:], rest + plain[:, :3] @ tells)


def test_a_repetition_is_mixed_with_the_nearest_of_its_worker_and_alone_with_itself():
    place = np.array([0.0, 1.0, 1.1, 5.0, 1.25])
    found = partners(np.array([0, 1, 1, 2, 1]), np.abs(place[:, None] - place[None]))
    assert found.tolist() == [[0, 0, 0], [2, 4, 1], [1, 4, 2], [3, 3, 3], [2, 1, 4]]


def test_a_known_worker_is_mostly_drawn_about_his_own_repetitions():
    blurred = smoothed(n_each=9)
    law = blurred.known(2, np.zeros(K))
    assert np.isclose(law.weight.sum(), 1.0)
    assert np.isclose(law.weight[:27].sum(), 0.9)
    mean, _ = law.coordinates(np.arange(K))
    assert np.allclose(mean[:27].mean(0), blurred.means[2])
    assert np.allclose(mean[27:].mean(0), 0.0, atol=1e-12)


def test_the_workforce_takes_own_repetitions_for_names_it_knows_and_all_for_others():
    blurred = smoothed()
    crew = Workforce.fit(blurred.scores, blurred.owner, tuple(f"w{i}" for i in range(5)), 0.2, 0.1)
    crew = replace(crew, smoothed=blurred)
    known = crew.law(WorkerEffect(crew.effects[3], "w3"))
    drawn = crew.law(WorkerEffect(crew.effects[3]))
    assert len(known.weight) == len(drawn.weight) + 24
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
