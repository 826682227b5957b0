"""The way of a root whose bearing feet stay, frame by frame. Its twin: naive_way in tests/naive_walk.py."""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled

RISE = 0.05
"""The heel rises where the foot points this much (of its length) further down than when it stands."""


@compiled(error_model="numpy", nogil=True)
def run_end(contact, both, start):
    """One beyond the last frame from ``start`` on in which both feet bear (or, with ``both`` False, neither does)."""
    stop = start
    while stop < contact.shape[0] and contact[stop, 0] == both and contact[stop, 1] == both:
        stop += 1
    return stop


@compiled(error_model="numpy", nogil=True)
def shared(contact, share):
    """Writes how much each foot carries (T, 2): see ``feet.shares``."""
    n = contact.shape[0]
    for t in range(n):
        for f in range(2):
            share[t, f] = 1.0 if contact[t, f] else 0.0
    start = 0
    while start < n:
        stop = run_end(contact, True, start)
        for t in range(start, stop):
            ease = (t - start + 1) / (stop - start + 1)
            for f in range(2):
                before = share[start - 1, f] if start else 0.5
                after = share[stop, f] if stop < n else 0.5
                share[t, f] = (1.0 - ease) * before + ease * after
        start = max(stop, start + 1)
    for t in range(n):
        if not contact[t, 0] and not contact[t, 1]:
            for f in range(2):
                share[t, f] = share[t - 1, f] if t else 0.5
    for t in range(n):
        total = share[t, 0] + share[t, 1]
        if total > 0:
            share[t] /= total


@compiled(error_model="numpy", nogil=True)
def rise_of(down, start, stop, held):
    """The frame of a stance [start, stop) from which a foot pointing ``down`` (T,) turns about its toe, or stop."""
    n = stop - start
    if held or n < 4:
        return stop
    middle = np.median(down[start + n // 4 : start + max(n // 2, n // 4 + 1)])
    last = -1
    for t in range(n):
        if down[start + t] <= middle + RISE:
            last = t
    return start + max(last if last >= 0 else n // 2, n // 4)


@compiled(error_model="numpy", nogil=True)
def ridden(hanging, contact, feet, way):
    """Writes the level way (T, 2) of the root of joints (T, J, 3), root at 0, from x = y = 0, if bearing feet stay.

    contact (T, 2); feet (2, 2) : ankle and toe of each side
    """
    n = contact.shape[0]
    share, down, pivot = np.empty((n, 2)), np.empty(n), np.empty(n, dtype=np.int64)
    shared(contact, share)
    way[:] = 0.0
    for f in range(2):
        ankle, toe = feet[f]
        pivot[:] = ankle
        for t in range(n):
            square = 0.0
            for c in range(3):
                square += (hanging[t, toe, c] - hanging[t, ankle, c]) ** 2
            down[t] = (hanging[t, ankle, 2] - hanging[t, toe, 2]) / np.sqrt(square)
        start = 0
        while start < n:
            stop = start
            while stop < n and contact[stop, f]:
                stop += 1
            if stop > start:
                pivot[rise_of(down, start, stop, stop == n) : stop - 1] = toe
            start = max(stop, start + 1)
        for c in range(2):
            gone = 0.0
            for t in range(1, n):
                gone += (
                    0.5
                    * (share[t, f] + share[t - 1, f])
                    * (hanging[t, pivot[t - 1], c] - hanging[t - 1, pivot[t - 1], c])
                )
                way[t, c] -= gone
