"""What recordings say of pace: how long and how far the beats of each take go, and how they scatter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.cyclic.pace import GRAVITY_M_PER_S2, Pace
from emulator.cyclic.prepare import RATE_HZ, Prepared
from emulator.skeleton import Skeleton

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
