"""RULA, REBA and OWAS of many postures, each as low and high. Twin: tests/opsim/ergonomics/naive_scores.py.

Every sub-score is a pair (low, high), a row of ``codes``. RULA's and REBA's tables rise with each code, so that all the
lows give the low score; OWAS's does not, and is asked for every code that there may be.
NOTE: all in one file, the places of columns as an argument: numba's files on disk know of changes of this one alone.

How many points of RULA each region of a body brings in, posture by posture. Twin: ``explained.explain``.

NOTE: nothing of other kernels is used here, as what numba keeps on disk knows changes of this file only.
"""

from __future__ import annotations

import numpy as np

from opsim.ergonomics.kernels.compiled import compiled

NECK, TRUNK, LEGS = 0, 1, 2
REBA_NECK, REBA_TRUNK, REBA_LEGS = 3, 4, 5
BENT, TWISTED, ARMS_UP, OWAS_LEGS = 6, 7, 8, 9
ARM = 10
"""From here, for the left and then the right arm: upper arm, lower arm, wrist; REBA's upper arm, lower arm, wrist."""
ARM_CODES = 6
FORCE, FORCE_WORKSHEET, LOAD, OWAS_LOAD, COUPLING, RAPID, FOREARM, SUPPORTED, ONE_LEGGED, SITTING = range(10)
"""Rows of bounds."""
TWIST_LOW, TWIST_HIGH, SIDE_LOW, SIDE_HIGH, ABDUCTED, UPRIGHT, STRAIGHT, EXTENDED = range(8)
ACROSS, OUTSIDE, OWAS_BACK, OWAS_TWIST, OWAS_KNEE, SIDEWAYS = range(8, 14)
"""Places of thresholds."""


@compiled(error_model="numpy", nogil=True)
def _flag(value, low_edge, high_edge):
    """Whether |value| reaches an edge that lies between two: (low, high); nan may."""
    size = abs(value)
    if size >= high_edge:
        return 1, 1
    if size < low_edge:
        return 0, 0
    return 0, 1


@compiled(error_model="numpy", nogil=True)
def _above(value, edge):
    """Whether a value (not its size) reaches an edge."""
    if value >= edge:
        return 1, 1
    if value < edge:
        return 0, 0
    return 0, 1


@compiled(error_model="numpy", nogil=True)
def _flexed(flexion):
    """The upper arm's code from its flexion alone."""
    if flexion < -90.0 or flexion > 90.0:
        return 4, 4
    if flexion > 45.0:
        return 3, 3
    if flexion < -20.0 or flexion > 20.0:
        return 2, 2
    if flexion <= 20.0:
        return 1, 1
    return 1, 4


@compiled(error_model="numpy", nogil=True)
def _upper_arm(flexion, abduction, sideways):
    low, high = _flexed(flexion)
    if abs(abduction) <= sideways:
        return low, high
    # beyond, the elevation e, cos e = cos a cos f, is at most 90 where flexion is
    raised = (3, 3) if abs(flexion) <= 90.0 else (4, 4) if abs(flexion) > 90.0 else (3, 4)
    if abs(abduction) > sideways:
        return raised
    return min(low, raised[0]), max(high, raised[1])


@compiled(error_model="numpy", nogil=True)
def _step(value, first, second, third):
    """1 to ``first``, 2 to ``second``, 3 to ``third``, then 4; an edge belongs below it."""
    if value <= first:
        return 1, 1
    if value <= second:
        return 2, 2
    if value <= third:
        return 3, 3
    if value > third:
        return 4, 4
    return 1, 4


@compiled(error_model="numpy", nogil=True)
def _knees(left, right):
    """REBA's knees, 0-2 more: (low, high) of the worse."""
    low, high = 0, 0
    for bend in (left, right):
        if bend > 60.0:
            low, high = 2, 2
        elif bend >= 30.0:
            low, high = max(low, 1), max(high, 1)
        elif not bend < 30.0:
            high = 2
    return low, high


@compiled(error_model="numpy", nogil=True)
def _put(codes, row, pair):
    codes[row, 0], codes[row, 1] = pair


@compiled(error_model="numpy", nogil=True)
def _neck(flexion, extended):
    """RULA's neck: (low, high)."""
    return (4, 4) if flexion < -extended else _step(flexion, 10.0, 20.0, np.inf)


@compiled(error_model="numpy", nogil=True)
def _reba_neck(flexion, extended):
    if -extended <= flexion <= 20.0:
        return 1, 1
    return (1, 2) if np.isnan(flexion) else (2, 2)


@compiled(error_model="numpy", nogil=True)
def _owas_legs(left, right, edge, one_legged, sits, walking):
    """The digits of the legs that there may be, a bit each (digit 1 is bit 0); a knee is bent beyond ``edge``."""
    if walking:
        return 1 << 6
    mask = 1 if sits[1] == 1 else 0
    if sits[0] == 1:
        return mask
    fewest = int(left > edge) + int(right > edge)
    most = int(not left <= edge) + int(not right <= edge)
    if fewest < 2:  # a leg may be straight: 2 where both carry, 3 where one does
        mask |= (one_legged[0] == 0) << 1 | (one_legged[1] == 1) << 2
    if most > 0:  # a leg may be bent
        mask |= (one_legged[0] == 0) << 3 | (one_legged[1] == 1) << 4
    return mask


