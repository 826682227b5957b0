"""How many points of RULA each region of a body brings in, posture by posture. Twin: ``explained.explain``.

NOTE: nothing of other kernels is used here, as what numba keeps on disk knows changes of this file only.
"""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.kernels.compiled import compiled

PARTS = ("trunk", "neck", "arms", "wrists", "legs", "load", "time")
TRUNK, NECK, ARMS, WRISTS, LEGS, LOAD, TIME = range(7)
SETS = 2 ** len(PARTS)


@compiled(error_model="numpy", nogil=True)
def _rula(codes, forearm, force, time, there, table_a, table_b, table_c):
    """RULA of the worse arm, with the parts that are not in the set ``there`` (a bit each) at their least.

    codes (9,): neck, trunk, legs, upper arm, lower arm and wrist of the left arm, then of the right
    """
    more = (time if there >> TIME & 1 else 0) + (force if there >> LOAD & 1 else 0)
    neck = codes[0] if there >> NECK & 1 else 1
    trunk = codes[1] if there >> TRUNK & 1 else 1
    legs = codes[2] if there >> LEGS & 1 else 1
    d = min(table_b[neck - 1, trunk - 1, legs - 1] + more, 7)
    twist = forearm if there >> WRISTS & 1 else 1
    worst = 0
    for first in (3, 6):
        upper = codes[first] if there >> ARMS & 1 else 1
        lower = codes[first + 1] if there >> ARMS & 1 else 1
        wrist = codes[first + 2] if there >> WRISTS & 1 else 1
        c = min(table_a[upper - 1, lower - 1, wrist - 1, twist - 1] + more, 8)
        worst = max(worst, table_c[c - 1, d - 1])
    return worst


@compiled(error_model="numpy", nogil=True)
def drive(codes, said, time, weights, table_a, table_b, table_c, out):
    """Write the Shapley value of each part, (N, 7), of the middle of low and high.

    codes (N, 9, 2) sub-scores as ``_rula`` has them, low and high; said (2, 2, 2): of empty hands and of loaded ones,
    forearm and force, low and high, chosen by time[:, 1]; time (N, 2): points of muscle use, whether hands are loaded
    weights (7,): of a set of so many other parts
    """
    worth = np.empty(SETS)
    for n in range(len(codes)):
        loaded = time[n, 1]
        for there in range(SETS):
            worth[there] = 0.0
            for end in range(2):
                worth[there] += 0.5 * _rula(
                    codes[n, :, end], said[loaded, 0, end], said[loaded, 1, end], time[n, 0], there,
                    table_a, table_b, table_c,
                )  # fmt: skip
        for part in range(7):
            out[n, part] = 0.0
        for there in range(SETS):
            size = 0
            for part in range(7):
                size += there >> part & 1
            for part in range(7):
                if not there >> part & 1:
                    out[n, part] += weights[size] * (worth[there | 1 << part] - worth[there])
