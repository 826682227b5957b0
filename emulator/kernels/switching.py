"""Steps through a latent space: the state of a point, mean and spread of the next, a draw that stays on the support.

Their twin: naive_steps in tests/naive.

One beat of a walk from its dynamics: drawn as far as it goes, judged, smoothed and made whole.

Its twin: naive_beat in tests/naive/walk.py, which draws further and looks back.

Hidden Markov chains: smoothed state probabilities and the likeliest path. Twins: naive_smoothed, naive_path.
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


class Manner(NamedTuple):
    """What a beat is like and what is beyond the dynamics: see ``guide.Guide`` and ``rest.Finer``."""

    low: np.ndarray  # (d,) least and greatest latents
    high: np.ndarray
    taps: np.ndarray  # (2 r + 1,) weights of the smoothing
    points: np.ndarray  # (p, M) of the finer components, over their lengths
    per_length: np.ndarray  # (p,)
    weight: np.ndarray  # (M, r)
    mean: np.ndarray  # (r,)
    bears: np.ndarray  # (S, 2) whether each foot bears in each state


@compiled(error_model="numpy", nogil=True)
def beat(tables, control, noise, bears, earliest, beyond, fewest, z, state):
    """A path z (T, d) with z[0] given and its state (T,), up to ``beyond`` frames after a foot comes down: that frame.

    control (c,), noise (T - 1, R, d); bears (S,) whether the foot bears in each state. -1 where it never comes down
    from frame ``earliest`` on after ``fewest`` frames in the air. Returns the frame and how many frames were drawn.
    """
    n_times, d = z.shape
    x, scratch = np.empty(d + control.size), room(tables, d)
    x[d:] = control
    end, near_step = -1, 0
    for t in range(n_times):
        x[:d] = z[t]
        state[t] = state_of(x, tables, scratch[0])
        if end < 0 and t >= max(earliest, 1) and bears[state[t]]:
            landed = True
            for before in range(max(t - fewest, 0), t):
                landed = landed and not bears[state[before]]
            if landed:
                end = t
        if t + 1 == n_times or (end >= 0 and t >= end + beyond):
            return end, t + 1
        near_step = step(tables, x, z[t], state[t], noise[t], near_step, z[t + 1], scratch)[0]
    return end, n_times


@compiled(error_model="numpy", nogil=True)
def usual(z, low, high, after, apart):
    """Whether z (T, d) lies between low and high (d,) and ends within ``apart`` of ``after`` (d,)."""
    square = 0.0
    for c in range(z.shape[1]):
        square += (z[-1, c] - after[c]) ** 2
        for t in range(z.shape[0]):
            if not low[c] <= z[t, c] <= high[c]:
                return False
    return square <= apart * apart


@compiled(error_model="numpy", nogil=True)
def made_whole(z, manner, control, whole):
    """whole (F, D): the first F frames of z (T, d) smoothed, the ends held, and the finer components beside them."""
    d, reach, last = z.shape[1], manner.taps.size // 2, z.shape[0] - 1
    x, scratch = np.empty(d + control.size), np.empty(max(manner.points.shape[1], 1))
    x[d:] = control
    for t in range(whole.shape[0]):
        whole[t] = 0.0
        for k in range(manner.taps.size):
            at = min(max(t + k - reach, 0), last)
            for c in range(d):
                whole[t, c] += manner.taps[k] * z[at, c]
        if manner.mean.size:
            x[:d] = whole[t, :d]
            near(x, manner.points, manner.per_length, manner.points.shape[1], scratch)
            fine = whole[t, d:]
            fine[:] = manner.mean
            for j in range(manner.points.shape[1]):
                for c in range(manner.mean.size):
                    fine[c] += scratch[j] * manner.weight[j, c]


@compiled(error_model="numpy", nogil=True)
def smoothed(log_emission, start, move, share, pairs):
    """Forward and backward: writes share (T, S), adds expected transitions to pairs (S, S), returns log p(all frames).

    log_emission (T, S), start (S,), move (S, S) rows summing to 1
    """
    n_times, n_states = log_emission.shape
    likely = np.empty((n_times, n_states))
    total = 0.0
    ahead = start.copy()
    for t in range(n_times):
        top = log_emission[t].max()
        whole = 0.0
        for s in range(n_states):
            likely[t, s] = np.exp(log_emission[t, s] - top)
            share[t, s] = ahead[s] * likely[t, s]
            whole += share[t, s]
        total += top + np.log(whole)
        for s in range(n_states):
            share[t, s] /= whole
        for s in range(n_states):
            ahead[s] = 0.0
            for before in range(n_states):
                ahead[s] += share[t, before] * move[before, s]
    for t in range(n_times - 2, -1, -1):
        for s in range(n_states):
            ahead[s] = 0.0
            for before in range(n_states):
                ahead[s] += share[t, before] * move[before, s]
        back = np.zeros(n_states)
        for before in range(n_states):
            for s in range(n_states):
                both = share[t, before] * move[before, s] * share[t + 1, s] / ahead[s] if ahead[s] > 0 else 0.0
                pairs[before, s] += both
                back[before] += both
        share[t] = back
    return total


@compiled(error_model="numpy", nogil=True)
def likeliest_path(log_emission, log_start, log_move, path):
    """Viterbi: writes path (T,)."""
    n_times, n_states = log_emission.shape
    came = np.zeros((n_times, n_states), dtype=np.int64)
    best = log_start + log_emission[0]
    for t in range(1, n_times):
        new = np.empty(n_states)
        for s in range(n_states):
            at = 0
            for before in range(1, n_states):
                if best[before] + log_move[before, s] > best[at] + log_move[at, s]:
                    at = before
            came[t, s] = at
            new[s] = best[at] + log_move[at, s] + log_emission[t, s]
        best = new
    path[n_times - 1] = best.argmax()
    for t in range(n_times - 1, 0, -1):
        path[t - 1] = came[t, path[t]]
