"""Which frames lie in a run of time over which a value stays within a band. Twin: tests/opsim/ergonomics/holding.py."""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.kernels.compiled import compiled


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
