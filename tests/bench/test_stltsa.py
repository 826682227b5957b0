"""Spatio-temporal LTSA in the number of frames, and against scikit-learn's plain LTSA: the answer, then the ratio.

scikit-learn is only there where ``make bench-peers`` installed it.
"""

from functools import partial

import numpy as np
import pytest
from bench.cpu import best_s

from emulator.segmenting.ltsa import stltsa

K, D = 20, 3


def walk(n_frames, n_numbers=60):
    """A movement of 33 frames a cycle that never comes back quite the same, (n_frames, n_numbers)."""
    rng = np.random.default_rng(0)
    at = 2 * np.pi * np.arange(n_frames)[:, None] / 33
    waves = np.concatenate([np.cos(at), np.sin(at), np.cos(2 * at), np.sin(2 * at), at / 40], axis=1)
    return waves @ rng.normal(size=(waves.shape[1], n_numbers)) + 0.01 * rng.normal(size=(n_frames, n_numbers))


def test_twice_the_frames_cost_at_most_twice_as_much_and_a_little():
    once, twice, more = (walk(n) for n in (2500, 5000, 10000))
    assert stltsa(twice, K, D).eigenvalues[0] < stltsa(once, K, D).eigenvalues[0] + 1e-3
    times_s = best_s(*(partial(stltsa, points, K, D) for points in (once, twice, more)), rounds=8)
    ratios = times_s[1] / times_s[0], times_s[2] / times_s[1]
    said = f"2,500 frames {times_s[0]:.2f} s, doubled x {ratios[0]:.2f}, again x {ratios[1]:.2f}"
    print(f"\nSTLTSA, k 20, 60 numbers a frame: {said}")
    assert max(ratios) < 2.3


def test_five_thousand_frames_against_two_thousand_of_plain_ltsa():
    """On the 2,000 both by spatial neighbours: the same three coordinates to 1e-6."""
    manifold = pytest.importorskip("sklearn.manifold", reason="scikit-learn is not installed: make bench-peers")
    long, short = walk(5000), walk(2000)

    def theirs():
        return manifold.LocallyLinearEmbedding(
            n_neighbors=K, n_components=D, method="ltsa", eigen_solver="dense"
        ).fit_transform(short)

    cosines = np.linalg.svd(stltsa(short, K, D, neighbourhood="space").coordinates.T @ theirs())[1]
    assert cosines.min() > 1 - 1e-6
    theirs_s, ours_s, space_s = best_s(
        theirs, partial(stltsa, long, K, D), partial(stltsa, short, K, D, neighbourhood="space"), rounds=3
    )
    print(
        f"\nLTSA: scikit-learn, 2,000 frames {theirs_s:.2f} s; ours, 5,000 frames x {ours_s / theirs_s:.2f}, "
        f"2,000 by spatial neighbours x {space_s / theirs_s:.2f}"
    )
    assert ours_s / theirs_s < 5
