import numpy as np

from emulator.fit_judge import novelty_ratio, reconstruction_deg, roughness_ratio
from emulator.flatten import SIEM
from tests.emulator.fitted import made


def scores(n=60, k=4, seed=0):
    return np.random.default_rng(seed).normal(size=(n, k))


def test_a_copier_has_no_novelty_and_an_honest_drawer_about_one():
    assert novelty_ratio(scores()[:20], scores()) < 1e-6
    assert 0.8 < novelty_ratio(scores(seed=1), scores()) < 1.25


def test_a_jittered_copier_is_seen():
    jittered = scores() + 0.1 * scores(seed=2)
    assert novelty_ratio(jittered, scores()) < 0.5


def test_novelty_is_not_estimated_where_the_recorded_are_twins():
    twins = np.repeat(scores(10), 2, axis=0)
    assert np.isnan(novelty_ratio(scores(seed=1), twins))
    assert np.isfinite(novelty_ratio(scores(seed=1), np.concatenate([twins[:4], scores(20)])))


def motions_on_one_clock():
    return made("reach")[2].sample(30, np.random.default_rng(0)).directions(n_times=61)


def test_the_recorded_are_as_rough_as_themselves_and_shaking_is_seen():
    y = motions_on_one_clock()
    siem, still = SIEM.fit(y), np.tile(np.linspace(0, 1, 61), (30, 1))
    shaken = siem.inverse(siem.forward(y) + 0.01 * np.random.default_rng(1).normal(size=(30, 61, siem.n_channels)))
    assert np.isclose(roughness_ratio(siem, y, y, still), 1.0)
    assert roughness_ratio(siem, shaken, y, still) > 2


def test_enough_components_reconstruct_what_lies_in_their_span():
    emulator = made("reach")[2]
    siem, y = emulator.flatten, emulator.aligned_directions(emulator.sample(30, np.random.default_rng(0)).scores)
    errors = [reconstruction_deg(siem, y, n) for n in (1, 3, 8)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.05
