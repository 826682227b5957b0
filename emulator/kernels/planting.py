"""Where feet belong, frame by frame: planted stances, flights between them, and what is missing at both ends of these.

Its twin: tests/naive/walk.py, all frames at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from emulator.kernels.compiled import compiled

EASY, SPARE = 0.975, 0.018
"""Share of a leg's length up to which it stretches freely; what is asked beyond is drawn in to EASY + SPARE at most."""
BEHIND = 0.25
"""Only a foot this share of a leg behind its hip raises its heel with full effect: who stands, stands flat."""
SOFT_M = 0.001
"""How softly a flying foot turns its toe away from the floor."""
LOWEST = -0.995
"""A foot stands on its toe at most this steeply (a sine)."""


class Foot(NamedTuple):
    """The S stances of one foot: see ``stances.FootStances``."""

    on_s: np.ndarray
    rise_s: np.ndarray
    off_s: np.ndarray
    ankle_m: np.ndarray
    way_rad: np.ndarray
    missing: np.ndarray
    missing_per_s: np.ndarray
    flat: float
    foot_m: float
    toe_least_m: float
    leg_m: float


@compiled(error_model="numpy", nogil=True)
def point(way_rad, height, out):
    """Writes the unit vector (3,) to a side seen from above, of this z."""
    height = min(max(height, -0.999), 0.999)
    level = np.sqrt(1.0 - height**2)
    out[0], out[1], out[2] = level * np.cos(way_rad), level * np.sin(way_rad), height


@compiled(error_model="numpy", nogil=True)
def eased(u):
    """0 to 1 over u from 0 to 1, softly."""
    u = min(max(u, 0.0), 1.0)
    return u * u * (3.0 - 2.0 * u)


@compiled(error_model="numpy", nogil=True)
def apart(one, other):
    """Metres between two places (3,)."""
    return np.sqrt((one[0] - other[0]) ** 2 + (one[1] - other[1]) ** 2 + (one[2] - other[2]) ** 2)


@compiled(error_model="numpy", nogil=True)
def drawn_in(apart_m, leg_m):
    """How far hip and ankle may be apart, where the posture says ``apart_m``: the same up to EASY of the leg."""
    beyond = apart_m / leg_m - EASY
    return leg_m * (EASY - SPARE * np.expm1(-beyond / SPARE)) if beyond > 0 else apart_m


@compiled(error_model="numpy", nogil=True)
def heel_up(pitch, toe, way_rad, foot_m, hip_m, leg_m, scratch):
    """The lower pitch at which the leg is as long as ``drawn_in`` lets it be (law of cosines); LOWEST if none."""
    point(way_rad, pitch, scratch)
    for c in range(3):
        scratch[c] = toe[c] - foot_m * scratch[c]
    wanted = drawn_in(apart(scratch, hip_m), leg_m)
    x, y, z = toe[0] - hip_m[0], toe[1] - hip_m[1], toe[2] - hip_m[2]
    ahead = x * np.cos(way_rad) + y * np.sin(way_rad)
    share = (x * x + y * y + z * z + foot_m**2 - wanted**2) / (2.0 * foot_m * np.hypot(ahead, z))
    angle = np.arctan2(z, ahead) + np.arccos(min(max(share, -1.0), 1.0))
    return min(np.sin(max(angle, np.arcsin(LOWEST))), pitch)


@compiled(error_model="numpy", nogil=True)
def plant(pitch, place, way_rad, flat, foot_m, hip_m, leg_m, ankle, foot, scratch):
    """Writes ankle and direction (3,) of a foot that bears at ``place``; pitch is the z of the posture's foot."""
    toe = scratch[0]
    point(way_rad, flat, toe)
    for c in range(3):
        toe[c] = place[c] + foot_m * toe[c]
    point(way_rad, min(pitch, flat), foot)
    for c in range(3):
        ankle[c] = toe[c] - foot_m * foot[c]
    ahead = (hip_m[0] - ankle[0]) * np.cos(way_rad) + (hip_m[1] - ankle[1]) * np.sin(way_rad)
    behind = eased(ahead / (BEHIND * leg_m))
    if behind > 0 and apart(ankle, hip_m) > EASY * leg_m:
        now = min(pitch, flat)
        up = heel_up(now, toe, way_rad, foot_m, hip_m, leg_m, scratch[1])
        pitch = min(pitch + behind * (up - pitch), now)
        point(way_rad, pitch, foot)
        for c in range(3):
            ankle[c] = toe[c] - foot_m * foot[c]
    point(way_rad, pitch, foot)