@compiled(error_model="numpy", nogil=True)
def _of_body(m, at, t, said, walking, codes):
    """Codes of neck, trunk and legs of one posture: rows 0-9."""
    trunk, neck, left_knee, right_knee = m[at[0]], m[at[3]], m[at[5]], m[at[6]]
    twisted = _flag(m[at[2]], t[TWIST_LOW], t[TWIST_HIGH])
    bent = _flag(m[at[1]], t[SIDE_LOW], t[SIDE_HIGH])
    neck_bent = _flag(m[at[4]], t[SIDE_LOW], t[SIDE_HIGH])
    edge = 180.0 - t[OWAS_KNEE]
    straight = left_knee <= edge and right_knee <= edge  # nobody sits so, unless it is said
    sits = said[SITTING, 0], said[SITTING, 0] if straight else said[SITTING, 1]
    knees = _knees(left_knee, right_knee)
    _put(codes, NECK, _neck(neck, t[EXTENDED]))
    _put(codes, REBA_NECK, _reba_neck(neck, t[EXTENDED]))
    _put(codes, TRUNK, _step(abs(trunk), t[UPRIGHT], 20.0, 60.0))
    _put(codes, REBA_TRUNK, (3, 3) if trunk < -20.0 else (codes[TRUNK, 0], codes[TRUNK, 1]))
    for end in range(2):
        may_sit = sits[1 - end] == 1
        if may_sit and trunk <= t[UPRIGHT]:
            codes[TRUNK, end] = 1
        codes[TRUNK, end] += twisted[end] + bent[end]
        codes[REBA_TRUNK, end] += max(twisted[end], bent[end])
        codes[NECK, end] += neck_bent[end]
        codes[REBA_NECK, end] += neck_bent[end]
        codes[LEGS, end] = 1 + said[ONE_LEGGED, end]
        codes[REBA_LEGS, end] = 1 if may_sit or walking else 1 + said[ONE_LEGGED, end] + knees[end]
    _put(codes, BENT, _flag(trunk, t[OWAS_BACK], t[OWAS_BACK]))
    turned, leant = _flag(m[at[2]], t[OWAS_TWIST], t[OWAS_TWIST]), _flag(m[at[1]], t[OWAS_TWIST], t[OWAS_TWIST])
    _put(codes, TWISTED, (max(turned[0], leant[0]), max(turned[1], leant[1])))
    left_up, right_up = _above(m[at[7]], 0.0), _above(m[at[8]], 0.0)
    _put(codes, ARMS_UP, (left_up[0] + right_up[0], left_up[1] + right_up[1]))
    legs = _owas_legs(left_knee, right_knee, edge, said[ONE_LEGGED], sits, walking)
    _put(codes, OWAS_LEGS, (legs, legs))


@compiled(error_model="numpy", nogil=True)
def _of_arm(m, at, t, said, codes, row):
    """Codes of an arm, six rows from ``row``; ``at`` are its flexion, abduction, elbow, wrist, across and outside."""
    upper = _upper_arm(m[at[0]], m[at[1]], t[SIDEWAYS])
    abducted = _flag(m[at[1]], t[ABDUCTED], t[ABDUCTED])
    elbow, wrist = m[at[2]], abs(m[at[3]])
    lower = (1, 1) if 60.0 <= elbow <= 100.0 else (1, 2) if np.isnan(elbow) else (2, 2)
    across, outside = _above(m[at[4]], t[ACROSS]), _above(m[at[5]], t[OUTSIDE])
    bent = _step(wrist, t[STRAIGHT], 15.0, np.inf)
    for end in range(2):
        out = max(across[end], min(outside[end], 1 - abducted[1 - end]))
        codes[row, end] = max(1, upper[end] + abducted[end] - said[SUPPORTED, 1 - end])
        codes[row + 1, end] = lower[end] + out
        codes[row + 2, end] = min(bent[end], 3)
        codes[row + 3, end] = codes[row, end]
        codes[row + 4, end] = lower[end]
        codes[row + 5, end] = max(1, min(bent[end], 3) - 1)


@compiled(error_model="numpy", nogil=True)
def find_codes(m, at, t, said, walking, codes):
    """Write the sub-scores (22, 2) of one posture ``m`` (COLUMNS,); ``at`` (21,) are the columns asked for."""
    _of_body(m, at[:9], t, said, walking, codes)
    _of_arm(m, at[9:15], t, said, codes, ARM)
    _of_arm(m, at[15:21], t, said, codes, ARM + ARM_CODES)


