"""Performances drawn from an emulator: times at once, postures when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np

from emulator.geometry import sphere
from emulator.model import decoding
from emulator.model.feet import bend, stood
from emulator.model.joint_law import JointLaw
from emulator.people.bone_turns import LazyArray
from emulator.performances import Floats, Performances

AT_ONCE = 128
"""Performances whose paths are made at a time."""
STEPS = 10
"""Draws are drawn in by whole tenths."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """What n draws say of where bodies stand, before they do; never written to.

    posture, root : (n, P), (n, R) coefficients; flat : (n, T + 2, C) control points of the flat postures
    length_m : (n, B) bones; time_s : (n, T) when the points of the clock come; near : (n,) recordings to stand like
    """

    posture: np.ndarray
    root: np.ndarray
    flat: np.ndarray
    length_m: np.ndarray
    time_s: np.ndarray
    near: np.ndarray


@dataclass(frozen=True, eq=False)
class Ground:
    """Where and how n bodies stand.

    control : (n, T + 2, 4) control points of the path of root and heading; bends : (n, 2, T, 6) what the legs bend
    posture : (n, P) posture coefficients; upper : (n, P) those of all bones but the legs'
    flat : (n, T + 2, C) control points of the flat postures
    kept : (n,) what share of their deviation from the mean movement is kept
    fastest_m_per_s : (n,) the greatest speed of a joint between frames of 1/30 s
    """

    control: np.ndarray
    bends: np.ndarray
    posture: np.ndarray
    upper: np.ndarray
    flat: np.ndarray
    kept: np.ndarray
    fastest_m_per_s: np.ndarray


@dataclass(frozen=True, eq=False)
class MotionPerformances(Performances):
    """n performances of a task.

    duration_s (n,) seconds; scores (n, K) joint coordinates; body_scale (n,) factor on every bone; lazy_turns: see
    ``turns``.
    ``performances[3]`` and slices are performances again, decoded to the same postures as in the block (to 1e-10).
    """

    model: JointLaw
    scores: np.ndarray
    duration_s: np.ndarray
    body_scale: np.ndarray
    lazy_turns: np.ndarray | LazyArray

    @property
    def turns(self) -> np.ndarray:
        """(n, B, 3) rotation vectors by which bones are turned throughout, radians; (n, 0, 3) of known people."""
        return self.lazy_turns.made if isinstance(self.lazy_turns, LazyArray) else self.lazy_turns

    @cached_property
    def mark_s(self) -> np.ndarray:
        """(n, E) seconds at which the marks fall, increasing, inside the duration.

        NOTE: made when asked for; a simulation spends durations, and marks are half the cost of a draw.
        """
        return self.duration_s[:, None] * self.model.mark_share(self.scores)

    @property
    def bone_length_m(self) -> np.ndarray:
        """(n, B) metres."""
        return self.model.bone_length_m(self.scores) * self.body_scale[:, None]

    def directions(
        self, times_s: np.ndarray | None = None, n_times: int = 101, dtype: Floats = np.float64
    ) -> np.ndarray:
        """(n, T, B, 3) unit directions without heading, at ``n_times`` even points of own time or at ``times_s``.

        times_s : (T,) or (n, T) seconds from the start of each performance; before its start and after its end the
                  first and last posture are held.
        dtype   : of the answer and of its computation; float32 takes half the time and memory, and agrees to 1e-6
        """
        return self._directions(self._place(times_s, n_times), dtype)

    def aligned_directions(self) -> np.ndarray:
        """(n, T, B, 3) postures on the common clock, before bodies stand."""
        return turned(self.model.aligned_directions(self.scores), self.turns)

    def path(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 4) ``root_m`` and the heading in radians; times as ``directions``."""
        place = self._place(times_s, n_times)
        path = np.empty((*place.shape, 4))
        for rows, some in self._blocks():
            path[rows] = decoding.along(some._ground.control, place[rows])
        return path

    def positions_m(
        self, times_s: np.ndarray | None = None, n_times: int = 101, dtype: Floats = np.float64
    ) -> np.ndarray:
        """(n, T, J, 3) joints in metres, z up, floor at 0, in the frame of ``root_m``; times, dtype as ``directions``.

        float32 only saves memory: the path of the root needs float64.
        """
        from emulator.kernels.bodies import stand_all

        place = self._place(times_s, n_times)
        positions = np.empty((*place.shape, self.skeleton.n_joints, 3), dtype)
        for rows, some in self._blocks():
            lengths = some._drawn.length_m
            flat = some._directions(place[rows]).reshape(*place[rows].shape, -1)
            path = decoding.along(some._ground.control, place[rows])
            stand_all(flat, lengths, self.skeleton.chain, path, positions[rows])
        return positions

    @property
    def damped(self) -> np.ndarray:
        """(n,) how much a body was drawn in towards the mean movement, 0 to 1, since a joint was too fast for a body.

        Beyond ``most_m_per_s`` of the model, see ``MotionEmulator``; or since a joint missed its target, see
        ``MotionEmulator.given``. Times and marks stay as they were drawn.
        """
        return np.concatenate([np.zeros(0), *(1.0 - some._ground.kept for _, some in self._blocks())])

    def _directions(self, place: np.ndarray, dtype: Floats = np.float64) -> np.ndarray:
        model = self.model
        if model.footing is None:
            directions = model.decoder.directions(model.scale.raw(self.scores, "posture"), place, np.dtype(dtype))
            return turned(directions, self.turns)
        if len(self) > AT_ONCE and "_ground" not in self.__dict__:
            directions = np.empty((*place.shape, self.skeleton.n_bones, 3), dtype)
            for rows, some in self._blocks():
                directions[rows] = some._directions(place[rows], dtype)
            return directions
        directions = self._decoded(self._ground, place, dtype)
        if model.legs is not None:
            bend(directions, self._drawn.length_m, model.legs, place, self._ground.bends)
        return directions

    def _decoded(self, ground: Ground, place: np.ndarray, dtype: Floats) -> np.ndarray:
        """Directions at places (n, S) of bodies on the ground before legs bend; here upper bones are as all others."""
        return turned(self.model.decoder.between(ground.flat, ground.posture, place, np.dtype(dtype)), self.turns)

    @cached_property
    def _drawn(self) -> Drawn:
        model = self.model
        posture, root = (model.scale.raw(self.scores, name) for name in ("posture", "root"))
        near = self._stands_as(posture, root)
        time_s = model.warps(self.scores) * model.moving_s(self.scores)[:, None]
        return Drawn(posture, root, model.decoder.control(posture), self.bone_length_m, time_s, near)

    def _some(self, rows: np.ndarray) -> Self:
        """``self[rows]``, for which nothing is made again."""
        some = self[rows]
        some.__dict__["_drawn"] = rows_of(self._drawn, rows)
        return some

    @cached_property
    def _ground(self) -> Ground:
        """Where and how the bodies stand, drawn in where they are beyond what is allowed.

        By as many tenths as the last two excesses foretell, until there is none; else as where it was least.
        """
        ground = self._grounded(np.ones(len(self)))
        excess = self._excess(ground)
        rows = np.flatnonzero(excess > 0.0)
        last, kept, before = np.ones(rows.size), np.full(rows.size, 1.0 - 1.0 / STEPS), excess[rows]
        while rows.size:
            some = self._some(rows)
            again = some._grounded(kept)
            now = some._excess(again)
            better = now < excess[rows]
            excess[rows[better]] = now[better]
            put(ground, rows[better], rows_of(again, better))
            steps = np.ceil(STEPS * now * (last - kept) / np.maximum(before - now, 1e-9) - 1e-6)
            following = np.where(before > now, kept - np.maximum(steps, 1.0) / STEPS, 0.0)
            on = (now > 0.0) & (kept > 0.0)
            rows, last, kept, before = rows[on], kept[on], np.maximum(following, 0.0)[on], now[on]
        return ground

    def _excess(self, ground: Ground) -> np.ndarray:
        """(n,) by how many m/s the fastest joint of bodies that stand like this is above the bound."""
        return np.asarray(ground.fastest_m_per_s - self.model.most_m_per_s * self.body_scale)

    def _grounded(self, kept: np.ndarray) -> Ground:
        """On the ground, with the shares ``kept`` (n,) of how postures and paths deviate from the mean movement."""
        return self._stood(kept)

    def _stood(self, kept: np.ndarray, moved: tuple[np.ndarray, ...] | None = None) -> Ground:
        """The same with coefficients of posture (n, P) and root (n, R) ``moved``."""
        model, n, own = self.model, len(self), self._drawn
        posture, root, flat = own.posture, own.root, own.flat
        if np.any(kept < 1.0):
            *centre, control = self._centre
            posture, root = (c + kept[:, None] * (raw - c) for c, raw in zip(centre, (posture, root)))
            flat = control + kept[:, None, None] * (flat - control)
        if moved is not None:
            posture, root = posture + moved[0], root + moved[1]
            flat = model.decoder.control(posture)
        clock = np.broadcast_to(np.arange(float(model.n_times)), (n, model.n_times))
        aligned = turned(model.decoder.between(flat, posture, clock), self.turns)
        channel = model.root.inverse(root).reshape(n, model.n_times, 4)
        lowest_m = 0.0 if model.footing is None else -np.inf  # feet keep to floors of their own, smoothly
        root_m, yaw = model.channel.inverse(channel, aligned, own.length_m, lowest_m)
        path, bends = np.concatenate([root_m, yaw[..., None]], axis=-1), np.zeros((n, 2, 0, 6))
        fastest = np.zeros(n)
        if model.footing is not None:
            stance = model.footing.stance(own.near, model.channel.leg_m(own.length_m))
            path, bends, fastest = stood(self.skeleton, model.legs, aligned, own.length_m, path, own.time_s, stance)
            path[..., :2] -= path[:, :1, :2]
        made = decoding.control_points(path), bends, posture.copy(), posture.copy(), flat.copy(), kept.copy(), fastest
        return Ground(*made)

    @cached_property
    def _centre(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What bodies are drawn in towards: coefficients of posture (P,) and root (R,), control points (T + 2, C)."""
        model = self.model
        return model.scale.raw(model.middle, "posture"), model.scale.raw(model.middle, "root"), model.middle_control

    def _stands_as(self, posture: np.ndarray, root: np.ndarray) -> np.ndarray:
        """(n,) the recordings as which bodies stand that have coefficients of posture (n, P) and of root (n, R)."""
        footing = self.model.footing
        return np.zeros(len(self), int) if footing is None else footing.nearest(posture, self.model.whitening)

    def _blocks(self) -> Iterator[tuple[slice, MotionPerformances]]:
        """A few performances at a time: what is computed on the way is several times larger than the answer.

        One block is this one itself, so that it stands on its feet once.
        """
        if len(self) <= AT_ONCE or "_ground" in self.__dict__:
            return iter([(slice(None), self)])
        return (
            (slice(start, start + AT_ONCE), self[start : start + AT_ONCE]) for start in range(0, len(self), AT_ONCE)
        )

    def _place(self, times_s: np.ndarray | None, n_times: int) -> np.ndarray:
        """(n, T) places on the common grid, in cells, of the times asked for."""
        own = np.linspace(0, 1, n_times) if times_s is None else np.asarray(times_s) / self.duration_s[:, None]
        own = np.broadcast_to(own, (len(self), np.shape(own)[-1]))
        return decoding.places(self.model.warps(self.scores), self.model.moving_share(self.scores, own))


def turned(directions: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """Directions (n, S, B, 3), turned in place about rotation vectors (n, B, 3); as they are of (n, 0, 3)."""
    from emulator.kernels.sphere import turn_bones

    if turns.shape[1]:
        turn_bones(directions, sphere.matrices(turns))
    return directions


def put(record: Any, rows: np.ndarray, some: Any) -> None:
    """Some rows of a record of arrays become those of another, in place."""
    for name, values in vars(some).items():
        getattr(record, name)[rows] = values


def rows_of(record: Any, rows: np.ndarray) -> Any:
    """Some rows of a record of arrays."""
    return type(record)(**{name: values[rows] for name, values in vars(record).items()})
