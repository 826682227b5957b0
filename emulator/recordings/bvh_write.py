"""BVH written: a file as it was read, or joints through time as a hierarchy with rotations.

Rotations as turns about three axes, one after the other, and rotations that bring one direction to another.

Joints through time as rotations of a hierarchy, so that every joint comes back to where it was.

A joint with one child turns it by the least rotation from where its parent's turn would leave it (no twist of its own);
with several, by the best rigid rotation. What rotation cannot do, position channels do.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import IO

import numpy as np

from emulator.motion import Motion
from emulator.recordings.bvh import BvhFile
from emulator.recordings.take import Take
from emulator.skeleton import canonical_names

DECIMALS = 7
"""Of centimetres and degrees: joints come back to 1e-8 m."""
UNIT_M = 0.01
_UNEVEN = 1e-6


def write_bvh(motion: Motion | Take, path: str | Path) -> None:
    """Joints through time as BVH in centimetres, Y up; on re-reading every joint is where it was to 1e-6 m.

    The root has six channels, the others three rotations, and position channels where a joint does not move rigidly
    with its parent (bones that breathe, or several children that move against each other). The rest posture is a
    T where the joints' names say what they are. Raises ValueError for markers, gaps, and uneven frames.
    """
    pass

    take = motion if isinstance(motion, Take) else _take(motion)
    write_bvh_file(bvh_of(take, UNIT_M), path, decimals=DECIMALS)


def write_bvh_file(file: BvhFile, path: str | Path, *, decimals: int | None = None) -> None:
    """A BVH file; ``decimals`` None writes the shortest digits that read back as the same numbers.

    Raises ValueError for values that are not finite or do not fit the channels; OSError where nothing can be written.
    """
    path = Path(path)
    n_channels = sum(map(len, file.channels))
    if np.shape(file.values)[1:] != (n_channels,) or not len(file.values):
        raise ValueError(f"{path}: found values {np.shape(file.values)}, expected (T, {n_channels}) with a frame")
    if not np.all(np.isfinite(file.values)) or not np.all(np.isfinite(file.offsets)):
        raise ValueError(f"{path}: found values that are not finite, expected numbers")
    part = path.with_name(path.name + ".part")
    try:
        with part.open("w", encoding="utf-8", newline="\n") as out:
            _write(file, out, decimals)
        part.replace(path)
    except OSError as error:
        with suppress(OSError):
            part.unlink()
        raise OSError(error.errno, error.strerror, str(path)) from None


def _write(file: BvhFile, out: IO[str], decimals: int | None) -> None:
    order = []
    out.write("HIERARCHY\n")
    for joint, line in _hierarchy(file):
        out.write(line + "\n")
        if joint is not None:
            order.append(joint)
    starts = np.cumsum([0, *map(len, file.channels)])
    columns = np.concatenate([np.arange(starts[j], starts[j + 1]) for j in order]).astype(int)
    out.write(f"MOTION\nFrames: {len(file.values)}\nFrame Time: {_plain(file.frame_time_s)}\n")
    row_form = " ".join([f"%.{decimals}f"] * len(columns)) + "\n"
    for row in file.values:
        values = row[columns].tolist()
        out.write(" ".join(map(_plain, values)) + "\n" if decimals is None else row_form % tuple(values))


def _hierarchy(file: BvhFile) -> Iterator[tuple[int | None, str]]:
    """(joint where one begins, line), depth first; a list of what is still open, not recursion."""
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(file.parents):
        children.setdefault(parent, []).append(joint)
    waiting: list[tuple[int, int]] = [(joint, 0) for joint in reversed(children.get(-1, []))]
    while waiting:
        joint, depth = waiting.pop()
        tab = "\t" * depth
        if joint < 0:
            yield None, f"{tab}}}"
            continue
        yield joint, f"{tab}{'JOINT' if depth else 'ROOT'} {_word(file.names[joint])}"
        yield None, f"{tab}{{\n{tab}\tOFFSET {_numbers(file.offsets[joint])}"
        yield None, " ".join([f"{tab}\tCHANNELS {len(file.channels[joint])}", *file.channels[joint]])
        for parent, offset in zip(file.end_parents, file.end_offsets):
            if parent == joint:
                yield None, f"{tab}\tEnd Site\n{tab}\t{{\n{tab}\t\tOFFSET {_numbers(offset)}\n{tab}\t}}"
        waiting.append((-1, depth))
        waiting += [(child, depth + 1) for child in reversed(children.get(joint, []))]


def _numbers(values: np.ndarray) -> str:
    return " ".join(map(_plain, values.tolist()))


def _plain(value: float) -> str:
    """The shortest digits that read back as this number, without an exponent: some importers know none."""
    text = repr(float(value))
    return np.format_float_positional(value, trim="0") if "e" in text else text


def _word(name: str) -> str:
    return "".join(" " if c.isspace() else "_" if c in "{}" else c for c in name) or "joint"


def _take(motion: Motion) -> Take:
    step_s = np.diff(motion.time_s)
    if np.ptp(step_s) > _UNEVEN * motion.duration_s:
        raise ValueError(
            f"motion {motion.name}: found frames {step_s.min():g} to {step_s.max():g} s apart, expected even"
        )
    return Take(
        motion.skeleton.names,
        motion.skeleton.parents,
        motion.positions_m(world=True),
        round(len(step_s) / motion.duration_s, 9),
        worker=motion.worker,
        trial=motion.trial,
    )


USUAL_ORDER = "ZXY"
ORDERS = (USUAL_ORDER, "ZYX", "XZY")
"""One with each axis in the middle, where 90 degrees lock the other two."""
_FAR_DEG = 70.0


def euler_deg(rotation: np.ndarray, order: str = USUAL_ORDER) -> np.ndarray:
    """(T, 3) degrees about the axes of ``order`` of rotations (T, 3, 3): "ZXY" is Rz Rx Ry. Unwrapped in time.

    Where the middle turn is 90 degrees the other two are one; the last is then 0.
    """
    i, j, k = ("XYZ".index(axis) for axis in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    across = np.hypot(rotation[:, i, j], rotation[:, i, i])
    middle = np.arctan2(sign * rotation[:, i, k], across)
    locked = across < 1e-7
    first = np.arctan2(-sign * rotation[:, j, k], rotation[:, k, k])
    last = np.arctan2(-sign * rotation[:, i, j], rotation[:, i, i])
    first[locked] = np.arctan2(sign * rotation[locked, k, j], rotation[locked, j, j])
    last[locked] = 0.0
    return np.degrees(np.unwrap(np.stack([first, middle, last], axis=1), axis=0))


def calm_order(rotation: np.ndarray) -> str:
    """ "ZXY", or where its middle turn comes near 90 degrees the order whose middle turn stays furthest from it."""
    largest = {order: float(np.abs(euler_deg(rotation, order)[:, 1]).max()) for order in ORDERS}
    return USUAL_ORDER if largest[USUAL_ORDER] < _FAR_DEG else min(ORDERS, key=lambda order: largest[order])


def least_turn(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(T, 3, 3) rotations without twist that bring unit vectors (T, 3) to others; half a turn where they are opposite.

    A turn is the product of two half turns, the second about the bisector: exact near opposite vectors too.
    """
    middle = start + end
    size = np.linalg.norm(middle, axis=1, keepdims=True)
    aside = np.zeros_like(start)
    aside[np.arange(len(start)), np.argmin(np.abs(start), axis=1)] = 1.0
    middle = np.where(size > 1e-7, middle / np.where(size > 1e-7, size, 1.0), np.cross(start, aside))
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    return _half_turn(middle) @ _half_turn(start)


def best_turn(rest: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Rotations (T, 3, 3) about the origin that bring points (C, 3) nearest to points (T, C, 3).

    Source: Kabsch 1976.
    """
    left, _, right = np.linalg.svd(np.einsum("tca,cb->tab", vectors, rest))
    sign = np.ones((len(vectors), 3))
    sign[:, 2] = np.sign(np.linalg.det(left @ right))
    return left @ (sign[:, :, None] * right)


def _half_turn(axis: np.ndarray) -> np.ndarray:
    return 2.0 * axis[:, :, None] * axis[:, None, :] - np.eye(3)


MOVES = ("Xposition", "Yposition", "Zposition")
POSE_DECIMALS = 9
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
        offsets=np.round(rest[order] / unit_m, POSE_DECIMALS),
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
