"""The way uphill from every point to a mode. Its twin: a plain double loop in tests/emulator/judge."""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled


@compiled(nogil=True)
def uphill(distances, density, radius):
    """The nearest point of higher density within ``radius`` of each point (n,), itself where there is none: a mode.

    Of equal densities the lower number is the higher; of equal distances the lower number is the nearer.
    """
    n = density.size
    above = np.arange(n)
    for i in range(n):
        nearest = radius
        for j in range(n):
            if distances[i, j] < nearest and (density[j] > density[i] or (density[j] == density[i] and j < i)):
                nearest = distances[i, j]
                above[i] = j
    return above
