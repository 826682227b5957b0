"""Trunk flexion of performances, through the seam alone: whoever gives postures can be measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from opsim.ergonomics.angles import TRUNK_JOINTS, trunk_flexion_rad

RATE_HZ = 10.0
"""Postures a second that are decoded."""
FINER = 4
"""Into so many parts the way from each posture to the next is cut, on a cubic through four postures.

Both were chosen beside 200 postures a second, over 5 x 768 performances of shipped movements: time beyond 20, 40 and 50
degrees is within 0.5 %, also where flexion only just gets there. Straight lines between 10 a second cut off peaks
(3 %), between 25 a second they still lose 0.5 to 2 %, at twice the cost.
"""
MOST_STEPS = 4096
"""Of one performance: those longer than 6.8 minutes are looked at less often."""
AT_ONCE = 2**20
"""Coordinates decoded at a time, 8 bytes each."""


def has_trunk(block: Any) -> bool:
    """Whether performances have a body with the joints that make a trunk."""
    return block.skeleton is not None and set(TRUNK_JOINTS) <= set(block.skeleton.names)


def rows_at_once(block: Any) -> int:
    """How many performances of a block may be decoded together."""
    return max(1, AT_ONCE // (3 * len(block.skeleton.names) * (_steps(block) + 1)))


def flexion_rad(block: Any, rows: Sequence[int] | np.ndarray) -> np.ndarray:
    """Trunk flexion (m, C) in the middles of C even parts of some performances of a block that has a trunk.

    C is the same for all of a block. nan where a posture, or one of its neighbours, has no flexion.
    Raises ValueError where the postures have another shape than the seam promises.
    """
    alone = hasattr(type(block), "__getitem__")
    some = block[np.asarray(rows)] if alone else block
    joints_m, names = _joints_m(some, _steps(block) + 1)
    return _finer(trunk_flexion_rad(joints_m if alone else joints_m[np.asarray(rows)], names))


def _steps(block: Any) -> int:
    """Even steps into which each performance of a block is cut: at most 1 / ``RATE_HZ`` s in the longest of them."""
    return int(np.clip(np.ceil(np.max(block.duration_s) * RATE_HZ), 1, MOST_STEPS))


def _finer(flexion: np.ndarray) -> np.ndarray:
    """(n, S + 1) radians at even points -> (n, S * FINER) between them; through their cosines and sines, so that
    nothing happens at 180 degrees.

    Source: Catmull & Rom 1974, A class of local interpolating splines (tension 1/2); the ends go on straight.
    """
    turn = np.exp(1j * flexion)
    turn = np.concatenate([2 * turn[:, :1] - turn[:, 1:2], turn, 2 * turn[:, -1:] - turn[:, -2:-1]], axis=1)
    t = (np.arange(FINER) + 0.5) / FINER
    weights = [-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, -(t**2) + t**3]
    n_steps = flexion.shape[1] - 1
    between = sum(turn[:, i : i + n_steps, None] * (0.5 * weight) for i, weight in enumerate(weights))
    return np.angle(between).reshape(len(flexion), -1)


def _joints_m(block: Any, n_times: int) -> tuple[np.ndarray, tuple[str, ...]]:
    """Joints (n, T, J, 3) in metres and their names (J,); heading and place are free, as angles know neither.

    NOTE: from directions and lengths of bones where there are both, in a fifth of the time of ``positions_m``, which
    finds the path over the floor.
    """
    if hasattr(block, "directions") and hasattr(block, "bone_length_m"):
        return _hung(block, n_times), TRUNK_JOINTS
    found = np.asarray(block.positions_m(n_times=n_times))
    expected = (len(block.duration_s), n_times, len(block.skeleton.names), 3)
    if found.shape != expected:
        raise ValueError(f"{type(block).__name__}.positions_m gave {found.shape}, expected {expected}")
    return found, tuple(block.skeleton.names)


def _hung(block: Any, n_times: int) -> np.ndarray:
    """(n, T, 4, 3) the joints of a trunk, from the root: each the sum of the bones that lead to it."""
    names, parents = list(block.skeleton.names), block.skeleton.parents
    directions = block.directions(n_times=n_times)
    lengths = np.asarray(block.bone_length_m)[:, None, :, None]
    bone_of = {joint: bone for bone, joint in enumerate(j for j, parent in enumerate(parents) if parent >= 0)}
    out = np.zeros((*directions.shape[:2], len(TRUNK_JOINTS), 3))
    for place, name in enumerate(TRUNK_JOINTS):
        joint = names.index(name)
        while joint in bone_of:
            bone = bone_of[joint]
            out[:, :, place] += directions[:, :, bone] * lengths[:, :, bone]
            joint = parents[joint]
    return out
