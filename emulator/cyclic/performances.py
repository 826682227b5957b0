"""Cyclic performances drawn from an emulator: beats and times at once, postures when they are asked for.

What is asked of cyclic performances: how far, how often or how long, and how fast. Checked, all mistakes at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from typing import Any

import numpy as np

from emulator.cyclic.law import CyclicLaw
from emulator.cyclic.pace import FASTEST_M_PER_S, SLOWEST_M_PER_S, Asked
from emulator.cyclic.timeline import timeline
from emulator.cyclic.track import Track
from emulator.cyclic.units import CyclicWorker
from emulator.motion import turn
from emulator.performances import Floats, Performances
from emulator.skeleton import Skeleton


@dataclass(frozen=True, eq=False)
class CyclicPerformances(Performances):
    """n performances of a cyclic task.

    duration_s (n,) seconds; scores (n, K) what was drawn: the worker's own latents and step, the first foot, the speed
    beat_s, place_m : (n, M) when each beat comes and, of steps, where along the way the foot comes down; nan beyond
    bone_length_m (n, B) metres; ``performances[3]`` and slices are performances again, postures the same to 1e-10
    """

    model: CyclicLaw
    duration_s: np.ndarray
    scores: np.ndarray
    beat_s: np.ndarray
    place_m: np.ndarray
    control: np.ndarray
    offset: np.ndarray
    bone_length_m: np.ndarray
    first_foot: np.ndarray
    seed: np.ndarray

    @property
    def mark_s(self) -> np.ndarray:
        """(n, 0): a task of open length has no marks of its own; its beats are ``beat_s``."""
        return np.empty((len(self), 0))

    @property
    def dwell_s(self) -> np.ndarray:
        """(0,): no pauses are told apart."""
        return np.empty(0)

    @property
    def distance_m(self) -> np.ndarray:
        """(n,) metres from the first to the last place of the root; 0 where nothing is walked."""
        return self.model.pace.gone_m(self.place_m)

    def directions(
        self, times_s: np.ndarray | None = None, n_times: int = 101, dtype: Floats = np.float64
    ) -> np.ndarray:
        """(n, T, B, 3) unit directions without heading, at ``n_times`` even points of own time or at ``times_s``.

        times_s : (T,) or (n, T) seconds from the start; before it and after the end the posture is held.
        """
        times = self._times(times_s, n_times)
        found = [_unturned(track, at, self.skeleton) for track, at in zip(self.tracks, times)]
        return _stacked(found, times, self.skeleton.n_bones, 3).astype(dtype, copy=False)

    def positions_m(
        self, times_s: np.ndarray | None = None, n_times: int = 101, dtype: Floats = np.float64
    ) -> np.ndarray:
        """(n, T, J, 3) joints in metres, z up, floor at 0; the way goes along x from x = y = 0; times as above."""
        times = self._times(times_s, n_times)
        found = [track.joints_m(at) for track, at in zip(self.tracks, times)]
        return _stacked(found, times, len(self.skeleton.names), 3).astype(dtype, copy=False)

    def path(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 4) ``root_m`` and the heading in radians; times as ``directions``."""
        times, root = self._times(times_s, n_times), self.skeleton.root
        found = [np.column_stack([t.joints_m(at)[:, root], t.yaw_rad(at)]) for t, at in zip(self.tracks, times)]
        return _stacked(found, times, 4)

    def contact(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 2) whether the left and the right foot bear; times as ``directions``."""
        times = self._times(times_s, n_times)
        return _stacked([track.contact(at) for track, at in zip(self.tracks, times)], times, 2).astype(bool)

    @cached_property
    def tracks(self) -> tuple[Track, ...]:
        """The whole movement of each performance, made once."""
        return tuple(self._track(i) for i in range(len(self)))

    def _track(self, i: int) -> Track:
        beat_s = self.beat_s[i][np.isfinite(self.beat_s[i])]
        rng = np.random.default_rng([int(self.seed[i]), 1]) if self.seed[i] else None
        line = timeline(self.model, len(beat_s), float(self.control[i]), int(self.first_foot[i]), rng)
        place_m = self.place_m[i][np.isfinite(self.place_m[i])] if self.model.pace.steps else None
        nodes = _node_s(line.beat_frame, len(line.z), beat_s, float(self.duration_s[i]))
        return Track(self.model, line.moved(self.offset[i]), nodes, self.bone_length_m[i], place_m)


def _stacked(found: list[np.ndarray], times_s: np.ndarray, *shape: int) -> np.ndarray:
    """(n, T, ...) of what was found for each performance, of times (n, T); n may be 0."""
    return np.stack(found) if found else np.empty((*times_s.shape, *shape))


def _node_s(beat_frame: np.ndarray, n: int, beat_s: np.ndarray, duration_s: float) -> np.ndarray:
    """(n,) seconds of each frame: beats at their times, between them without a jump of the tempo."""
    from emulator.kernels.warping import monotone

    frame = np.concatenate([[0.0], beat_frame, [n - 1.0]])
    time_s = np.concatenate([[0.0], beat_s, [duration_s]])
    kept = np.concatenate([[True], np.diff(frame) > 0])
    node_s = np.empty((n, 1))
    monotone(frame[kept], time_s[kept][None], np.arange(float(n)), node_s)
    return np.ascontiguousarray(node_s[:, 0])


def _unturned(track: Track, time_s: np.ndarray, skeleton: Skeleton) -> np.ndarray:
    world = skeleton.directions(track.joints_m(time_s))
    return turn(world, -track.yaw_rad(time_s)[:, None])


LIMITS = {
    "distance_m": (0.05, 100_000.0, "metres from 0.05"),
    "cycles": (1.0, 1_000_000.0, "a whole number from 1"),
    "length_s": (0.2, 1_000_000.0, "seconds from 0.2"),
    "speed_m_per_s": (
        SLOWEST_M_PER_S,
        FASTEST_M_PER_S,
        f"{SLOWEST_M_PER_S:g} to {FASTEST_M_PER_S:g} m/s, as people walk",
    ),
    "pace": (0.05, 20.0, "a positive ratio"),
    "log_duration_shift": (-3.0, 3.0, "a number from -3 to 3"),
}
CONDITIONS = tuple(LIMITS)
LENGTHS = CONDITIONS[:3]
_TOGETHER_M_PER_S = (0.05, 4.0)
_WALKED = ("distance_m", "speed_m_per_s")


def asked_of(model: CyclicLaw, condition: Any, n: int, leg_m: np.ndarray, who: CyclicWorker) -> Asked:
    """The condition for n performances of these workers. Raises ValueError with every mistake in it."""
    said = _checked(model.task, condition, n, model.pace.steps)
    if not set(said) & set(LENGTHS):
        said["distance_m" if model.pace.steps else "cycles"] = np.full(n, model.pace.default)
    quicker = said.get("pace", np.ones(n)) * np.exp(-said.get("log_duration_shift", np.zeros(n)))
    nowhere = np.full(n, np.nan)
    if not model.pace.steps:
        return Asked(said.get("cycles", nowhere), who.pace * quicker, said.get("length_s", nowhere), nowhere)
    own = who.pace * model.pace.usual_m_per_s(leg_m)
    speed = np.clip(said.get("speed_m_per_s", own) * quicker, SLOWEST_M_PER_S, FASTEST_M_PER_S)
    total_s, beats = said.get("length_s", nowhere), 2 * said["cycles"] if "cycles" in said else nowhere
    if "distance_m" in said:
        way_m = said["distance_m"]
        speed = way_m / total_s if "length_s" in said else speed
    elif "cycles" in said:
        gone = beats + model.pace.halves
        way_m = gone * model.pace.step_m(speed * (beats + model.pace.beyond) / gone, leg_m, who.log_step)
    else:
        way_m = speed * total_s
    return Asked(way_m, speed, total_s, beats)


def _checked(task: str, condition: Any, n: int, steps: bool) -> dict[str, np.ndarray]:
    """The condition as arrays (n,)."""
    if condition is None:
        return {}
    if not isinstance(condition, Mapping):
        raise ValueError(f"{task}: condition: found {condition!r}, expected a mapping such as {{'distance_m': 3.0}}")
    wrong, said = [], {}
    for name, value in condition.items():
        if name not in CONDITIONS:
            near = get_close_matches(str(name), CONDITIONS, n=1)
            wrong.append(
                f"no {name!r}; " + (f"did you mean {near[0]!r}?" if near else f"known: {', '.join(CONDITIONS)}")
            )
        elif name in _WALKED and not steps:
            wrong.append(f"{name}: found {value}, but nobody walks in this task; expected cycles or length_s")
        elif problem := _out_of(name, value, n):
            wrong.append(problem)
        else:
            said[name] = np.broadcast_to(np.asarray(value, float), n).astype(float)
    wrong += _together(said)
    if wrong:
        raise ValueError("\n".join(f"{task}: condition: {line}" for line in wrong))
    return said


def _out_of(name: str, value: Any, n: int) -> str:
    low, high, expected = LIMITS[name]
    array = np.asarray(value)
    if array.dtype.kind not in "iuf" or array.shape not in ((), (n,)):
        return f"{name}: found {value!r}, expected {expected} (one number, or {n})"
    inside = np.isfinite(array) & (array >= low) & (array <= high)
    if name == "cycles":
        inside = inside & (array == np.rint(array))
    if np.all(inside):
        return ""
    return f"{name}: found {np.atleast_1d(array)[~np.atleast_1d(inside)][0]:g}, expected {expected}"


def _together(said: Mapping[str, np.ndarray]) -> list[str]:
    """How long it is may be said once; a distance and a time together are a speed."""
    lengths = [name for name in LENGTHS if name in said]
    if set(lengths) == {"distance_m", "length_s"}:
        speed = said["distance_m"] / said["length_s"]
        low, high = _TOGETHER_M_PER_S
        if "speed_m_per_s" in said:
            return ["found distance_m, length_s and speed_m_per_s, expected two of them"]
        if np.any((speed < low) | (speed > high)):
            return [
                f"distance_m over length_s: found {speed.min():g} to {speed.max():g} m/s, expected {low:g} to {high:g}"
            ]
        return []
    return [f"found {' and '.join(lengths)}, expected one of them"] if len(lengths) > 1 else []
