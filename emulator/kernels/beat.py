"""One beat of a walk from its dynamics: drawn as far as it goes, judged, smoothed and made whole.

Its twin: naive_beat in tests/naive_walk.py, which draws further and looks back.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from emulator.kernels.compiled import compiled
from emulator.kernels.switching import near, room, state_of, step


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
