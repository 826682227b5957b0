"""Sequences and samples that the tests of the judges share."""

import numpy as np


def sequences(n=7, n_times=11, n_bones=4, spread=0.4, seed=0):
    """n sequences (n, T, B, 3) that scatter about one course of postures."""
    rng = np.random.default_rng(seed)
    course = np.cumsum(rng.normal(size=(n_times, n_bones, 3)), axis=0) + 3.0
    x = course / np.linalg.norm(course, axis=-1, keepdims=True) + spread * rng.normal(size=(n, 1, n_bones, 3))
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


def plain_distances(x, y):
    """Euclidean distances of points (n, d) and (m, d)."""
    return np.linalg.norm(x[:, None] - y[None], axis=-1)


def parts(x, y):
    """Distances between, among x, among y."""
    return plain_distances(x, y), plain_distances(x, x), plain_distances(y, y)
