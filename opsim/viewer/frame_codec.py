"""Codec ``frames``: performances as postures many times a second, whoever draws them.

A posture's directions are a mean and a few components of all that is packed. These numbers, the way of the root and
its heading are cubic splines over time; their control points are rounded to steps too small to see, and what is kept
are second differences. What the frames miss is amended.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from opsim.viewer.frame_corrections import FAR_M, amends, joined
from opsim.viewer.frame_corrections import STEP as AMEND_STEP
from opsim.viewer.scene import Drawn
from opsim.viewer.skeletons import Columns, hung, path_of, tree_of, turned, vectors_of

RATES_HZ = (12.5, 20.0, 25.0, 33.0, 50.0)
GOOD_M, SHARE = 7e-4, 0.98
"""The fewest frames and components by which so many of all joints lie within so much of where they belong."""
QUANTUM, ROOT_STEP = 1e-3, 2e-4
"""Of components (no unit), and of metres and radians: some 0.2 mm at a hand."""
TRIED, TRIED_FRAMES, AT_ONCE = 24, 20_000, 16
LARGEST = 32_767


@dataclass(frozen=True, eq=False)
class Frames:
    """n performances in frames. first (n + 1,); directions (F, 3B) without heading; path (F, 4) root and heading

    bone_m (n, B); duration_s (n,)
    """

    first: np.ndarray
    directions: np.ndarray
    path: np.ndarray
    bone_m: np.ndarray
    duration_s: np.ndarray


def pack_frames(drawn: Drawn, skeleton: int, columns: Columns, prefix: str) -> dict[str, Any]:
    """The model's entry of the page's description; its columns are added under names that begin with ``prefix``."""
    rate_hz, n_components, worst_m = chosen(drawn)
    frames = frames_of(drawn, rate_hz)
    basis = basis_of(frames.directions, n_components)
    channels = np.concatenate([(frames.directions - basis[0]) @ basis[1:].T, frames.path], axis=1)
    channels = control_points(channels, frames.first)
    values, scale = second_differences(channels, frames.first, n_components)
    roles = {
        "basis": ("f4", basis),
        "scale": ("f4", scale),
        "first": ("u4", frames.first),
        "values": ("u2", folded(values)),
        "bone_m": ("f4", frames.bone_m),
        "duration_s": ("f4", frames.duration_s),
    }
    if worst_m > FAR_M:
        roles |= amended(drawn, frames, shown_channels(values, scale, frames.first), basis, rate_hz)
    return {
        "codec": "frames",
        "name": drawn.name,
        "skeleton": skeleton,
        "rate_hz": rate_hz,
        "n": len(drawn),
        "sizes": {"directions": n_components},
        "columns": {role: columns.add(f"{prefix}{role}", *column) for role, column in roles.items()},
    }


def frames_of(drawn: Drawn, rate_hz: float) -> Frames:
    """All performances of a model, ``rate_hz`` frames a second from their start to past their end."""
    parents = tree_of(drawn.skeleton)[1]
    durations_s = np.concatenate([np.asarray(block.duration_s, dtype=float) for block in drawn.blocks])
    first = np.cumsum([0, *(np.ceil(durations_s * rate_hz - 1e-9).astype(int) + 1)])
    n_bones = len(parents) - 1
    directions, path = np.empty((first[-1], 3 * n_bones)), np.empty((first[-1], 4))
    bone_m = np.empty((durations_s.size, n_bones))
    begin = 0
    for some in _pieces(drawn):
        n_frames = np.diff(first[begin : begin + len(some.duration_s) + 1])
        times_s = np.broadcast_to(np.arange(n_frames.max()) / rate_hz, (n_frames.size, n_frames.max()))
        local, lengths_m, ways = postures(some, times_s, parents)
        for row, n in enumerate(n_frames.tolist()):
            here = slice(first[begin + row], first[begin + row] + n)
            directions[here], path[here] = local[row, :n].reshape(n, -1), ways[row, :n]
        bone_m[begin : begin + n_frames.size] = lengths_m[:, 0]
        begin += n_frames.size
    return Frames(first, directions, path, bone_m, durations_s)


def postures(some: Any, times_s: np.ndarray, parents: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Directions (n, T, B, 3) without heading, lengths (n, T, B), root and heading (n, T, 4) at times (n, T)."""
    times_s = np.minimum(times_s, np.asarray(some.duration_s)[:, None])
    joints = np.asarray(some.positions_m(times_s=times_s), dtype=float)
    yaw = path_of(some, times_s)[..., 3]
    world, length_m = vectors_of(joints, parents)
    root = joints[..., parents.index(-1), :]
    return turned(world, -yaw[..., None]), length_m, np.concatenate([root, yaw[..., None]], axis=-1)


