"""Local frames: three points that move with a joint say where it is when it is not seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from emulator.cleaning.bridge import neighbours
from emulator.recordings.take import Take


def companions(
    take: Take,
    positions_m: np.ndarray,
    joint: int,
    seen: np.ndarray,
    rigid_m: float,
    pieces: Sequence[slice] = (slice(None),),
) -> list[int]:
    """Three points that move with ``joint``: the first two at a distance that varies by ``rigid_m`` at most, the third
    as few bones away as can be, so that an ankle stays in the plane of its leg.

    positions_m : (T, J, 3), nan where not seen
    seen        : (T,) the frames in which they must be seen: those to be filled, and one on either side
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
    bones = _bones_away(take, joint)
    for third in sorted(order[2:], key=lambda j: bones[j]):
        if _in_no_line(positions_m[seen][:, [order[0], order[1], third]]):
            return [order[0], order[1], third]
    return []


def _bones_away(take: Take, joint: int) -> list[int]:
    """How many bones lie between a joint and each; the same for all where the points are markers."""
    away = {joint: 0}
    edge = [joint]
    for here in edge:
        for other in neighbours(take, here):
            if other not in away:
                away[other] = away[here] + 1
                edge.append(other)
    return [away.get(j, len(take.names)) for j in range(len(take.names))]


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
    first = first / np.linalg.norm(first, axis=-1, keepdims=True)
    across = np.cross(first, triangle_m[:, 2] - triangle_m[:, 0])
    across = across / np.linalg.norm(across, axis=-1, keepdims=True)
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
