"""Takes made ready for a cyclic fit: frames at one rate, contact, beats, and units cut out of them.

What recordings say of pace: how long and how far the beats of each take go, and how they scatter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from emulator.cyclic.latent import PoseLatent, Poses, leg_length_m, poses_of
from emulator.cyclic.pace import GRAVITY_M_PER_S2, Pace
from emulator.cyclic.units import Crew, Unit, onset, starts_still, strikes, turns
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
    from emulator.cyclic.contacts import contact_of

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


WALK_RATIO_SLOPE = 0.5
"""By which step length grows with speed at a constant walk ratio; where the recordings have one speed only."""
LEAST_RANGE = 0.15
"""Of log speed, below which the slope is not estimated."""


@dataclass(frozen=True, eq=False)
class Measured:
    """One take. beat_s (B - 1,) seconds between beats, step_m (B - 1,) metres (0 where nothing is walked)

    speed_m_per_s : while the beats go on; start_s, stop_s : before and after them, nan where it does not stand
    """

    beat_s: np.ndarray
    step_m: np.ndarray
    first_m: float
    speed_m_per_s: float
    start_s: float
    stop_s: float
    leg_m: float
    worker: str

    @property
    def froude(self) -> float:
        """Log of the speed over sqrt(g leg)."""
        return float(np.log(max(self.speed_m_per_s, 1e-9) / np.sqrt(GRAVITY_M_PER_S2 * self.leg_m)))

    @property
    def log_step(self) -> float:
        """Log of the mean step in legs."""
        return float(np.log(max(self.step_m.mean(), 1e-9) / self.leg_m))


def measured(part: Prepared, skeleton: Skeleton, frames: list[int], starts: int, stops: int, steps: bool) -> Measured:
    """frames : of the beats of the cyclic part; starts, stops : frames of its start and stop units, 0 for none."""
    beat_s = np.diff(part.beat_s[: len(frames)])
    nan = float("nan")
    start_s, stop_s = (n / RATE_HZ if n else nan for n in (starts, stops))
    if not steps:
        return Measured(beat_s, 0 * beat_s, 0.0, 0.0, start_s, stop_s, part.leg_m, part.take.worker)
    root = part.positions_m[:, skeleton.root, :2]
    way = root[frames[-1]] - root[frames[0]]
    along = way / np.linalg.norm(way)
    ankles = [skeleton.index(f"{side}_ankle") for side in ("left", "right")]
    foot_of = dict(part.beats)
    last = len(part.positions_m) - 1
    at = np.array([part.positions_m[min(f + 3, last), ankles[foot_of[f]], :2] @ along for f in frames])
    stood = float(part.positions_m[0, ankles, :2].mean(axis=0) @ along)
    speed = float(np.linalg.norm(way) / beat_s.sum())
    first_m = float(at[0] - stood) if starts else nan
    return Measured(beat_s, np.diff(at), first_m, speed, start_s, stop_s, part.leg_m, part.take.worker)


def paced(
    takes: list[Measured], steps: bool, names: tuple[str, ...], quantum_s: float
) -> tuple[Pace, dict[str, float]]:
    """The law of pace, counted in frames of ``quantum_s``, and each worker's own log step (or cycle time)."""
    owner = np.array([names.index(take.worker) for take in takes])
    froude = np.array([take.froude for take in takes]) if steps else np.zeros(len(takes))
    size = [take.log_step if steps else np.log(take.beat_s.mean()) for take in takes]
    slope = _slope(froude, np.array(size), owner) if steps else 0.0
    rest = np.array(size) - slope * froude
    own = np.array([rest[owner == w].mean() for w in range(len(names))])
    intercept = float(own.mean())
    beat_s = [take.beat_s / take.beat_s.mean() for take in takes]
    lengths = [take.step_m / take.step_m.mean() for take in takes] if steps else []
    ratio = [take.first_m / take.step_m.mean() for take in takes if steps and np.isfinite(take.first_m)]
    way = [np.nansum([take.first_m]) + take.step_m.sum() for take in takes] if steps else [len(b) for b in beat_s]
    pace = Pace(
        steps=steps,
        intercept=intercept,
        slope=slope,
        time_cv=_cv(beat_s, quantum=quantum_s / float(np.mean([take.beat_s.mean() for take in takes]))),
        length_cv=_cv(lengths, quantum=0.0) if steps else 0.0,
        follows=_follows(beat_s),
        start_beats=_share([take.start_s / take.beat_s.mean() for take in takes]),
        stop_beats=_share([take.stop_s / take.beat_s.mean() for take in takes]),
        usual=float(np.median(froude)),
        first=float(np.median(ratio)) if ratio else 1.0,
        default=float(np.round(np.median(way), 1 if steps else 0)),
        low=float(min(size)),
        high=float(max(size)),
    )
    return pace, {name: float(own[w] - intercept) for w, name in enumerate(names)}


def _slope(froude: np.ndarray, size: np.ndarray, owner: np.ndarray) -> float:
    """Within workers; the constant walk ratio's where the speeds hardly differ."""
    own = np.array([froude[owner == w].mean() for w in range(owner.max() + 1)])[owner]
    mean = np.array([size[owner == w].mean() for w in range(owner.max() + 1)])[owner]
    if np.ptp(froude - own) < LEAST_RANGE:
        return WALK_RATIO_SLOPE
    return float(((froude - own) @ (size - mean)) / ((froude - own) @ (froude - own)))


def _cv(parts: list[np.ndarray], quantum: float) -> float:
    """Scatter of beats about each take's mean, less what counting in frames adds (two ends, each even within one)."""
    squares = sum(float(((part - 1) ** 2).sum()) for part in parts)
    free = sum(len(part) - 1 for part in parts)
    return float(np.sqrt(max(squares / max(free, 1) - quantum**2 / 6, 1e-8)))


def _follows(parts: list[np.ndarray]) -> float:
    """Correlation of a beat with the next one, within -0.3 and 0.9."""
    pairs = [(part[:-1] - 1, part[1:] - 1) for part in parts if len(part) > 2]
    if not pairs:
        return 0.0
    before, after = (np.concatenate(column) for column in zip(*pairs))
    return float(np.clip((before @ after) / max(before @ before, 1e-12), -0.3, 0.9))


def _share(values: list[float]) -> float:
    known = [value for value in values if np.isfinite(value)]
    return float(np.median(known)) if known else 0.0
