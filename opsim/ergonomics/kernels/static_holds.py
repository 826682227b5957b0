"""Where runs of held frames are cut into holds that stay within a band. Twin: tests/opsim/ergonomics/holding.py.

Which frames lie in a run of time over which a value stays within a band. Twin: tests/opsim/ergonomics/holding.py.
"""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.kernels.compiled import compiled


@compiled(nogil=True)
def hold_parts(value, seconds, edges, band, begins):
    """Set ``begins`` (N,) True for every frame with which a hold begins.

    Run i is the frames from edges[i] to edges[i + 1]. Of each, the part that lasts longest of all in which the range of
    value is at most ``band`` is a hold (the earliest of several), and so on with what is left before and after it.
    """
    n = value.size
    until, passed_s = _until(value, band), np.zeros(n + 1)
    for i in range(n):
        passed_s[i + 1] = passed_s[i] + seconds[i]
    stack = np.empty((n + 1, 2), np.int64)
    for run in range(edges.size - 1):
        stack[0, 0], stack[0, 1] = edges[run], edges[run + 1]
        depth = 1
        while depth:
            depth -= 1
            first, last = stack[depth, 0], stack[depth, 1]
            best, best_s = first, -1.0
            for i in range(first, last):
                lasting_s = passed_s[min(until[i], last)] - passed_s[i]
                if lasting_s > best_s * (1.0 + 1e-12):
                    best, best_s = i, lasting_s
            end = min(until[best], last)
            begins[best] = True
            if best > first:
                stack[depth, 0], stack[depth, 1] = first, best
                depth += 1
            if end < last:
                stack[depth, 0], stack[depth, 1] = end, last
                depth += 1


@compiled(nogil=True)
def _until(value, band):
    """(N,) up to which frame, itself left out, the range of value from each frame on is at most ``band``."""
    n = value.size
    until = np.full(n, n, np.int64)
    high, low = np.empty(n, np.int64), np.empty(n, np.int64)
    high_from, high_to, low_from, low_to = 0, 0, 0, 0
    left = 0
    for right in range(n):
        x = value[right]
        while high_to > high_from and value[high[high_to - 1]] <= x:
            high_to -= 1
        while low_to > low_from and value[low[low_to - 1]] >= x:
            low_to -= 1
        high[high_to], low[low_to] = right, right
        high_to, low_to = high_to + 1, low_to + 1
        while value[high[high_from]] - value[low[low_from]] > band:
            until[left] = right
            left += 1
            if high[high_from] < left:
                high_from += 1
            if low[low_from] < left:
                low_from += 1
    return until


@compiled(error_model="numpy", nogil=True)
def held(value, start_s, end_s, backward, forward, band, least_s, gap_s, mark):
    """Set ``mark`` (N,) True for every frame of some run of frames that lasts longer than ``least_s``, without a gap in
    time beyond ``gap_s``, in which value is always above ``forward`` or below minus ``backward``, and its range is at
    most ``band``.

    Two queues of indices keep the run's largest and least.
    """
    n = value.size
    high, low = np.empty(n, np.int64), np.empty(n, np.int64)
    high_from, high_to, low_from, low_to = 0, 0, 0, 0
    left, marked_to = 0, 0
    for right in range(n):
        x = value[right]
        broken = right > 0 and start_s[right] - end_s[right - 1] > gap_s
        out = x > forward or x < -backward
        if broken or not out:
            left = right if out else right + 1
            high_from, high_to, low_from, low_to = 0, 0, 0, 0
            if not out:
                continue
        while high_to > high_from and value[high[high_to - 1]] <= x:
            high_to -= 1
        while low_to > low_from and value[low[low_to - 1]] >= x:
            low_to -= 1
        high[high_to], low[low_to] = right, right
        high_to, low_to = high_to + 1, low_to + 1
        while value[high[high_from]] - value[low[low_from]] > band:
            left += 1
            if high[high_from] < left:
                high_from += 1
            if low[low_from] < left:
                low_from += 1
        if end_s[right] - start_s[left] > least_s:
            for place in range(max(left, marked_to), right + 1):
                mark[place] = True
            marked_to = right + 1
