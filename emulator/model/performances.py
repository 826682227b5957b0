"""Performances drawn from an emulator: times at once, postures when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from emulator.model import decoding
from emulator.model.feet import bend, stood
from emulator.model.joint_law import JointLaw
from emulator.performances import Floats, Performances

AT_ONCE = 16
"""Performances whose paths are made at a time."""
KEPT = (0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0)


@dataclass(frozen=True, eq=False)
class Ground:
    """Where and how n bodies stand.

    control : (n, T + 2, 4) control points of the path of root and heading; bends : (n, 2, T, 6) what the legs bend
    posture : (n, P) posture coefficients; upper : (n, P) those of all bones but the legs'
    kept : (n,) what share of their deviation from the mean movement is kept
    fastest_m_per_s : (n,) the greatest speed of a joint between frames of 1/30 s
    """

    control: np.ndarray
    bends: np.ndarray
    posture: np.ndarray
    upper: np.ndarray
    kept: np.ndarray
    fastest_m_per_s: np.ndarray


@dataclass(frozen=True, eq=False)
class MotionPerformances(Performances):
    """n performances of a task.

    duration_s (n,) seconds; scores (n, K) joint coordinates; body_scale (n,) factor on every bone.
    ``performances[3]`` and slices are performances again, decoded to the same postures as in the block (to 1e-10).
    """

    model: JointLaw
    scores: np.ndarray
    duration_s: np.ndarray
    body_scale: np.ndarray

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
            lengths = some.bone_length_m
            flat = some._directions(place[rows]).reshape(*place[rows].shape, -1)
            path = decoding.along(some._ground.control, place[rows])
            stand_all(flat, lengths, self.skeleton.chain, path, positions[rows])
        return positions

    @property
    def damped(self) -> np.ndarray:
        """(n,) how much a body was drawn in towards the mean movement, 0 to 1, since a joint was too fast for a body.

        Beyond ``most_m_per_s`` of the model, see ``MotionEmulator``; times and marks stay as they were drawn.
        """
        return np.concatenate([np.zeros(0), *(1.0 - some._ground.kept for _, some in self._blocks())])

    def _directions(self, place: np.ndarray, dtype: Floats = np.float64) -> np.ndarray:
        model = self.model
        if model.footing is None:
            return model.decoder.directions(model.scale.raw(self.scores, "posture"), place, np.dtype(dtype))
        directions = np.empty((*place.shape, self.skeleton.n_bones, 3), dtype)
        for rows, some in self._blocks():
            directions[rows] = some._decoded(some._ground.posture, some._ground.upper, place[rows], dtype)
            if model.legs is not None:
                bend(directions[rows], some.bone_length_m, model.legs, place[rows], some._ground.bends)
        return directions

    def _decoded(self, posture: np.ndarray, upper: np.ndarray, place: np.ndarray, dtype: Floats) -> np.ndarray:
        """Directions of coefficients (n, P) at places (n, S) before legs bend; here upper bones are as all others."""
        return self.model.decoder.directions(posture, place, np.dtype(dtype))

    @cached_property
    def _ground(self) -> Ground:
        """Where and how the bodies stand, drawn in where a joint is too fast."""
        most_m_per_s = self.model.most_m_per_s * self.body_scale
        ground = self._grounded(np.ones(len(self)))
        too_fast = np.flatnonzero(ground.fastest_m_per_s > most_m_per_s)
        for share in KEPT:
            if too_fast.size == 0:
                break
            again = self[too_fast]._grounded(np.full(too_fast.size, share))
            for name, values in vars(again).items():
                getattr(ground, name)[too_fast] = values
            too_fast = too_fast[again.fastest_m_per_s > most_m_per_s[too_fast]]
        return ground

    def _grounded(self, kept: np.ndarray) -> Ground:
        """On the ground, with the shares ``kept`` (n,) of how postures and paths deviate from the mean movement."""
        return self._stood(kept)

    def _stood(self, kept: np.ndarray, moved: tuple[np.ndarray, ...] | None = None) -> Ground:
        """The same with coefficients of posture (n, P) and root (n, R) ``moved``."""
        model, n, lengths = self.model, len(self), self.bone_length_m
        posture, channel = (model.scale.raw(self.scores, name) for name in ("posture", "root"))
        near = self._stands_as(posture, channel)
        centre = [model.scale.raw(model.middle, name) for name in ("posture", "root")]
        posture, channel = (c + kept[:, None] * (raw - c) for c, raw in zip(centre, (posture, channel)))
        if moved is not None:
            posture, channel = posture + moved[0], channel + moved[1]
        clock = np.broadcast_to(np.arange(float(model.n_times)), (n, model.n_times))
        aligned = model.decoder.directions(posture, clock)
        flat = model.root.inverse(channel).reshape(n, model.n_times, 4)
        lowest_m = 0.0 if model.footing is None else -np.inf  # feet keep to floors of their own, smoothly
        root, yaw = model.channel.inverse(flat, aligned, lengths, lowest_m)
        path, bends = np.concatenate([root, yaw[..., None]], axis=-1), np.zeros((n, 2, 0, 6))
        fastest = np.zeros(n)
        if model.footing is not None:
            leg_m = model.channel.leg_m(lengths)
            stance = model.footing.stance(near, leg_m)
            time_s = model.warps(self.scores) * model.moving_s(self.scores)[:, None]
            path, bends, fastest = stood(self.skeleton, model.legs, aligned, lengths, path, time_s, stance)
            path[..., :2] -= path[:, :1, :2]
        return Ground(decoding.control_points(path), bends, posture, posture.copy(), kept.copy(), fastest)

    def _stands_as(self, posture: np.ndarray, channel: np.ndarray) -> np.ndarray:
        """(n,) the recordings as which bodies stand that have coefficients of posture (n, P) and of root (n, R)."""
        return np.zeros(0, int) if self.model.footing is None else self.model.footing.nearest(posture)

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
