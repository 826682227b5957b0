"""Sequences that the tests of the schemes share; formulas, so that a peer's answers to them can be frozen."""

import numpy as np

from tests.emulator.judge.made import sequences

__all__ = ["flat_case", "grid_case", "sequences", "series_case", "walks"]


def flat_case(n=9, n_times=14, n_channels=6):
    """(n, T, C) flattened sequences by a formula, without chance."""
    i, t, c = np.ogrid[1 : n + 1, 1 : n_times + 1, 1 : n_channels + 1]
    return np.sin(1.3 * i * c + 0.2 * t * c) + 0.5 * np.cos(0.7 * i * t) + 0.1 * ((7 * i + 3 * t * t + 5 * c * t) % 11)


def grid_case(n, n_channels):
    """(n, C) points by a formula, without chance."""
    i, c = np.ogrid[1 : n + 1, 1 : n_channels + 1]
    return np.sin(1.3 * i * c) + 0.1 * ((7 * i + 3 * c * c) % 11)


def series_case(n_times=80):
    """(1, T, 3) one series by a formula, without chance."""
    t = np.arange(1, n_times + 1)[:, None]
    return (np.sin(0.31 * t * np.array([1.0, 1.7, 0.6])) + 0.05 * ((t * t * np.array([3, 5, 7])) % 13))[None]


def walks(n=12, n_times=40, n_bones=5, seed=0):
    """(n, T, B, 3) smooth sequences that swing about one posture, each its own way."""
    rng = np.random.default_rng(seed)
    s = np.linspace(0, 1, n_times)
    waves = np.stack([np.sin(np.pi * s), np.sin(2 * np.pi * s), np.cos(np.pi * s), s])
    size = np.array([1.0, 0.5, 0.3, 0.2])[:, None, None]
    moves = (rng.normal(size=(4, n_bones, 3)) + 0.4 * rng.normal(size=(n, 4, n_bones, 3))) * 0.5 * size
    x = rng.normal(size=(n_bones, 3)) * 2 + np.einsum("kt,nkbc->ntbc", waves, moves)
    return x / np.linalg.norm(x, axis=-1, keepdims=True)