@compiled(error_model="numpy", nogil=True)
def fly(time_s, at, own, foot_way, pitch, raw, hip_m, ankle, foot):
    """Writes ankle and direction (3,) of a foot in flight after stance ``at``: the posture's, plus what is missing.

    raw (3,) the posture's ankle; what is missing goes over in a cubic with its rates, held before and after all.
    """
    last = at == own.on_s.size - 1
    following = at if last else at + 1
    fly_s = max(own.on_s[following] - own.off_s[at], 1e-6)
    over = (time_s - own.off_s[at]) / fly_s
    u = min(max(over, 0.0), 1.0)
    start_by, leave_by = (1.0 + 2.0 * u) * (1.0 - u) ** 2, u * (1.0 - u) ** 2 * fly_s
    end_by, arrive_by = u**2 * (3.0 - 2.0 * u), u**2 * (1.0 - u) * fly_s
    for c in range(5):
        missing = own.missing[at, 1, c]
        if not last:
            missing = missing * start_by + own.missing[following, 0, c] * end_by
            missing += own.missing_per_s[at, 1, c] * leave_by - own.missing_per_s[following, 0, c] * arrive_by
        if c < 3:
            ankle[c] = raw[c] + missing
        elif c == 3:
            foot_way += missing
        else:
            pitch += missing
    distance = apart(ankle, hip_m)
    nearer = drawn_in(distance, own.leg_m) / max(distance, 1e-9)
    by = eased(over / 0.25) * eased((1.0 - over) / 0.5)
    for c in range(3):
        ankle[c] += by * (hip_m[c] + (ankle[c] - hip_m[c]) * nearer - ankle[c])
    soft = SOFT_M * (1.0 + 6.0 * min(max(4.0 * over * (1.0 - over), 0.0), 1.0)) / own.foot_m
    least = min((own.toe_least_m - ankle[2]) / own.foot_m, 0.9)
    pitch = min(max(pitch, -0.999), 0.999)
    want = (least - pitch) / soft
    point(foot_way, pitch + soft * (max(want, 0.0) + np.log1p(np.exp(-abs(want)))), foot)


@compiled(error_model="numpy", nogil=True)
def foot_of(joints, leg, out):
    """Writes the unit vector (3,) from ankle to toe of joints (J, 3)."""
    length = apart(joints[leg[3]], joints[leg[2]])
    for c in range(3):
        out[c] = (joints[leg[3], c] - joints[leg[2], c]) / length


@compiled(error_model="numpy", nogil=True)
def targets(time_s, joints, leg, own, ankles, feet):
    """Writes ankles and feet (T, 3) of one side at times (T,), for joints (T, J, 3); leg (4,) from hip to toe."""
    scratch = np.empty((2, 3))
    for t in range(time_s.size):
        foot_of(joints[t], leg, feet[t])
        at = 0
        while at + 1 < own.on_s.size and own.on_s[at + 1] <= time_s[t]:
            at += 1
        pitch, hip_m = feet[t, 2], joints[t, leg[0]]
        if own.on_s[at] <= time_s[t] <= own.off_s[at]:
            if time_s[t] <= own.rise_s[at]:
                pitch = max(pitch, own.flat)
            plant(
                pitch,
                own.ankle_m[at],
                own.way_rad[at],
                own.flat,
                own.foot_m,
                hip_m,
                own.leg_m,
                ankles[t],
                feet[t],
                scratch,
            )
        else:
            way_rad = np.arctan2(feet[t, 1], feet[t, 0])
            fly(time_s[t], at, own, way_rad, pitch, joints[t, leg[2]], hip_m, ankles[t], feet[t])


@compiled(error_model="numpy", nogil=True)
def ways(joints, leg, feet, way):
    """Writes unit vectors of the feet (N, 3) and where they point to (N,), seen from above and without turns."""
    for t in range(way.size):
        foot_of(joints[t], leg, feet[t])
        way[t] = np.arctan2(feet[t, 1], feet[t, 0])
        if t > 0:
            way[t] -= 2.0 * np.pi * np.round((way[t] - way[t - 1]) / (2.0 * np.pi))


@compiled(error_model="numpy", nogil=True)
def gap_at(t, late, way_rad, place, flat, foot_m, leg_m, joints, leg, feet, way, scratch, out):
    """Writes what is missing (5,) in node t of a stance: planted ankle, angle and pitch less the posture's."""
    pitch = feet[t, 2] if late else max(feet[t, 2], flat)
    foot = scratch[2]
    plant(pitch, place, way_rad, flat, foot_m, joints[t, leg[0]], leg_m, out[:3], foot, scratch)
    for c in range(3):
        out[c] -= joints[t, leg[2], c]
    out[3] = way_rad - way[t]
    out[4] = foot[2] - feet[t, 2]


@compiled(error_model="numpy", nogil=True)
def settle(time_s, runs, joints, leg, place, foot_m, leg_m, flat, rise_s, way_rad, missing, missing_per_s):
    """Writes when heels rise (S,), where feet point (S,), what is missing and its rates (S, 2, 5) at ends of stances.

    time_s (N,), joints (N, J, 3) and runs (S, 2) in nodes; place (S, 3) where the ankles stand
    """
    feet, way = np.empty((time_s.size, 3)), np.empty(time_s.size)
    scratch, beside = np.empty((3, 3)), np.empty(5)
    ways(joints, leg, feet, way)
    for s in range(runs.shape[0]):
        start, stop = runs[s]
        n = stop - start
        low, high = start + n // 5, max(start + 3 * n // 5, start + 1)
        way_rad[s] = way[low:high].mean()
        rise = -1
        for t in range(start, stop):
            if feet[t, 2] >= flat:
                rise = t
        if stop == time_s.size or rise < 0:
            rise = stop
        rise_s[s] = time_s[rise] if rise < stop else np.inf
        for end in range(2):
            t, other = (stop - 1, stop - 2) if end else (start, start + 1)
            gap_at(
                t, t > rise, way_rad[s], place[s], flat, foot_m, leg_m, joints, leg, feet, way, scratch, missing[s, end]
            )
            missing_per_s[s, end] = 0.0
            if n > 1:
                gap_at(
                    other,
                    other > rise,
                    way_rad[s],
                    place[s],
                    flat,
                    foot_m,
                    leg_m,
                    joints,
                    leg,
                    feet,
                    way,
                    scratch,
                    beside,
                )
                missing_per_s[s, end] = (beside - missing[s, end]) / (time_s[other] - time_s[t])
