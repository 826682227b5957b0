"""What is taken out of a recording before it is modelled: the heading, and repetitions that no body can do.

Heading: directions turn with the body, so the yaw of the body is removed frame by frame and kept as a side channel.
Body frame (z up): y along the levelled hip line to the left, x = y cross up, forward. The hip line is
taken between the unit directions to both hips, so that the heading, as the posture, does not know the lengths of bones.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from emulator.skeleton import Skeleton

IMPOSSIBLE_M_PER_S = 13.0
"""No joint of a working or exercising person is faster: above, a marker has jumped. A jump below it passes unseen."""
LYING_SHARE = 0.2
"""Where the levelled hip line is shorter than this share of it, the heading is bridged from the frames around."""


def turn(vectors: np.ndarray, yaw_rad: np.ndarray | float) -> np.ndarray:
    """The vectors (..., 3) turned by ``yaw_rad`` (broadcast against (...)) about the vertical, x towards y."""
    cosine, sine = np.cos(yaw_rad), np.sin(yaw_rad)
    x, y, z = np.moveaxis(np.asarray(vectors, float), -1, 0)
    return np.stack(np.broadcast_arrays(cosine * x - sine * y, sine * x + cosine * y, z), axis=-1)


def heading_rad(skeleton: Skeleton, positions: np.ndarray) -> np.ndarray:
    """Unwrapped yaw (T,) of the body over the frames (T, J, 3): 0 looks along x, pi/2 along y.

    Where the hip line stands upright (lying on a side) the yaw is interpolated from the frames around.
    Raises ValueError where the skeleton has no hips, or never a level hip line.
    """
    directions, bones = skeleton.directions(positions), skeleton.bone_names
    left, right = (bones.index(skeleton.names[skeleton.index(f"{side}_hip")]) for side in ("left", "right"))
    hips = directions[:, left] - directions[:, right]
    level = np.hypot(hips[:, 0], hips[:, 1])
    clear = np.flatnonzero(level > LYING_SHARE * np.linalg.norm(hips, axis=-1))
    if clear.size == 0:
        raise ValueError("heading: the hip line is never level; the body has no heading")
    yaw = np.unwrap(np.arctan2(-hips[clear, 0], hips[clear, 1]))
    return np.interp(np.arange(len(positions)), clear, yaw)


def top_speed_m_per_s(positions: np.ndarray, rate_hz: float) -> float:
    """The greatest speed of any joint between two frames of (T, J, 3)."""
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=-1).max() * rate_hz)


def glitch(
    positions: np.ndarray, rate_hz: float, limit_m_per_s: float = IMPOSSIBLE_M_PER_S, names: Sequence[str] = ()
) -> str:
    """Why a repetition (T, J, 3) cannot be a body's movement, or "" if nothing speaks against it.

    names : of the joints; with them the first joint and time are told
    """
    missing = np.argwhere(~np.isfinite(positions).all(axis=-1))
    if len(missing):
        frame, joint = missing[0]
        where = f": {names[joint]} at frame {frame} ({frame / rate_hz:.2f} s)" if names else ""
        more = f", and {len(missing) - 1} more" if where and len(missing) > 1 else ""
        return f"positions are missing{where}{more}"
    if top_speed_m_per_s(positions, rate_hz) <= limit_m_per_s:
        return ""
    speed = np.linalg.norm(np.diff(positions, axis=0), axis=-1) * rate_hz
    frame, joint = np.unravel_index(speed.argmax(), speed.shape)
    where = f": {names[joint]} from frame {frame} to {frame + 1} ({(frame + 1) / rate_hz:.2f} s)" if names else ""
    return f"a joint moves at {speed.max():.1f} m/s (at most {limit_m_per_s:g}){where}"
