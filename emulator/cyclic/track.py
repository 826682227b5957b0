"""When and where each foot bears in one performance, at any moment: planted stances with swings between.

A planted foot does not twist. While it points up from the floor it turns about its ankle, once it points further down
than it stands about its toe; the point about which it turns does not move. Between two stances it flies as the posture
says, plus what is missing at both ends, eased. Where a leg is too short for a foot behind, the heel rises further;
where it is too short for a foot in flight, that comes nearer.

One performance as a body on a floor: latents in real time, the root over its footprints, feet planted.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from emulator.cyclic.contacts import path_from_contacts, stand_on, wanting_m
from emulator.cyclic.latent import TRAVEL_WEIGHT, unflattened
from emulator.cyclic.law import CyclicLaw
from emulator.cyclic.timeline import Timeline
from emulator.motion import stretches, turn


@dataclass(frozen=True, eq=False)
class FootStances:
    """The S stances of one foot, in order. Times in seconds, places in metres, angles in radians.

    on_s, rise_s, off_s : (S,) the foot comes down, its heel rises for good, it leaves the floor
    ankle_m   : (S, 3) where the ankle stands; way_rad : (S,) where the foot points to, seen from above
    flat      : height of the toe below the ankle of a standing foot, as a share of its length foot_m (a negative sine)
    toe_least_m : no toe is lower; leg_m : length of thigh and shank
    missing, missing_per_s : (S, 2, 5) planted ankle, angle and pitch of the foot less the posture's, coming and leaving
    """

    on_s: np.ndarray
    rise_s: np.ndarray
    off_s: np.ndarray
    ankle_m: np.ndarray
    way_rad: np.ndarray
    flat: float
    foot_m: float
    toe_least_m: float
    leg_m: float
    missing: np.ndarray
    missing_per_s: np.ndarray

    def bears(self, time_s: np.ndarray) -> np.ndarray:
        """(T,) whether the foot is planted."""
        at = self._at(time_s)
        return np.asarray((time_s >= self.on_s[at]) & (time_s <= self.off_s[at]))

    def targets(
        self, time_s: np.ndarray, joints_m: np.ndarray, leg: np.ndarray, ankles: np.ndarray, feet: np.ndarray
    ) -> None:
        """Writes ankles and unit vectors of the feet (T, 3) at times (T,), for postures with joints (T, J, 3).

        leg : (4,) joint numbers from hip to toe
        """
        from emulator.kernels.planting import targets

        targets(time_s, joints_m, leg, self._kernel, ankles, feet)

    @cached_property
    def _kernel(self) -> Any:
        from emulator.kernels.planting import Foot

        return Foot(**{name: getattr(self, name) for name in Foot._fields})

    def _at(self, time_s: np.ndarray) -> np.ndarray:
        """(T,) the stance that holds, or the last one before."""
        return np.clip(np.searchsorted(self.on_s, time_s, side="right") - 1, 0, len(self.on_s) - 1)


def stances(
    time_s: np.ndarray,
    runs: list[tuple[int, int]],
    joints_m: np.ndarray,
    leg: np.ndarray,
    place_m: np.ndarray,
    foot_m: float,
    toe_least_m: float,
    leg_m: float,
) -> FootStances:
    """The stances of one foot: runs (start, stop) of nodes at time_s (N,) in which it bears.

    joints_m (N, J, 3) of the postures, leg (4,) joint numbers from hip to toe, place_m (S, 3) where the ankles stand
    """
    from emulator.kernels.planting import settle

    flat = float(np.clip((toe_least_m - place_m[0, 2]) / foot_m, -0.95, 0.95))
    n, both = len(runs), np.array(runs, dtype=np.int64)
    rise_s, way_rad, missing, rates = np.empty(n), np.empty(n), np.empty((n, 2, 5)), np.empty((n, 2, 5))
    settle(time_s, both, joints_m, leg, place_m, foot_m, leg_m, flat, rise_s, way_rad, missing, rates)
    on_s, off_s = time_s[both[:, 0]], time_s[both[:, 1] - 1]
    if runs[0][0] == 0:
        on_s[0] = -np.inf
    if runs[-1][1] == len(time_s):
        off_s[-1] = np.inf
    return FootStances(on_s, rise_s, off_s, place_m, way_rad, flat, foot_m, toe_least_m, leg_m, missing, rates)


TURNING = -2
"""Where a pose laid flat has its turning."""
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

    model: CyclicLaw
    line: Timeline
    node_s: np.ndarray
    bone_length_m: np.ndarray
    place_m: np.ndarray | None

    def joints_m(self, time_s: np.ndarray) -> np.ndarray:
        """(T, J, 3) metres at times (T,), held before the start and after the end."""
        time_s = np.clip(time_s, 0.0, self.node_s[-1])
        values = self._spline(time_s)
        return self._planted(time_s, self._standing(self.model.latent.flat(values[:, :-3]), values[:, -3:]))

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
    def way_m(self) -> float:
        """How far the root goes, 0 where nothing is walked."""
        return 0.0 if self.place_m is None else float(self.model.pace.gone_m(self.place_m[None])[0])

    @cached_property
    def leg_m(self) -> float:
        return float(self.model.channel.leg_m(self.bone_length_m))

    @cached_property
    def _flat(self) -> np.ndarray:
        """(N, D) the poses at the nodes, laid flat."""
        return self.model.latent.flat(self.line.z)

    @cached_property
    def _yaw(self) -> np.ndarray:
        """(N,) heading at the nodes: the turning summed up, less what drifts over a stride."""
        from scipy.ndimage import uniform_filter1d

        step_s = np.diff(self.node_s)
        yaw = np.concatenate([[0.0], np.cumsum(self._flat[:-1, TURNING] / TRAVEL_WEIGHT * step_s)])
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
        hanging = self._hanging
        level = path_from_contacts(hanging, self.line.contact, self.model.skeleton)
        level = gaussian_filter1d(level, SMOOTH_FRAMES, axis=0, mode="nearest")
        level = level - level[0]
        if self.place_m is None:
            return level
        level = level + self._bent(level[:, None] + hanging[:, [leg[2] for leg in self.model.legs.joints], :2])
        return self._arriving(level)

    def _arriving(self, level: np.ndarray) -> np.ndarray:
        """(N, 2) level with what lacks of the whole way at its end made good, softly, within a last beat."""
        over = np.clip(1.0 - np.arange(len(level))[::-1] / min(self.model.beat_frames[1], len(level) - 1), 0.0, 1.0)
        lacking = (self.way_m - level[-1, 0]) * over**2 * (3 - 2 * over)
        return np.column_stack([level[:, 0] + lacking, level[:, 1]])

    def _bent(self, raw: np.ndarray) -> np.ndarray:
        """(N, 2) what the way lacks for its footprints raw (N, 2, 2), eased from the middle of each stance to the next.

        Along the way to the places asked for; aside, what they drift off a straight line.
        """
        from emulator.kernels.warping import monotone

        rows = [
            ((on + stop - 1) / 2, self._ahead(on, stop, side, raw), raw[(on + stop - 1) // 2, side])
            for side in (0, 1)
            for on, stop in stretches(self.line.contact[:, side])
        ]
        frame, ahead = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
        here = np.array([row[2] for row in rows])
        aside = -_straight(frame, here[:, 1]) if len(rows) > 4 else 0.0 * frame
        at, which = np.unique(frame, return_inverse=True)
        missing = np.column_stack([ahead - here[:, 0], aside])
        bend = np.stack([np.bincount(which, missing[:, c]) / np.bincount(which) for c in (0, 1)], axis=1)
        if len(at) < 2:
            return np.asarray(bend - bend[0])
        eased = np.empty((len(raw), 2))
        monotone(at, np.ascontiguousarray(bend.T), np.clip(np.arange(len(raw)), at[0], at[-1]), eased)
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
        if on >= beats[-1]:
            return self.way_m + float(self._ankle_end[side])
        share = along / max(float(self.place_m[-1]), 1e-9)
        return float(along + ends[0] + share * (ends[1] - ends[0]))

    @cached_property
    def _ankle_end(self) -> np.ndarray:
        """(2,) how far before the root the ankles are in the last frame."""
        assert self.model.legs is not None
        return np.asarray(self._hanging[-1, [leg[2] for leg in self.model.legs.joints], 0])

    def _travelled(self) -> np.ndarray:
        """Of a body without legs: the latents' own travel."""
        travel = unflattened(self._flat).travel
        step = turn(np.pad(travel[:-1, :2], ((0, 0), (0, 1))), self._yaw[:-1])[:, :2]
        step = step * np.diff(self.node_s)[:, None] * self.leg_m
        return np.concatenate([np.zeros((1, 2)), np.cumsum(step, axis=0)])

    @cached_property
    def _spline(self) -> Any:
        """Latents, heading and way over real time, with continuous acceleration."""
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.node_s, np.column_stack([self.line.z, self._yaw, self._level]))

    def _standing(self, flat: np.ndarray, path: np.ndarray, legs_only: bool = False) -> np.ndarray:
        """Joints (T, J, 3) of poses laid flat (T, D) on a path (T, 3) of headings and places; perhaps only the legs."""
        from emulator.kernels.bodies import hung

        skeleton = self.model.skeleton
        root = np.column_stack([path[:, 1:], flat[:, -1] / TRAVEL_WEIGHT * self.leg_m])
        joints = np.full((len(flat), skeleton.n_joints, 3), np.nan)  # what is not hung is nowhere
        chain = self.model.leg_chain if legs_only else skeleton.chain
        hung(flat, path[:, 0], root, self.bone_length_m, chain, joints)
        return joints

    @cached_property
    def _hanging(self) -> np.ndarray:
        """(N, J, 3) legs at the nodes with their heading, the root at 0."""
        path = np.column_stack([self._yaw, np.zeros((len(self.node_s), 2))])
        joints = self._standing(self._flat, path, legs_only=True)
        return np.asarray(joints - joints[:, [self.model.skeleton.root]])

    @cached_property
    def _bone_m(self) -> dict[int, float]:
        return dict(zip(self.model.skeleton.bones, self.bone_length_m.tolist()))

    @cached_property
    def _feet(self) -> tuple[FootStances, FootStances] | None:
        if self.model.legs is None:
            return None
        root = np.column_stack([self._level, self._flat[:, -1] / TRAVEL_WEIGHT * self.leg_m])
        raw = self._hanging + root[:, None]
        left, right = (self._stances(side, raw) for side in (0, 1))
        return left, right

    def _stances(self, side: int, raw: np.ndarray) -> FootStances:
        assert self.model.legs is not None
        legs = self.model.legs.tables[0]
        _, knee, ankle, toe = legs[side].tolist()
        foot_m = float(np.linalg.norm(raw[0, toe] - raw[0, ankle]))
        runs = stretches(self.line.contact[:, side])
        place = np.array([raw[(on + stop - 1) // 2, ankle] for on, stop in runs])
        place[:, 2] = self.model.ankle_legs * self.leg_m
        if self.place_m is not None:
            flat = raw[:, legs[:, 2], :2]
            place[:, 0] = [self._ahead(on, stop, side, flat) for on, stop in runs]
        least, leg_m = self.model.toe_legs * self.leg_m, self._bone_m[knee] + self._bone_m[ankle]
        return stances(self.node_s, runs, raw, legs[side], place, foot_m, least, leg_m)

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
        ankles, feet = np.empty((2, len(time_s), 3)), np.empty((2, len(time_s), 3))
        for side, own in enumerate(self._feet):
            own.targets(time_s, raw, self.model.legs.tables[0][side], ankles[side], feet[side])
        return ankles.swapaxes(0, 1), feet.swapaxes(0, 1)

    @cached_property
    def _lowered(self) -> tuple[np.ndarray, np.ndarray]:
        """Times and metres by which the hips come down ahead of need and without haste: no leg has to stretch."""
        from scipy.ndimage import gaussian_filter1d, maximum_filter1d

        assert self.model.legs is not None
        time_s = np.arange(0.0, self.node_s[-1] + 0.5 * GRID_S, GRID_S)
        values = self._spline(np.minimum(time_s, self.node_s[-1]))
        raw = self._standing(self.model.latent.flat(values[:, :-3]), values[:, -3:], legs_only=True)
        ankles, _ = self._targets(time_s, raw)
        need = np.maximum(wanting_m(raw, ankles, self.model.legs, self._bone_m) + SPARE_M, 0.0)
        need = maximum_filter1d(need, 2 * LOOK_AHEAD + 1, mode="nearest")
        return time_s, gaussian_filter1d(need, 0.7 * LOOK_AHEAD, mode="nearest")


def _straight(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The values at x of the line through (x, y) by least squares."""
    off = x - x.mean()
    return np.asarray(y.mean() + off * (off @ y) / (off @ off))
