import numpy as np

from emulator.judge import distances, jittered_resampler, novelty, resampler
from tests.emulator.judge.made import sequences


def drawn_by(drawer, training, n=40):
    return drawer(training, n, np.random.default_rng(0))


def test_the_resampler_gives_nothing_but_training_sequences():
    training = sequences(12)
    drawn = drawn_by(resampler, training)
    assert drawn.shape == (40, 11, 4, 3)
    assert np.all(distances(drawn, training).min(axis=1) == 0)


def test_the_jittered_resampler_stays_near_and_on_the_spheres():
    training, unseen = np.split(sequences(24), 2)
    drawn = drawn_by(jittered_resampler, training)
    assert np.allclose(np.linalg.norm(drawn, axis=-1), 1)
    ratio = novelty(distances(drawn, training), distances(unseen, training))
    assert 0.05 < ratio < 0.6


def test_no_jitter_gives_training_sequences_back():
    training = sequences(6)
    drawn = jittered_resampler(training, 9, np.random.default_rng(0), jitter=0.0)
    assert distances(drawn, training).min(axis=1).max() < 1e-5