@compiled(error_model="numpy", nogil=True)
def rula_of(codes, said, force, muscle, end, tables):
    """RULA of the left and the right arm, from the low (0) or the high (1) of every sub-score."""
    a, b, c = tables[0], tables[1], tables[2]
    more = muscle + said[force, end]
    d = b[codes[NECK, end] - 1, codes[TRUNK, end] - 1, codes[LEGS, end] - 1] + more
    forearm = said[FOREARM, end] - 1
    left = a[codes[ARM, end] - 1, codes[ARM + 1, end] - 1, codes[ARM + 2, end] - 1, forearm] + more
    right = a[codes[ARM + 6, end] - 1, codes[ARM + 7, end] - 1, codes[ARM + 8, end] - 1, forearm] + more
    return c[min(left, 8) - 1, min(d, 7) - 1], c[min(right, 8) - 1, min(d, 7) - 1]


@compiled(error_model="numpy", nogil=True)
def reba_of(codes, said, activity, end, tables):
    """REBA of the left and the right arm, from the low (0) or the high (1) of every sub-score."""
    a, b, c = tables[3], tables[4], tables[5]
    posture = a[codes[REBA_NECK, end] - 1, codes[REBA_TRUNK, end] - 1, codes[REBA_LEGS, end] - 1]
    body = min(posture + said[LOAD, end], 12) - 1
    left = b[codes[ARM + 3, end] - 1, codes[ARM + 4, end] - 1, codes[ARM + 5, end] - 1] + said[COUPLING, end] - 1
    right = b[codes[ARM + 9, end] - 1, codes[ARM + 10, end] - 1, codes[ARM + 11, end] - 1] + said[COUPLING, end] - 1
    more = activity + said[RAPID, end]
    return c[body, left] + more, c[body, right] + more


@compiled(error_model="numpy", nogil=True)
def owas_of(codes, said, table):
    """Least and most action category over every code that there may be."""
    low, high = 4, 1
    for twisted in range(codes[TWISTED, 0], codes[TWISTED, 1] + 1):
        for bent in range(codes[BENT, 0], codes[BENT, 1] + 1):
            for legs in range(7):
                if codes[OWAS_LEGS, 0] >> legs & 1:
                    back = 2 * twisted + bent
                    low = min(low, table[back, codes[ARMS_UP, 0], legs, said[OWAS_LOAD, 0] - 1])
                    high = max(high, table[back, codes[ARMS_UP, 1], legs, said[OWAS_LOAD, 1] - 1])
    return low, high


@compiled(error_model="numpy", nogil=True)
def score_all(measures, at, t, phases, walking, force, repeated, static, carrying, tables, rula, reba, owas, worse):
    """Write RULA of the worse arm, REBA of the worse arm and OWAS, (N, 2) low and high, and the worse arm (N,).

    phases (2, 10, 2): what is said of empty hands and of loaded ones; force: the row of RULA's force that counts.
    worse: 1 where the right arm scores more than the left: RULA's low and high together, if even REBA's.
    """
    codes = np.empty((ARM + 2 * ARM_CODES, 2), np.int64)
    for n in range(len(measures)):
        said = phases[1 if carrying[n] else 0]
        find_codes(measures[n], at, t, said, walking, codes)
        muscle, activity = int(repeated[n] or static[n]), int(repeated[n]) + int(static[n])
        lead_rula, lead_reba = 0, 0
        for end in range(2):
            left, right = rula_of(codes, said, force, muscle, end, tables)
            rula[n, end] = max(left, right)
            lead_rula += right - left
            left, right = reba_of(codes, said, activity, end, tables)
            reba[n, end] = max(left, right)
            lead_reba += right - left
        worse[n] = lead_rula > 0 or (lead_rula == 0 and lead_reba > 0)
        owas[n, 0], owas[n, 1] = owas_of(codes, said, tables[6])


PARTS = ("trunk", "neck", "arms", "wrists", "legs", "load", "time")
DRIVEN_BY_TRUNK, DRIVEN_BY_NECK, DRIVEN_BY_ARMS, DRIVEN_BY_WRISTS, DRIVEN_BY_LEGS, DRIVEN_BY_LOAD, DRIVEN_BY_TIME = (
    range(7)
)
SETS = 2 ** len(PARTS)


@compiled(error_model="numpy", nogil=True)
def _rula(codes, forearm, force, time, there, table_a, table_b, table_c):
    """RULA of the worse arm, with the parts that are not in the set ``there`` (a bit each) at their least.

    codes (9,): neck, trunk, legs, upper arm, lower arm and wrist of the left arm, then of the right
    """
    more = (time if there >> DRIVEN_BY_TIME & 1 else 0) + (force if there >> DRIVEN_BY_LOAD & 1 else 0)
    neck = codes[0] if there >> DRIVEN_BY_NECK & 1 else 1
    trunk = codes[1] if there >> DRIVEN_BY_TRUNK & 1 else 1
    legs = codes[2] if there >> DRIVEN_BY_LEGS & 1 else 1
    d = min(table_b[neck - 1, trunk - 1, legs - 1] + more, 7)
    twist = forearm if there >> DRIVEN_BY_WRISTS & 1 else 1
    worst = 0
    for first in (3, 6):
        upper = codes[first] if there >> DRIVEN_BY_ARMS & 1 else 1
        lower = codes[first + 1] if there >> DRIVEN_BY_ARMS & 1 else 1
        wrist = codes[first + 2] if there >> DRIVEN_BY_WRISTS & 1 else 1
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
