"""Joints through time as rotations of a hierarchy, so that every joint comes back to where it was.

A joint with one child turns it by the least rotation from where its parent's turn would leave it (no twist of its own);
with several, by the best rigid rotation. What rotation cannot do, position channels do.
"""

from __future__ import annotations

import numpy as np

from emulator.recordings.bvh import BvhFile
from emulator.recordings.euler import best_turn, calm_order, euler_deg, least_turn
from emulator.recordings.take import Take
from emulator.skeleton import canonical_names

MOVES = ("Xposition", "Yposition", "Zposition")
DECIMALS = 9
"""Of an OFFSET: a bone is as long as it was to 1e-11 m."""
_RIGID_M = 1e-8
"""A joint further than this from where rotation alone brings it has position channels."""
_FLAT = 1e-6
_UP, _LEFT, _FORWARD = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


def bvh_of(take: Take, unit_m: float) -> BvhFile:
    """A take as a BVH file in units of ``unit_m``, Y up: (x, y, z) becomes (x, z, -y), so that who faces -y faces Z.

    Raises ValueError for markers, several roots, and gaps, naming joint and frame of the first.
    """
    parents, children, order = _tree(take)
    places = np.stack([take.positions_m[..., 0], take.positions_m[..., 2], -take.positions_m[..., 1]], axis=-1)
    rest = _rest(take.names, children, places)
    turned: dict[int, np.ndarray] = {-1: np.broadcast_to(np.eye(3), (take.n_frames, 3, 3))}
    channels, columns = {}, []
    for joint in order:
        parent = parents[joint]
        within = places[:, children[joint]] - places[:, [joint]]
        turned[joint] = _turn(rest[children[joint]], within, turned[parent])
        local = np.swapaxes(turned[parent], 1, 2) @ turned[joint]
        place = places[:, joint] - (places[:, parent] if parent >= 0 else 0.0)
        place = np.einsum("tba,tb->ta", turned[parent], place)
        moves = parent < 0 or np.abs(place - rest[joint]).max() > _RIGID_M
        axes = calm_order(local)
        turns = tuple(f"{axis}rotation" for axis in axes)
        channels[joint] = (*MOVES, *turns) if moves else turns
        columns += [place / unit_m] * bool(moves) + [euler_deg(local, axes)]
    leaves = tuple(i for i, joint in enumerate(order) if not children[joint])
    return BvhFile(
        names=tuple(take.names[joint] for joint in order),
        parents=tuple(order.index(parents[joint]) if parents[joint] >= 0 else -1 for joint in order),
        offsets=np.round(rest[order] / unit_m, DECIMALS),
        channels=tuple(channels[joint] for joint in order),
        end_parents=leaves,
        end_offsets=np.zeros((len(leaves), 3)),
        values=np.hstack(columns),
        frame_time_s=1.0 / take.rate_hz,
    )


def _turn(rest: np.ndarray, vectors: np.ndarray, before: np.ndarray) -> np.ndarray:
    """World rotation (T, 3, 3) of a joint whose children rest at (C, 3), are at (T, C, 3); ``before``: its parent's."""
    length = np.linalg.norm(rest, axis=1)
    rest, vectors, length = rest[length > 0], vectors[:, length > 0], length[length > 0]
    if not len(rest):
        return before
    longest = int(length.argmax())
    spread = np.linalg.svd(rest, compute_uv=False)
    if len(rest) > 1 and spread[1] > _FLAT * spread[0]:
        return best_turn(rest, vectors)
    reached = np.linalg.norm(vectors[:, longest], axis=1, keepdims=True)
    start = before @ (rest[longest] / length[longest])
    end = np.where(reached > 0, vectors[:, longest] / np.where(reached > 0, reached, 1.0), start)
    return least_turn(start, end) @ before


def _rest(names: tuple[str, ...], children: dict[int, list[int]], places: np.ndarray) -> np.ndarray:
    """Rest displacement (J, 3) of each joint from its parent: bone lengths as in the median frame, a T by the names.

    Children of one joint keep the shape of the first frame among each other, turned as near to the T as it goes.
    """
    rest = np.zeros((len(names), 3))
    wanted = _wanted(names)
    for joint, below in children.items():
        if not below:
            continue
        vectors = places[:, below] - places[:, [joint]]
        length = np.median(np.linalg.norm(vectors, axis=2), axis=0)
        first = np.linalg.norm(vectors[0], axis=1)
        shape = vectors[0] * (length / np.where(first > 0, first, 1.0))[:, None]
        if wanted is not None and len(below) == 1:
            shape = wanted[below] * length[:, None]
        elif wanted is not None:
            shape = shape @ best_turn(shape, (wanted[below] * length[:, None])[None])[0].T
        rest[below] = shape
    return rest


def _wanted(names: tuple[str, ...]) -> np.ndarray | None:
    """(J, 3) where a standing body with arms held sideways has each bone; None where the names do not say."""
    try:
        known = canonical_names(names)
    except ValueError:
        return None
    return np.array([_direction(name) for name in known])


def _direction(name: str) -> np.ndarray:
    side, _, part = name.partition("_")
    if side not in ("left", "right"):
        return _UP
    if part in ("knee", "ankle", "heel"):
        return -_UP
    if part in ("toe", "foot"):
        return _FORWARD
    return _LEFT if side == "left" else -_LEFT


def _tree(take: Take) -> tuple[tuple[int, ...], dict[int, list[int]], list[int]]:
    """Parents, children of each joint, and the joints depth first."""
    if take.parents is None:
        raise ValueError(f"take {take.name}: markers have no bones; map them to joints before they are written as BVH")
    if take.parents.count(-1) != 1:
        raise ValueError(f"take {take.name}: found {take.parents.count(-1)} roots, expected one")
    gaps = np.argwhere(~np.isfinite(take.positions_m).all(axis=2))
    if len(gaps):
        frame, joint = gaps[0]
        raise ValueError(
            f"take {take.name}: joint {take.names[joint]!r} has no place at frame {frame}; fill gaps first"
        )
    children: dict[int, list[int]] = {joint: [] for joint in range(len(take.names))}
    for joint, parent in enumerate(take.parents):
        if parent >= 0:
            children[parent].append(joint)
    order, waiting = [], [take.parents.index(-1)]
    while waiting:
        order.append(waiting.pop())
        waiting += reversed(children[order[-1]])
    if len(order) < len(take.names):
        raise ValueError(f"take {take.name}: found {len(take.names) - len(order)} joints that do not hang on the root")
    return take.parents, children, order
