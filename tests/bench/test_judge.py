"""Judges against plain numpy and dcor, one thread: the answer is asserted first, then the ratio.

dcor is only there where ``make bench-peers`` installed it.
"""

from functools import partial

import numpy as np
import pytest
from bench.cpu import best_s
from scipy.spatial.distance import cdist

from emulator.judge import Quantization, disco, distances, energy_v, sampled_postures
from emulator.judge.sequence_distances import distances_numpy
from tests.made import made_sequences


def test_distances_of_two_hundred_sequences():
    sequences = made_sequences(200, 301)[0]
    ours, plain = partial(distances, sequences), partial(arccos_distances, sequences)
    off = ~np.eye(200, dtype=bool)
    error = np.abs(ours()[:20] / distances_numpy(sequences[:20], sequences) - 1)[off[:20]]
    assert error.max() < 1e-6
    assert np.allclose(ours()[off], plain()[off], rtol=1e-6)
    plain_s, ours_s = best_s(plain, ours, rounds=5)
    print(f"\ndistances 200 x 200, T 301, B 20: numpy {plain_s:.2f} s, ours x {plain_s / ours_s:.0f}")
    assert plain_s / ours_s > 18


def arccos_distances(sequences):
    """What one would write: a row of pairs at a time, each pair once, in float64."""
    n = len(sequences)
    found = np.zeros((n, n))
    for i in range(n - 1):
        cosine = np.einsum("mtbc,tbc->mtb", sequences[i + 1 :], sequences[i])
        found[i, i + 1 :] = np.arccos(np.clip(cosine, -1, 1)).sum(axis=2).mean(axis=1)
    return found + found.T


def test_a_permutation_test_of_a_hundred_and_twenty():
    points = np.random.default_rng(0).normal(size=(120, 50))
    points[60:] += 0.25
    apart = np.linalg.norm(points[:, None] - points, axis=-1)
    ours, loop = (partial(test, apart, 60, np.random.default_rng(1)) for test in (disco, looped))
    assert np.isclose(ours().energy, loop()[0]) and abs(ours().p - loop()[1]) < 0.03
    loop_s, ours_s = best_s(loop, ours, rounds=15)
    print(f"\nDISCO, n 120, 999 permutations: loop {loop_s * 1e3:.0f} ms, ours x {loop_s / ours_s:.0f}")
    assert loop_s / ours_s > 15


def test_a_permutation_test_against_dcors():
    """Both from points to p, 999 permutations each.

    The same 120 points; dcor's statistic is n m / (n + m) times the energy distance.
    """
    dcor = pytest.importorskip("dcor", reason="dcor is not installed: make bench-peers")
    x, y = (np.random.default_rng(0).normal(size=(2, 60, 50)) + np.array([0.0, 0.03])[:, None, None]).copy()
    points = np.concatenate([x, y])

    def ours():
        return disco(cdist(points, points), 60, np.random.default_rng(1))

    def theirs():
        return dcor.homogeneity.energy_test(x, y, num_resamples=999, random_state=1)

    assert ours().energy * 60 * 60 / 120 == pytest.approx(theirs().statistic, rel=1e-12)
    assert 0.02 < theirs().pvalue < 0.98 and abs(ours().p - theirs().pvalue) < 0.05
    theirs_s, ours_s = best_s(theirs, ours, rounds=15)
    print(f"\nDISCO, n 120, 999 permutations: dcor {theirs_s * 1e3:.0f} ms, ours x {theirs_s / ours_s:.0f}")
    assert theirs_s / ours_s > 15


def looped(apart, n_first, rng, n_permutations=999):
    """Energy and p, one permutation after the other."""

    def energy(order):
        a, b = order[:n_first], order[n_first:]
        return energy_v(apart[np.ix_(a, b)], apart[np.ix_(a, a)], apart[np.ix_(b, b)])

    first = energy(np.arange(len(apart)))
    reached = sum(energy(rng.permutation(len(apart))) >= first - 1e-12 for _ in range(n_permutations))
    return first, (1 + reached) / (1 + n_permutations)


def test_five_thousand_postures_are_quantized_in_a_few_times_their_distances():
    sequences = made_sequences(60, 301)[0]
    sample = sampled_postures(sequences, 5000, np.random.default_rng(0))
    found = Quantization.fit(sample)
    assert 1 < found.n_postures < 500 and found.labels(sequences).max() == found.n_postures - 1
    ours, matrix = partial(Quantization.fit, sample), partial(distances, sample[:, None])
    matrix_s, ours_s = best_s(matrix, ours, rounds=3)
    print(f"\n5,000 postures quantized: {ours_s / matrix_s:.1f} x their distance matrix (target 20)")
    assert ours_s / matrix_s < 20
