"""Steps through a latent space: the state of a point, mean and spread of the next, a draw that stays on the support.

Their twin: naive_steps in tests/naive.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from emulator.kernels.compiled import compiled


class Tables(NamedTuple):
    """What a step needs, padded: S states of at most M points, C classifying processes of at most M'."""

    points: np.ndarray  # (S, M, p) each state's points over its lengths
    per_length: np.ndarray  # (S, p)
    used: np.ndarray  # (S,) how many of the points count
    variance: np.ndarray  # (S,) of the signal
    noise: np.ndarray  # (S,) its variance
    weight: np.ndarray  # (S, M, d) mean of output d is k @ weight
    shrink: np.ndarray  # (S, M, M) the variance at a point is signal - k @ shrink @ k
    scale: np.ndarray  # (S, d) of the outputs' variances
    keep: np.ndarray  # (S,) 1 where the output is added to z, 0 where it replaces it
    border_points: np.ndarray  # (C, M', p)
    border_per_length: np.ndarray  # (C, p)
    border_used: np.ndarray  # (C,)
    border_weight: np.ndarray  # (C, M')
    support: np.ndarray  # (n, d) training latents
    ways: np.ndarray  # (n, d) from each of them to the frame after it
    leading: int  # the first so many of these steps are followed by others
    reach: float  # no step that starts further away than this along one axis can be near enough
    radius2: float  # square of the distance from these steps that a draw may have; infinite: anywhere


@compiled(error_model="numpy", nogil=True)
def near(x, points, per_length, used, out):
    """out[j] = exp(-1/2 |x / length - points[j]|^2) for the first ``used`` points."""
    for j in range(used):
        square = 0.0
        for c in range(x.size):
            gap = x[c] * per_length[c] - points[j, c]
            square += gap * gap
        out[j] = np.exp(-0.5 * square)


@compiled(error_model="numpy", nogil=True)
def state_of(x, tables, scratch):
    """The number of the likeliest state at x (p,)."""
    best, at = 0.0, 0
    n_borders = tables.border_used.size
    for c in range(n_borders):
        near(x, tables.border_points[c], tables.border_per_length[c], tables.border_used[c], scratch)
        latent = 0.0
        for j in range(tables.border_used[c]):
            latent += scratch[j] * tables.border_weight[c, j]
        if n_borders == 1:
            return 1 if latent > 0 else 0
        if c == 0 or latent > best:
            best, at = latent, c
    return at


@compiled(error_model="numpy", nogil=True)
def foretell(x, s, tables, mean, scratch):
    """Writes the mean (d,) of the latent after x (p,) in state s; returns the variance at unit scale, with noise."""
    used = tables.used[s]
    near(x, tables.points[s], tables.per_length[s], used, scratch)
    for c in range(mean.size):
        mean[c] = tables.keep[s] * x[c]
    known = 0.0
    for j in range(used):
        row = 0.5 * tables.shrink[s, j, j] * scratch[j]
        for i in range(j):
            row += tables.shrink[s, j, i] * scratch[i]
        known += 2.0 * row * scratch[j]
        for c in range(mean.size):
            mean[c] += scratch[j] * tables.weight[s, j, c]
    return max(tables.variance[s] - known, 0.0) + tables.noise[s]


@compiled(error_model="numpy", nogil=True)
def away(z, start, way):
    """Square of the distance from z (d,) to the line from start (d,) to start + way, and the share of the way there."""
    along, length = 0.0, 0.0
    for c in range(z.size):
        along += (z[c] - start[c]) * way[c]
        length += way[c] * way[c]
    share = min(max(along / length, 0.0), 1.0) if length > 0 else 0.0
    square = 0.0
    for c in range(z.size):
        gap = z[c] - start[c] - share * way[c]
        square += gap * gap
    return square, share


@compiled(error_model="numpy", nogil=True)
def inside(z, tables, guess):
    """Number of the first support step, from ``guess`` on and around, that z is near enough to; -1 for none."""
    n = tables.support.shape[0]
    for j in range(n):
        at = guess + j
        if at >= n:
            at -= n
        # NOTE: most steps are ruled out by one number; without this the support took three quarters of a step's time.
        if abs(z[0] - tables.support[at, 0]) > tables.reach:
            continue
        if away(z, tables.support[at], tables.ways[at])[0] <= tables.radius2:
            return at
    return -1


@compiled(error_model="numpy", nogil=True)
def nearest(z, n, tables):
    """Of the first n support steps the nearest to z (d,): its number, the squared distance, the share of the way."""
    at, best, share = 0, np.inf, 0.0
    for j in range(n):
        square, along = away(z, tables.support[j], tables.ways[j])
        if square < best:
            at, best, share = j, square, along
    return at, best, share


@compiled(error_model="numpy", nogil=True)
def follow(z, tables, new):
    """Writes to new (d,) z moved as the nearest recorded step that goes on does, drawn onto the support; its number."""
    led = nearest(z, tables.leading, tables)[0]
    for c in range(z.size):
        new[c] = z[c] + tables.ways[led, c]
    at, best, share = nearest(new, tables.support.shape[0], tables)
    keep = min(np.sqrt(tables.radius2 / best), 1.0) if best > 0 else 1.0
    for c in range(z.size):
        foot = tables.support[at, c] + share * tables.ways[at, c]
        new[c] = foot + keep * (new[c] - foot)
    return at


@compiled(error_model="numpy", nogil=True)
def steps(tables, control, noise, z, state):
    """Paths: z (n, T, d) with z[:, 0] given, and state (n, T), written here; returns how many steps are recorded ones.

    control : (n, T, c) what is known of each frame
    noise   : (n, T - 1, R, d) standard normals; the first of R draws that lies on the support is taken,
              else the mean, else what the nearest recorded step does
    """
    n_paths, n_times, d = z.shape
    x = np.empty(d + control.shape[2])
    mean = np.empty(d)
    scratch = np.empty(max(tables.points.shape[1], tables.border_points.shape[1]))
    followed = 0
    for i in range(n_paths):
        near_step = 0
        for t in range(n_times):
            x[:d] = z[i, t]
            x[d:] = control[i, t]
            s = state_of(x, tables, scratch)
            state[i, t] = s
            if t + 1 == n_times:
                break
            variance = foretell(x, s, tables, mean, scratch)
            new = z[i, t + 1]
            found = -1
            for r in range(noise.shape[2]):
                for c in range(d):
                    new[c] = mean[c] + np.sqrt(variance * tables.scale[s, c]) * noise[i, t, r, c]
                found = inside(new, tables, near_step)
                if found >= 0:
                    break
            if found < 0:
                new[:] = mean
                found = inside(new, tables, near_step)
            if found < 0:
                followed += 1
                found = follow(z[i, t], tables, new)
            near_step = found
    return followed


@compiled(error_model="numpy", nogil=True)
def states_of(x, tables, out):
    """The number (m,) of the likeliest state at each x (m, p)."""
    scratch = np.empty(tables.border_points.shape[1])
    for i in range(x.shape[0]):
        out[i] = state_of(x[i], tables, scratch)