def amended(
    drawn: Drawn, frames: Frames, channels: np.ndarray, basis: np.ndarray, rate_hz: float
) -> dict[str, tuple[str, np.ndarray]]:
    """Columns of what brings frames, as the page shows them from channels (F, d + 4), to where they belong."""
    parents = tree_of(drawn.skeleton)[1]
    found = []
    for row in range(len(drawn)):
        block, place = drawn.one(row)
        here = slice(frames.first[row], frames.first[row + 1])
        truth = _Truth(block[np.array([place])], parents, channels[here], basis, frames.bone_m[row], rate_hz)
        found.append(amends(truth.far, truth.residual, truth.bone_m, float(frames.duration_s[row]), rate_hz))
    knots = joined(found)
    return {
        "amend_first": ("u4", np.cumsum([0, *map(len, found)])),
        "amend_bone": ("u1", knots.bone),
        "amend_at_s": ("f4", knots.at_s),
        "amend_by": ("u2", folded(knots.by.T)),
        "amend_step": ("f4", np.array([AMEND_STEP])),
    }


@dataclass(frozen=True, eq=False)
class _Truth:
    """One performance beside its frames, as the page has them."""

    one: Any
    parents: tuple[int, ...]
    channels: np.ndarray
    basis: np.ndarray
    bone_m: np.ndarray
    rate_hz: float

    def residual(self, at_s: np.ndarray) -> np.ndarray:
        """(S, B, 3) unit directions as they are, less those shown."""
        return postures(self.one, at_s[None], self.parents)[0][0] - self._shown(at_s)[0]

    def far(self, at_s: np.ndarray) -> np.ndarray:
        """(S,) how far the worst joint is from where it belongs."""
        own, _, path = (part[0] for part in postures(self.one, at_s[None], self.parents))
        shown, way = self._shown(at_s)
        meant, found = (hung(d, self.bone_m, p[:, :3], self.parents) for d, p in ((own, path), (shown, way)))
        return np.asarray(np.linalg.norm(meant - found, axis=-1).max(axis=-1))

    def _shown(self, at_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unit directions (S, B, 3), and path (S, 4)."""
        now = between(self.channels, at_s * self.rate_hz)
        directions = (self.basis[0] + now[:, :-4] @ self.basis[1:]).reshape(at_s.size, -1, 3)
        return directions / np.linalg.norm(directions, axis=-1, keepdims=True), now[:, -4:]


def chosen(drawn: Drawn) -> tuple[float, int, float]:
    """(frames a second, components) that are enough: by some performances of the model, against themselves.

    And how far the worst joint is then from where it belongs, in metres.
    """
    parents = tree_of(drawn.skeleton)[1]
    some = [block[np.array([row])] for block, row in map(drawn.one, _spread(len(drawn), TRIED))]
    few = Drawn(drawn.name, drawn.skeleton, some, tuple(range(len(some) + 1)))
    rng = np.random.default_rng(0)
    asked = [rng.uniform(0.0, 1.0, 32) * np.asarray(block.duration_s)[:, None] for block in some]
    truth = [postures(block, at_s, parents) for block, at_s in zip(some, asked)]
    for rate_hz in RATES_HZ:
        frames = frames_of(few, rate_hz)
        errors_m = _errors_m(frames, frames.directions, rate_hz, asked, truth, parents)
        if np.quantile(errors_m, SHARE) <= GOOD_M:
            break
    for n_components in (8, 12, 16, 20, 24, 28, 32, 40, 50, frames.directions.shape[1]):
        n_components = min(n_components, frames.directions.shape[1])
        basis = basis_of(frames.directions, n_components)
        about = basis[0] + (frames.directions - basis[0]) @ basis[1:].T @ basis[1:]
        errors_m = _errors_m(frames, about, rate_hz, asked, truth, parents)
        if np.quantile(errors_m, SHARE) <= 1.2 * GOOD_M:
            break
    return rate_hz, n_components, float(errors_m.max())


def _spread(n: int, most: int) -> list[int]:
    """At most so many of n rows, evenly."""
    return np.unique(np.linspace(0, n - 1, min(n, most)).astype(int)).tolist()


def _errors_m(
    frames: Frames,
    directions: np.ndarray,
    rate_hz: float,
    asked: list[np.ndarray],
    truth: list[tuple[np.ndarray, np.ndarray, np.ndarray]],
    parents: tuple[int, ...],
) -> np.ndarray:
    """How far every joint is from where it belongs, at all times asked for."""
    found, row = [], 0
    directions, roots = (control_points(part, frames.first) for part in (directions, frames.path[:, :3]))
    for times_s, (local, _, path) in zip(asked, truth):
        for at_s, own, way in zip(times_s, local, path):
            here = slice(frames.first[row], frames.first[row + 1])
            unit = between(directions[here], at_s * rate_hz).reshape(at_s.size, -1, 3)
            unit /= np.linalg.norm(unit, axis=-1, keepdims=True)
            shown = hung(unit, frames.bone_m[row], between(roots[here], at_s * rate_hz), parents)
            meant = hung(own, frames.bone_m[row], way[:, :3], parents)
            found.append(np.linalg.norm(shown - meant, axis=-1).ravel())
            row += 1
    return np.concatenate(found)


def between(control: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values (S, C) at places (S,) of a uniform cubic spline with control points (F, C), held before and after.

    Beyond the first and the last point it goes on straight.
    """
    last = len(control) - 1
    if last == 0:
        return np.repeat(control, len(place), axis=0)
    place = np.clip(place, 0.0, last)
    cell = np.minimum(place.astype(int), last - 1)
    u = (place - cell)[:, None]
    beyond = np.concatenate([2 * control[:1] - control[1:2], control, 2 * control[-1:] - control[-2:-1]])
    a, b, c, d = (beyond[cell + k] for k in range(4))
    v = 1 - u
    return np.asarray((v**3 * a + (4 - 3 * u * u * (1 + v)) * b + (4 - 3 * v * v * (1 + u)) * c + u**3 * d) / 6)


def control_points(values: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Control points (F, C) of the splines through values (F, C), performance by performance; ``between`` undoes it."""
    from scipy.linalg import solveh_banded

    control = np.array(values, dtype=float)
    for begin, end in pairwise(first.tolist()):
        if end - begin > 2:  # the first and the last point lie on the spline
            inner = 6 * control[begin + 1 : end - 1]
            inner[0] -= control[begin]
            inner[-1] -= control[end - 1]
            bands = np.array([np.ones(len(inner)), np.full(len(inner), 4.0)])
            control[begin + 1 : end - 1] = solveh_banded(bands, inner) if len(inner) > 1 else inner / 4
    return control


def basis_of(directions: np.ndarray, n_components: int) -> np.ndarray:
    """(d + 1, 3B) the mean of directions (F, 3B) and their first components, as they are packed (float32)."""
    some = directions[:: max(1, len(directions) // TRIED_FRAMES)]
    mean = some.mean(axis=0)
    centred = some - mean
    vectors = np.linalg.eigh(centred.T @ centred)[1]
    basis = vectors[:, ::-1][:, :n_components].T
    largest = np.take_along_axis(basis, np.abs(basis).argmax(axis=1)[:, None], axis=1)
    packed = np.concatenate([mean[None], basis * np.where(largest < 0, -1.0, 1.0)])
    return packed.astype(np.float32).astype(float)


def second_differences(channels: np.ndarray, first: np.ndarray, n_components: int) -> tuple[np.ndarray, np.ndarray]:
    """(values, scale): second differences of channels (F, C) in whole steps, per performance channel by channel.

    A channel whose differences would be too large gets longer steps.
    """
    scale = np.r_[np.full(n_components, QUANTUM), np.full(channels.shape[1] - n_components, ROOT_STEP)]
    rounded = _differences(channels, first, scale)
    most = np.abs(rounded).max(axis=0, initial=0)
    if np.any(most > LARGEST):
        scale = scale * np.where(most > LARGEST, 1.01 * most / LARGEST, 1.0)
        rounded = _differences(channels, first, scale)
    parts = [rounded[begin:end].T.ravel() for begin, end in pairwise(first.tolist())]
    return np.concatenate([np.zeros(0, np.int64), *parts]), scale.astype(np.float32).astype(float)


def folded(values: np.ndarray) -> np.ndarray:
    """Whole numbers 0, -1, 1, -2, 2 ... as 0, 1, 2, 3, 4 ...: the high bytes of small ones are all alike."""
    return np.where(values < 0, -2 * values - 1, 2 * values)


def shown_channels(values: np.ndarray, scale: np.ndarray, first: np.ndarray) -> np.ndarray:
    """(F, C) channels again, of ``second_differences``."""
    parts = [
        np.cumsum(np.cumsum(values[scale.size * begin : scale.size * end].reshape(scale.size, -1), axis=1), axis=1).T
        for begin, end in pairwise(first.tolist())
    ]
    return np.concatenate([np.zeros((0, scale.size)), *parts]) * scale


def _differences(channels: np.ndarray, first: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """(F, C) second differences of whole steps, from 0 at the beginning of each performance."""
    steps = np.rint(channels / scale).astype(np.int64)
    for _ in range(2):
        before = np.zeros_like(steps)
        before[1:] = steps[:-1]
        before[first[:-1]] = 0
        steps = steps - before
    return steps


def _pieces(drawn: Drawn) -> Iterator[Any]:
    """A few performances at a time."""
    for block in drawn.blocks:
        n = len(block.duration_s)
        if n <= AT_ONCE:
            yield block
            continue
        for start in range(0, n, AT_ONCE):
            yield block[np.arange(start, min(start + AT_ONCE, n))]
