"""Steps through a latent space: the state of a point, mean and spread of the next, a draw that stays on the support.

Their twin: naive_steps in tests/naive.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from emulator.kernels.compiled import compiled


class Tables(NamedTuple):
    """What a step needs, padded: S states of at most M points, C classifying processes of at most M'."""

    points: np.ndarray  # (S, p, M) each state's points over its lengths
    per_length: np.ndarray  # (S, p)
    used: np.ndarray  # (S,) how many of the points count
    variance: np.ndarray  # (S,) of the signal
    noise: np.ndarray  # (S,) its variance
    weight: np.ndarray  # (S, M, d) mean of output d is k @ weight
    shrink: np.ndarray  # (S, M, M) the variance at a point is signal - k @ shrink @ k
    scale: np.ndarray  # (S, d) of the outputs' variances
    keep: np.ndarray  # (S,) 1 where the output is added to z, 0 where it replaces it
    border_points: np.ndarray  # (C, p, M')
    border_per_length: np.ndarray  # (C, p)
    border_used: np.ndarray  # (C,)
    border_weight: np.ndarray  # (C, M')
    support: np.ndarray  # (n, d) training latents
    ways: np.ndarray  # (n, d) from each of them to the frame after it
    leading: int  # the first so many of these steps are followed by others
    reach: float  # no step that starts further away than this along one axis can be near enough
    radius2: float  # square of the distance from these steps that a draw may have; infinite: anywhere


SHIFT = 1.5 * 2.0**52
"""Added to a number it leaves the nearest whole one in the last bits."""
LOG2_HIGH, LOG2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
"""log 2, its first part with so few digits that small multiples of it are exact. Source: Cody & Waite (1980)."""


@compiled(error_model="numpy", nogil=True)
def fading(squares):
    """Each of squares (n,), none below 0, becomes exp(-square / 2), to the last digit or two.

    NOTE: a series in a plain loop, since calls of exp cannot be vectorised: they were half of a step's time.
    """
    n = squares.size
    whole, left = np.empty(n), np.empty(n)
    for j in range(n):
        x = max(-0.5 * squares[j], -700.0)
        whole[j] = x * 1.4426950408889634 + SHIFT
        times = whole[j] - SHIFT
        left[j] = (x - times * LOG2_HIGH) - times * LOG2_LOW
    power = whole.view(np.int64)
    for j in range(n):
        power[j] = (power[j] + 1023) << 52
    for j in range(n):
        r = left[j]
        high = 1.0 / 5040 + r * (1.0 / 40320 + r * (1.0 / 362880 + r * (1.0 / 3628800 + r * (1.0 / 39916800))))
        low = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120 + r * (1.0 / 720))))))
        r3 = r * r * r
        squares[j] = (low + r3 * r3 * r * (high + r3 * r * r * (1.0 / 479001600 + r * (1.0 / 6227020800)))) * whole[j]


@compiled(error_model="numpy", nogil=True)
def near(x, points, per_length, used, out):
    """out[j] = exp(-1/2 |x / length - points[:, j]|^2) for the first ``used`` points."""
    out[:used] = 0.0
    for c in range(x.size):
        here, row = x[c] * per_length[c], points[c]
        for j in range(used):
            gap = here - row[j]
            out[j] += gap * gap
    fading(out[:used])


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
def squared(k, matrix, across):
    """k @ matrix @ k of k (m,) and a symmetric matrix, of which the lower half is read; across (m,) is scratch.

    NOTE: sums go down the columns, four rows at a time.
    """
    m = k.size
    across[:m] = 0.0
    for j in range(0, m - 3, 4):
        one, two, three, four = k[j], k[j + 1], k[j + 2], k[j + 3]
        first, second, third, fourth = matrix[j], matrix[j + 1], matrix[j + 2], matrix[j + 3]
        for i in range(j):
            across[i] += one * first[i] + two * second[i] + three * third[i] + four * fourth[i]
        across[j] += two * second[j] + three * third[j] + four * fourth[j]
        across[j + 1] += three * third[j + 1] + four * fourth[j + 1]
        across[j + 2] += four * fourth[j + 2]
    for j in range(m - m % 4, m):
        for i in range(j):
            across[i] += k[j] * matrix[j, i]
    total = 0.0
    for j in range(m):
        total += k[j] * (2.0 * across[j] + matrix[j, j] * k[j])
    return total


@compiled(error_model="numpy", nogil=True)
def foretell(x, s, tables, mean, scratch, across):
    """Writes the mean (d,) of the latent after x (p,) in state s; returns the variance at unit scale, with noise."""
    used = tables.used[s]
    near(x, tables.points[s], tables.per_length[s], used, scratch)
    for c in range(mean.size):
        mean[c] = tables.keep[s] * x[c]
    for j in range(used):
        for c in range(mean.size):
            mean[c] += scratch[j] * tables.weight[s, j, c]
    known = squared(scratch[:used], tables.shrink[s], across)
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
def step(tables, x, z, s, noise, near_step, new, scratch):
    """Writes new (d,) after z (d,), which is in state s at x (p,); noise (R, d) as in ``steps``.

    near_step : number of the support step that z is near to. Returns that of new, and whether a recorded step was taken
    scratch (3, ...) : at least as wide as there are points
    """
    d = z.size
    mean = scratch[2, :d]
    variance = foretell(x, s, tables, mean, scratch[0], scratch[1])
    for r in range(noise.shape[0]):
        for c in range(d):
            new[c] = mean[c] + np.sqrt(variance * tables.scale[s, c]) * noise[r, c]
        found = inside(new, tables, near_step)
        if found >= 0:
            return found, False
    new[:] = mean
    found = inside(new, tables, near_step)
    return (found, False) if found >= 0 else (follow(z, tables, new), True)


@compiled(error_model="numpy", nogil=True)
def room(tables, d):
    """Scratch for ``step``."""
    return np.empty((3, max(tables.points.shape[2], tables.border_points.shape[2], d)))


@compiled(error_model="numpy", nogil=True)
def steps(tables, control, noise, z, state):
    """Paths: z (n, T, d) with z[:, 0] given, and state (n, T), written here; returns how many steps are recorded ones.

    control : (n, T, c) what is known of each frame
    noise   : (n, T - 1, R, d) standard normals; the first of R draws that lies on the support is taken,
              else the mean, else what the nearest recorded step does
    """
    n_paths, n_times, d = z.shape
    x = np.empty(d + control.shape[2])
    scratch = room(tables, d)
    followed = 0
    for i in range(n_paths):
        near_step = 0
        for t in range(n_times):
            x[:d] = z[i, t]
            x[d:] = control[i, t]
            s = state_of(x, tables, scratch[0])
            state[i, t] = s
            if t + 1 < n_times:
                near_step, led = step(tables, x, z[i, t], s, noise[i, t], near_step, z[i, t + 1], scratch)
                followed += led
    return followed


@compiled(error_model="numpy", nogil=True)
def states_of(x, tables, out):
    """The number (m,) of the likeliest state at each x (m, p)."""
    scratch = np.empty(tables.border_points.shape[2])
    for i in range(x.shape[0]):
        out[i] = state_of(x[i], tables, scratch)
