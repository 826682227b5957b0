"""One performance as a body on a floor: latents in real time, the root over its footprints, feet planted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from emulator.clean import turn
from emulator.cyclic.feet import path_from_contacts, stretches
from emulator.cyclic.legs import stand_on, wanting_m
from emulator.cyclic.pose import Poses
from emulator.cyclic.stances import FootStances, stances

if TYPE_CHECKING:
    from emulator.cyclic.model import CyclicEmulator
    from emulator.cyclic.timeline import Timeline


GRID_S, LOOK_AHEAD = 1 / 50, 5
"""The hips look so many grid steps ahead for legs that will be too short."""
SPARE_M = 0.003
SMOOTH_FRAMES = 1.5
"""The way that follows from the feet is smoothed by so many frames: hips have mass."""


@dataclass(frozen=True, eq=False)
class Track:
    """line : latents with the worker's own offset; node_s (N,) when each frame comes, rising from 0 to the duration

    place_m : (B,) where the feet come down along the way, or None where nothing is walked
    """

    model: CyclicEmulator
    line: Timeline
    node_s: np.ndarray
    bone_length_m: np.ndarray
    place_m: np.ndarray | None

    def joints_m(self, time_s: np.ndarray) -> np.ndarray:
        """(T, J, 3) metres at times (T,), held before the start and after the end."""
        time_s = np.clip(time_s, 0.0, self.node_s[-1])
        values = self._spline(time_s)
        poses = self.model.latent.inverse(values[:, :-3])
        raw = self._standing(poses, values[:, -3], values[:, -2:])
        return self._planted(time_s, raw)

    def yaw_rad(self, time_s: np.ndarray) -> np.ndarray:
        """(T,) heading, 0 at the start."""
        return np.asarray(self._spline(np.clip(time_s, 0.0, self.node_s[-1]))[:, -3])

    def contact(self, time_s: np.ndarray) -> np.ndarray:
        """(T, 2) whether the left and the right foot bear."""
        time_s = np.clip(time_s, 0.0, self.node_s[-1])
        if self._feet is None:
            at = np.clip(np.searchsorted(self.node_s, time_s, side="right") - 1, 0, len(self.node_s) - 1)
            return np.asarray(self.line.contact[at])
        return np.stack([foot.bears(time_s) for foot in self._feet], axis=1)

    @cached_property
    def leg_m(self) -> float:
        return float(self.model.channel.leg_m(self.bone_length_m))

    @cached_property
    def _poses(self) -> Poses:
        return self.model.latent.inverse(self.line.z)

    @cached_property
    def _yaw(self) -> np.ndarray:
        """(N,) heading at the nodes: the turning summed up, less what drifts over a stride."""
        from scipy.ndimage import uniform_filter1d

        step_s = np.diff(self.node_s)
        yaw = np.concatenate([[0.0], np.cumsum(self._poses.travel[:-1, 2] * step_s)])
        if not self.model.pace.steps:
            return yaw - np.linspace(0.0, yaw[-1], len(yaw))
        yaw = yaw - uniform_filter1d(yaw, min(2 * self.model.beat_frames[1], len(yaw)), mode="nearest")
        return np.asarray(yaw - yaw[0])

    @cached_property
    def _level(self) -> np.ndarray:
        """(N, 2) way of the root at the nodes: feet that bear stay, and come down where they shall."""
        from scipy.ndimage import gaussian_filter1d

        if self.model.legs is None:
            return self._travelled()
        hanging = self._standing(self._poses, self._yaw, np.zeros((len(self.node_s), 2)), height=False)
        level = path_from_contacts(hanging, self.line.contact, self.model.skeleton)
        level = gaussian_filter1d(level, SMOOTH_FRAMES, axis=0, mode="nearest")
        level = level - level[0]
        if self.place_m is None:
            return level
        return level + self._bent(level[:, None] + hanging[:, [leg[2] for leg in self.model.legs.joints], :2])

    def _bent(self, raw: np.ndarray) -> np.ndarray:
        """(N, 2) what the way lacks for its footprints raw (N, 2, 2), eased from the middle of each stance to the next.

        Along the way to the places asked for; aside, what they drift off a straight line.
        """
        from scipy.interpolate import PchipInterpolator

        rows = [
            ((on + stop - 1) / 2, self._ahead(on, stop, side, raw), raw[(on + stop - 1) // 2, side])
            for side in (0, 1)
            for on, stop in stretches(self.line.contact[:, side])
        ]
        frame, ahead = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
        here = np.array([row[2] for row in rows])
        aside = -np.polyval(np.polyfit(frame, here[:, 1], 1), frame) if len(rows) > 4 else 0.0 * frame
        at, which = np.unique(frame, return_inverse=True)
        missing = np.column_stack([ahead - here[:, 0], aside])
        bend = np.stack([np.bincount(which, missing[:, c]) / np.bincount(which) for c in (0, 1)], axis=1)
        if len(at) < 2:
            return np.asarray(bend - bend[0])
        eased = PchipInterpolator(at, bend)(np.clip(np.arange(len(raw)), at[0], at[-1]))
        return np.asarray(eased - eased[0])

    def _ahead(self, on: int, stop: int, side: int, raw: np.ndarray) -> float:
        """Where along the way (m) an ankle stands from frame ``on`` to ``stop``; raw (N, 2, 2) footprints of the way.

        At both ends the feet stand to the root as the postures there say, so that the root goes the whole way exactly.
        """
        assert self.place_m is not None
        if on == 0:
            return float(raw[0, side, 0])
        ends = raw[0, :, 0].mean(), self._ankle_end.mean()
        beats = self.line.beat_frame
        along = self.place_m[int(np.abs(beats - on).argmin())] if on <= beats[-1] + 1 else self.place_m[-1]
        if stop == len(raw) and self.model.stops:
            return float(along + self._ankle_end[side])
        share = along / max(float(self.place_m[-1]), 1e-9)
        return float(along + ends[0] + share * (ends[1] - ends[0]))

    @cached_property
    def _ankle_end(self) -> np.ndarray:
        """(2,) how far before the root the ankles are in the last frame."""
        assert self.model.legs is not None
        last = Poses(self._poses.directions[-1:], self._poses.travel[-1:], self._poses.height[-1:])
        joints = self._standing(last, self._yaw[-1:], np.zeros((1, 2)))
        return np.asarray(joints[0, [leg[2] for leg in self.model.legs.joints], 0])

    def _travelled(self) -> np.ndarray:
        """Of a body without legs: the latents' own travel."""
        step = turn(np.pad(self._poses.travel[:-1, :2], ((0, 0), (0, 1))), self._yaw[:-1])[:, :2]
        step = step * np.diff(self.node_s)[:, None] * self.leg_m
        return np.concatenate([np.zeros((1, 2)), np.cumsum(step, axis=0)])

    @cached_property
    def _spline(self) -> Any:
        """Latents, heading and way over real time, with continuous acceleration."""
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.node_s, np.column_stack([self.line.z, self._yaw, self._level]))

    def _standing(self, poses: Poses, yaw: np.ndarray, level: np.ndarray, height: bool = True) -> np.ndarray:
        """Joints (T, J, 3) of poses at these headings and places."""
        tall = poses.height * self.leg_m if height else np.zeros(len(yaw))
        root = np.column_stack([level, tall])
        return self.model.skeleton.positions(turn(poses.directions, yaw[:, None]), self.bone_length_m, root)

    @cached_property
    def _bone_m(self) -> dict[int, float]:
        return dict(zip(self.model.skeleton.bones, self.bone_length_m.tolist()))

    @cached_property
    def _feet(self) -> tuple[FootStances, FootStances] | None:
        if self.model.legs is None:
            return None
        raw = self._standing(self._poses, self._yaw, self._level)
        left, right = (self._stances(side, raw) for side in (0, 1))
        return left, right

    def _stances(self, side: int, raw: np.ndarray) -> FootStances:
        assert self.model.legs is not None
        hip, knee, ankle, toe = self.model.legs.joints[side]
        foot = raw[:, toe] - raw[:, ankle]
        foot_m = float(np.linalg.norm(foot[0]))
        foot = foot / np.linalg.norm(foot, axis=-1, keepdims=True)
        runs = stretches(self.line.contact[:, side])
        place = np.array([raw[(on + stop - 1) // 2, ankle] for on, stop in runs])
        place[:, 2] = self.model.ankle_legs * self.leg_m
        if self.place_m is not None:
            flat = np.stack([raw[:, leg[2], :2] for leg in self.model.legs.joints], axis=1)
            place[:, 0] = [self._ahead(on, stop, side, flat) for on, stop in runs]
        least, leg_m = self.model.toe_legs * self.leg_m, self._bone_m[knee] + self._bone_m[ankle]
        return stances(self.node_s, runs, raw[:, ankle], foot, place, foot_m, least, raw[:, hip], leg_m)

    def _planted(self, time_s: np.ndarray, raw: np.ndarray) -> np.ndarray:
        if self.model.legs is None or self._feet is None:
            return raw
        lower = raw.copy()
        lower[..., 2] -= np.interp(time_s, *self._lowered)[:, None]
        ankles, feet = self._targets(time_s, raw)
        return stand_on(lower, ankles, feet, self.model.legs, self._bone_m)

    def _targets(self, time_s: np.ndarray, raw: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(T, 2, 3) where the ankles belong, and unit vectors of the feet, for raw joints (T, J, 3) at these times."""
        assert self.model.legs is not None and self._feet is not None
        found = []
        for own, (hip, _, ankle, toe) in zip(self._feet, self.model.legs.joints):
            foot = raw[:, toe] - raw[:, ankle]
            foot = foot / np.linalg.norm(foot, axis=-1, keepdims=True)
            found.append(own.ankle(time_s, raw[:, ankle], foot, raw[:, hip]))
        left, right = found
        return np.stack([left[0], right[0]], axis=1), np.stack([left[1], right[1]], axis=1)

    @cached_property
    def _lowered(self) -> tuple[np.ndarray, np.ndarray]:
        """Times and metres by which the hips come down ahead of need and without haste: no leg has to stretch."""
        from scipy.ndimage import gaussian_filter1d, maximum_filter1d

        assert self.model.legs is not None
        time_s = np.arange(0.0, self.node_s[-1] + 0.5 * GRID_S, GRID_S)
        values = self._spline(np.minimum(time_s, self.node_s[-1]))
        raw = self._standing(self.model.latent.inverse(values[:, :-3]), values[:, -3], values[:, -2:])
        ankles, _ = self._targets(time_s, raw)
        need = np.maximum(wanting_m(raw, ankles, self.model.legs, self._bone_m) + SPARE_M, 0.0)
        need = maximum_filter1d(need, 2 * LOOK_AHEAD + 1, mode="nearest")
        return time_s, gaussian_filter1d(need, 0.7 * LOOK_AHEAD, mode="nearest")
