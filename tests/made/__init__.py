"""Made sequences on products of spheres with known warps: for tests that need the truth."""

import numpy as np

from emulator.geometry import sphere


def random_warp(rng, n_times, spread=0.35, n_waves=4):
    """A smooth random warp (T,): the running integral of exp(random Fourier series)."""
    t = np.linspace(0, 1, n_times)
    log_slope = np.zeros(n_times)
    for k in range(1, n_waves + 1):
        sine, cosine = rng.normal(), rng.normal()
        log_slope += spread / k * (sine * np.sin(2 * np.pi * k * t) + cosine * np.cos(2 * np.pi * k * t))
    slope = np.exp(log_slope)
    gamma = np.concatenate([[0], np.cumsum(0.5 * (slope[1:] + slope[:-1]))])
    return gamma / gamma[-1]


def made_sequences(n, n_times, n_bones=20, seed=0, variation=0.12, fine=3001):
    """n sequences (n, T, B, 3), their warps (n, T) and base posture (B, 3).

    The recipe, and the order of its draws, of the generator whose frozen oracle numbers are compared (seed 11).
    """
    rng = np.random.default_rng(seed)
    base = sphere.normalise(rng.normal(size=(n_bones, 3)))
    clock = np.linspace(0, 1, fine)
    k = np.arange(1, 7)[:, None]
    waves = np.concatenate([np.sin(np.pi * k * clock), np.cos(np.pi * k * clock)]) / np.sqrt(np.concatenate([k, k]))
    common = rng.normal(size=(n_bones, 3, 12)) * 0.35
    loadings = rng.normal(size=(5, n_bones, 3, 12))
    sequences, warps = [], []
    for _ in range(n):
        amplitudes = common + variation * np.tensordot(rng.normal(size=5), loadings, 1) / np.sqrt(5)
        tangent = np.einsum("bck,kt->tbc", amplitudes, waves)
        tangent -= np.sum(tangent * base, -1, keepdims=True) * base
        tangent *= np.minimum(1, 2.2 / np.maximum(np.linalg.norm(tangent, axis=-1, keepdims=True), 1e-9))
        path = sphere.exp(base, tangent)
        gamma = random_warp(rng, n_times)
        place = gamma * (fine - 1)
        low = np.minimum(place.astype(int), fine - 2)
        share = (place - low)[:, None, None]
        sequences.append(sphere.normalise((1 - share) * path[low] + share * path[low + 1]))
        warps.append(gamma)
    return np.array(sequences), np.array(warps), base
