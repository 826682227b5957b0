"""Measures of postures, frame by frame. Twin: ``posture_measures.measures_of_positions``.

No measure asks for a place or a heading, so joints are hung on the root wherever that stands. Angles are left as pairs
(opposite, adjacent), whose arc tangents are taken for many frames at once.
"""

from __future__ import annotations

import math

import numpy as np

from opsim.ergonomics.kernels.arctan import arctan2_deg
from opsim.ergonomics.kernels.compiled import compiled
from opsim.ergonomics.kernels.measured_parts import N_ANGLES, NECK_FLEXION, arm, beside, heights, leg, reach, trunk

TOGETHER = 64
"""Frames whose pairs are held at a time: they should stay in the cache."""


@compiled(error_model="numpy", nogil=True)
def measure_hung(directions, lengths_m, chain, at, neutral_deg, gravity, out):
    """Measures out (n, S, COLUMNS) of bones with directions (n, S, B, 3) and lengths (n, B).

    chain (B, 3) : bone, parent and child joint from the root outwards
    at (21,)     : the joint at each place of ``joints.CANONICAL``; J, beyond the last, where the skeleton has none
    gravity      : whether flexion and abduction of arms are taken against gravity and not the trunk
    """
    joints_m = np.full((chain.shape[0] + 2, 3), math.nan)
    joints_m[chain[0, 1]] = 0.0
    for i in range(out.shape[0]):
        for start in range(0, out.shape[1], TOGETHER):
            stop = min(start + TOGETHER, out.shape[1])
            opposite, adjacent = np.empty((stop - start, N_ANGLES)), np.empty((stop - start, N_ANGLES))
            for s in range(start, stop):
                _hang(directions[i, s], lengths_m[i], chain, joints_m)
                _measure(joints_m, at, gravity, opposite[s - start], adjacent[s - start], out[i, s])
            _angles(opposite, adjacent, neutral_deg, out[i, start:stop])


@compiled(error_model="numpy", nogil=True)
def measure_joints(positions_m, at, neutral_deg, gravity, out):
    """Measures out (N, COLUMNS) of joints positions_m (N, J, 3); the others as ``measure_hung``."""
    n_joints = positions_m.shape[1]
    joints_m = np.full((n_joints + 1, 3), math.nan)
    for start in range(0, out.shape[0], TOGETHER):
        stop = min(start + TOGETHER, out.shape[0])
        opposite, adjacent = np.empty((stop - start, N_ANGLES)), np.empty((stop - start, N_ANGLES))
        for s in range(start, stop):
            joints_m[:n_joints] = positions_m[s]
            _measure(joints_m, at, gravity, opposite[s - start], adjacent[s - start], out[s])
        _angles(opposite, adjacent, neutral_deg, out[start:stop])


@compiled(error_model="numpy", nogil=True)
def _hang(directions, lengths_m, chain, joints_m):
    """Joints (J + 1, 3) at the ends of bones from the root, which stays; the last is nobody's."""
    for link in range(chain.shape[0]):
        bone, parent, child = chain[link, 0], chain[link, 1], chain[link, 2]
        for axis in range(3):
            joints_m[child, axis] = joints_m[parent, axis] + directions[bone, axis] * lengths_m[bone]


@compiled(error_model="numpy", nogil=True)
def _measure(joints_m, at, gravity, opposite, adjacent, out):
    """One posture: pairs of its angles (N_ANGLES,), and lengths into out (COLUMNS,) behind them."""
    forward, left, frame = trunk(joints_m, at, opposite, adjacent)
    for side in range(2):
        arm(joints_m, at, side, forward, left, frame, gravity, opposite, adjacent)
        leg(joints_m, at, side, opposite, adjacent)
        beside(joints_m, at, side, frame, out)
    heights(joints_m, at, out)
    reach(joints_m, at, forward, left, out)


@compiled(error_model="numpy", nogil=True)
def _angles(opposite, adjacent, neutral_deg, out):
    degrees = np.empty(opposite.size)
    arctan2_deg(opposite.reshape(-1), adjacent.reshape(-1), degrees)
    out[:, :N_ANGLES] = degrees.reshape(opposite.shape)
    out[:, NECK_FLEXION] -= neutral_deg
