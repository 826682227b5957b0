"""Local frames: three points that move with a joint say where it is when it is not seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def companions(
    positions_m: np.ndarray,
    joint: int,
    seen: np.ndarray,
    rigid_m: float,
    pieces: Sequence[slice] = (slice(None),),
    most_wander_m: float = np.inf,
) -> list[int]:
    """Three points that move with ``joint``: the first two at a distance that varies by ``rigid_m`` at most, the third
    the one in whose frame the joint wanders least.

    positions_m : (T, J, 3), nan where not seen
    seen        : (T,) the frames in which they must be seen: those to be filled, and one on either side
    most_wander_m : standard deviation of the joint's place in their frame beyond which they say too little
    pieces      : the stretches within which the distance is looked at; the joint may have stepped between them
    returns     : three joint numbers that never lie in one line, or none where there are not three
    """
    away = np.linalg.norm(positions_m - positions_m[:, joint : joint + 1], axis=-1)
    known = np.isfinite(positions_m).all(axis=-1)
    counted = sum(np.isfinite(away[piece]).sum(axis=0) for piece in pieces)
    mean = sum(np.nansum(away[piece], axis=0) for piece in pieces) / np.maximum(counted, 1)
    spread = np.sqrt(sum(_square_sum(away[piece]) for piece in pieces) / np.maximum(counted, 1))
    usable = known[seen].all(axis=0) & (counted > 3) & (mean > 1e-6)
    usable[joint] = False
    order = [int(j) for j in np.lexsort((np.round(mean, 6), np.round(spread, 4))) if usable[j]]
    if len(order) < 3 or spread[order[1]] > rigid_m:
        return []
    possible = [third for third in order[2:] if _in_no_line(positions_m[seen][:, [order[0], order[1], third]])]
    if not possible:
        return []
    whole = np.concatenate([np.arange(len(positions_m))[piece] for piece in pieces])
    wander = {third: _wander(positions_m[whole], joint, [order[0], order[1], third]) for third in possible}
    third = min(wander, key=lambda j: wander[j])
    return [order[0], order[1], third] if wander[third] <= most_wander_m else []


def _wander(positions_m: np.ndarray, joint: int, three: list[int]) -> float:
    """Standard deviation of the joint's place in the frame of three points, over the frames in which all are seen."""
    known = np.isfinite(positions_m[:, [joint, *three]]).all(axis=(1, 2))
    part = positions_m[known]
    local = into(local_frame(part[:, three]), part[:, joint])
    return float(np.sqrt(local.var(axis=0).sum()))


def _square_sum(away_m: np.ndarray) -> np.ndarray:
    """(J,) sum of squares about the mean of each column of (T, J), nan left out."""
    counted = np.maximum(np.isfinite(away_m).sum(axis=0), 1)
    return np.asarray(np.nansum((away_m - np.nansum(away_m, axis=0) / counted) ** 2, axis=0))


def _in_no_line(triangle: np.ndarray) -> bool:
    """Whether three points (T, 3, 3) are never near one line: the sine of their angle stays above 0.1."""
    one, other = triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0]
    lengths = np.linalg.norm(one, axis=-1) * np.linalg.norm(other, axis=-1)
    return bool(np.all(np.linalg.norm(np.cross(one, other), axis=-1) > 0.1 * np.maximum(lengths, 1e-9)))


def local_frame(triangle_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The place (T, 3) and the axes (T, 3, 3), in columns, of three points (T, 3, 3)."""
    first = triangle_m[:, 1] - triangle_m[:, 0]
    first = first / np.maximum(np.linalg.norm(first, axis=-1, keepdims=True), 1e-12)
    across = np.cross(first, triangle_m[:, 2] - triangle_m[:, 0])
    across = across / np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-12)
    axes = np.stack([first, np.cross(across, first), across], axis=-1)
    return triangle_m.mean(axis=1), axes


def into(frame: tuple[np.ndarray, np.ndarray], points_m: np.ndarray) -> np.ndarray:
    """Points (T, 3) of the world as seen from the frame."""
    place, axes = frame
    return np.einsum("tcl,tc->tl", axes, points_m - place)


def out_of(frame: tuple[np.ndarray, np.ndarray], local_m: np.ndarray) -> np.ndarray:
    """Points (T, 3) of the frame in the world."""
    place, axes = frame
    return np.einsum("tcl,tl->tc", axes, local_m) + place
