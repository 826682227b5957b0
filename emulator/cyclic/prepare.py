"""Takes made ready for a cyclic fit: frames at one rate, contact, beats, and units cut out of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from emulator.cyclic.beats import onset, starts_still, strikes, turns
from emulator.cyclic.crew import Crew
from emulator.cyclic.latent import PoseLatent
from emulator.cyclic.pose import Poses, leg_length_m, poses_of
from emulator.cyclic.units import Unit
from emulator.recordings.take import Recording, Take
from emulator.skeleton import Skeleton

RATE_HZ = 30.0
ENERGY = 0.96
"""Share of the variance of poses in the components that the dynamics move."""
FINER = 0.995
"""Share in all components: with less the feet end where nobody put them."""
MOST_LATENTS, MOST_MOVED = 20, 8
MOST_UNITS = 16
TRAVELS_M = 1.0
"""Whose root stays within less (the diagonal of what it covers) works at one place."""
Progress = Callable[[int, int, str], None] | None


@dataclass(frozen=True, eq=False)
class Prepared:
    """One take at the rate of the model. beats : (frame, foot) in order, foot -1 where no foot comes down at a beat

    beat_s : (B,) seconds of the beats, as finely as the take says

    speed : (T,) of the root in legs a second; still : whether it starts and whether it ends standing
    """

    take: Take
    positions_m: np.ndarray
    poses: Poses
    contact: np.ndarray
    beats: list[tuple[int, int]]
    beat_s: np.ndarray
    speed: np.ndarray
    still: tuple[bool, bool]
    leg_m: float
    bone_length_m: np.ndarray


def prepared(take: Take, skeleton: Skeleton, steps: bool | None) -> Prepared:
    """A take at RATE_HZ with its contact (found, where nobody said). Raises ValueError that names the take."""
    from emulator.cyclic.contact_states import contact_of

    if not np.all(np.isfinite(take.positions_m)):
        raise ValueError(f"take {take.name}: positions are missing; clean the recording first")
    positions = resampled(take.positions_m, take.rate_hz)
    contact = take.contact
    if contact is None:
        found = contact_of(take.positions_m, skeleton, take.rate_hz) if steps is not False else None
        contact = np.ones((take.n_frames, 2), bool) if found is None else found
    fine = strikes(np.asarray(contact, bool))
    at = np.minimum(np.rint(np.arange(len(positions)) * take.rate_hz / RATE_HZ).astype(int), take.n_frames - 1)
    contact = np.asarray(contact, bool)[at]
    bones = np.median(skeleton.bone_lengths(positions), axis=0)
    leg = leg_length_m(skeleton, bones)
    poses = poses_of(positions, skeleton, RATE_HZ, leg_m=leg)
    root = positions[:, skeleton.root, :2]
    speed = np.linalg.norm(np.gradient(root, axis=0), axis=-1) * RATE_HZ / leg
    still = starts_still(speed), starts_still(speed[::-1])
    beats = strikes(contact)
    coarse = [frame / RATE_HZ for frame, _ in beats]
    beat_s = np.array([frame / take.rate_hz for frame, _ in fine] if len(fine) == len(beats) else coarse)
    return Prepared(take, positions, poses, contact, beats, beat_s, speed, still, leg, bones)


def resampled(positions_m: np.ndarray, rate_hz: float) -> np.ndarray:
    """(T, J, 3) at ``rate_hz`` -> at RATE_HZ by cubic splines; as it is where the rates agree."""
    from scipy.interpolate import CubicSpline

    if abs(rate_hz - RATE_HZ) < 1e-6:
        return positions_m
    time_s = np.arange(len(positions_m)) / rate_hz
    at = np.arange(int(time_s[-1] * RATE_HZ + 1e-6) + 1) / RATE_HZ
    return np.asarray(CubicSpline(time_s, positions_m)(at))


def walks(recording: Recording) -> bool:
    """Whether the takes go somewhere: the root of the median take travels more than ``TRAVELS_M``."""
    gone_m = []
    for take in recording.takes:
        root = take.positions_m[:, take.names.index("pelvis") if "pelvis" in take.names else 0, :2]
        seen = root[np.isfinite(root).all(axis=1)]
        gone_m.append(float(np.linalg.norm(np.ptp(seen, axis=0))) if len(seen) else 0.0)
    return float(np.median(gone_m)) > TRAVELS_M


def crew_of(parts: list[Prepared], offsets: dict[str, np.ndarray], log_step: dict[str, float]) -> Crew:
    """The workers in order of appearance, their bones the median over their takes."""
    names = tuple(dict.fromkeys(part.take.worker for part in parts))
    bones = [np.median([part.bone_length_m for part in parts if part.take.worker == name], axis=0) for name in names]
    return Crew(names, np.array([offsets[n] for n in names]), np.array([log_step[n] for n in names]), np.array(bones))


def cut(
    part: Prepared, z: np.ndarray, control: float, steps: bool
) -> tuple[Unit | None, Unit | None, slice, list[int]]:
    """Start and stop unit of a take (None where it does not start or end standing), its cyclic frames, beats in these.

    In walking the last full step's strike begins the stop unit, in which the other foot comes to stand beside.
    """
    frames = [frame for frame, _ in part.beats]
    feet = [foot for _, foot in part.beats]
    last = len(frames) - 2 if steps and part.still[1] else len(frames) - 1
    if last < 2:
        raise ValueError(f"take {part.take.name}: found {len(frames)} beats, expected 4 or more")
    start = stop = None
    if part.still[0]:
        begin = onset(part.speed) if steps else 0
        begin = max(min(begin, frames[0] - 1), 0)
        start = Unit(z[begin : frames[0] + 1], part.contact[begin : frames[0] + 1], control, feet[0])
    end = len(z) - (onset(part.speed[::-1]) if steps else 0)
    end = max(end, min(frames[-1] + 3, len(z)))
    if part.still[1] and end > frames[last] + 1:
        stop = Unit(z[frames[last] : end], part.contact[frames[last] : end], control, feet[last])
    return start, stop, slice(frames[0], frames[last] + 1), frames[: last + 1]


def latent_of(parts: list[Prepared], components: int | float) -> tuple[PoseLatent, int]:
    """Of all frames of the takes, and how many of its components the dynamics move."""
    moved = PoseLatent.fit([part.poses for part in parts], components=components).n_components
    moved = min(moved, MOST_MOVED) if isinstance(components, float) else moved
    whole = PoseLatent.fit([part.poses for part in parts], components=FINER)
    if whole.n_components < moved:
        whole = PoseLatent.fit([part.poses for part in parts], components=moved)
    return whole.first(max(min(whole.n_components, MOST_LATENTS), moved)), moved


def with_turns(part: Prepared, z: np.ndarray) -> Prepared:
    """Of a task that is no walking: its beats are the turns of the cycle."""
    from dataclasses import replace

    found = turns(z, RATE_HZ)
    return replace(part, beats=[(frame, -1) for frame in found], beat_s=np.array(found) / RATE_HZ, still=(True, True))
