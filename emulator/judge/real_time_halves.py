"""Draws in real time beside repetitions that were not fitted, and new people beside people who were left out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.judge.clips import Clips, frame_rate_hz
from emulator.judge.coverage import LEVELS, QUANTITIES, PersonCovered, coverage, pooled_coverage
from emulator.judge.feet import feet
from emulator.judge.held_out import draw_alike, split_within_workers
from emulator.judge.joint_speeds import joint_rates
from emulator.judge.real_time import RealTime, real_time, sentence
from emulator.judge.sequence_distances import stream
from emulator.model.emulator import SCHEME, MotionEmulator
from emulator.motion import MotionSet

Progress = Callable[[int, int, str], None] | None
SPLITS_OF_A_SEED = 1000
N_PROFILE = 101


@dataclass(frozen=True, eq=False)
class RealTimeHalves:
    """What was found of one emulator on one class of recordings.

    drawn, recorded : means over the splits, of draws and of the fitted half's own recordings, against the other half
    covered         : a row a person that was left out; empty where there is one person only
    held, draws     : the movements of the first split, to look at
    """

    task: str
    scheme: str
    n_splits: int
    drawn: RealTime
    recorded: RealTime
    covered: tuple[PersonCovered, ...]
    held: Clips
    draws: Clips

    @property
    def sentence(self) -> str:
        """What draws are good for and what not."""
        return sentence(self.drawn, self.recorded)

    @property
    def of_new_people(self) -> str:
        """What the intervals of new people hold, in words; empty where nobody can be left out."""
        n_fitted = sum(not row.refused for row in self.covered)
        if not n_fitted:
            return ""
        held = {name: pooled_coverage(self.covered, name) for name in QUANTITIES}
        parts = [f"{100 * half:.0f} / {100 * most:.0f} % of {QUANTITIES[name]}" for name, (half, most) in held.items()]
        refused = len(self.covered) - n_fitted
        without = f"; {refused} fits without a person were refused" if refused else ""
        levels = " / ".join(f"{100 * level:.0f}" for level in LEVELS)
        return f"new people's {levels} % intervals hold {', '.join(parts)} of {n_fitted} people left out{without}"

    def as_plain(self) -> dict[str, Any]:
        """For JSON."""
        rows = {name: asdict(getattr(self, name)) for name in ("drawn", "recorded")}
        people = [asdict(row) for row in self.covered]
        words = {"sentence": self.sentence, "of_new_people": self.of_new_people}
        return {"scheme": self.scheme, "n_splits": self.n_splits, **rows, "people": people, **words}


def judge_real_time(
    motions: MotionSet,
    scheme: str = SCHEME,
    n_splits: int = 5,
    seed: int = 0,
    progress: Progress = None,
    *,
    people: bool = True,
) -> RealTimeHalves:
    """Fit to half of everybody's repetitions and hold as many draws of the same people against the other half.

    people : also leave each person out of a fit, and look for him among new ones
    Raises ValueError where the emulator cannot be fitted to the halves.
    """
    leave_out = people and len(motions.workers) > 1
    total = n_splits + (len(motions.workers) if leave_out else 0)
    found, seen = [], None
    with threadpool_limits(1, user_api="blas"):
        for split in range(n_splits):
            if progress is not None:
                progress(split, total, motions.task)
            fitted, held = split_within_workers(motions.in_order(), SPLITS_OF_A_SEED * seed + split)
            emulator = MotionEmulator.fit(fitted, scheme=scheme, seed=split)
            first, second = (Clips.recorded(half, emulator.skeleton) for half in (fitted, held))
            alike = draw_alike(emulator, fitted, len(fitted), stream(seed, motions.task, scheme, str(split)))
            draws = Clips.drawn(alike, frame_rate_hz(motions))
            rng = stream(seed, motions.task, "test", str(split))
            found.append((real_time(draws, second, rng, 19), real_time(first, second, rng, 19)))
            seen = seen or (second, draws)
        covered = coverage(motions, seed) if leave_out else []
    assert seen is not None
    drawn, recorded = (_over([pair[k] for pair in found]) for k in (0, 1))
    return RealTimeHalves(motions.task, scheme, n_splits, drawn, recorded, tuple(covered), *seen)


def profiles(clips: Clips, order: int) -> np.ndarray:
    """(n, 101) rate of the joint that is fastest at each share of a movement: m/s, m/s^2 or m/s^3 by ``order``."""
    clock, rows = np.linspace(0, 1, N_PROFILE), []
    for rate in joint_rates(clips, order):
        top = rate.max(axis=1)
        rows.append(np.interp(clock, (np.arange(len(top)) + 0.5) / len(top), top))
    return np.array(rows)


def foot_paths_m(clips: Clips) -> list[list[np.ndarray]]:
    """For each clip the way over the floor of each of its feet, (T, 2) from the root's first place."""
    root = clips.skeleton.root
    starts = [p[0, root, :2] for p in clips.positions_m]
    return [
        [p[:, joints, :2].mean(axis=1) - start for joints in feet(clips.skeleton)]
        for p, start in zip(clips.positions_m, starts)
    ]


def _over(splits: Sequence[RealTime]) -> RealTime:
    """Means over the splits that know a figure; the commonest word; every note once."""
    means = {}
    for name in splits[0].figures:
        values = np.array([one.figures[name] for one in splits])
        known = values[np.isfinite(values)]
        means[name] = float(known.mean()) if len(known) else float("nan")
    words = [one.telling for one in splits]
    notes = tuple(dict.fromkeys(note for one in splits for note in one.notes))
    counts = {f.name: round(means.pop(f.name)) for f in fields(RealTime) if f.type == "int"}
    return RealTime(**counts, **means, telling=max(words, key=words.count), notes=notes)  # type: ignore[arg-type]
