"""Do the intervals of new people hold the people who were left out? Each person left out of the fit, one by one.

What is asked for: the duration, and where each bone points at even moments of the movement's own time, coordinate by
coordinate. That favours nobody. Along leading axes of all recordings, the one left out among them, people drawn from
the very law would be held too rarely, since such axes point at whoever is odd (docs/what_was_tried.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from emulator.geometry.flattening import resample
from emulator.judge.sequence_distances import stream
from emulator.model.emulator import MotionEmulator
from emulator.motion import MotionSet

LEVELS = (0.5, 0.9)
N_DRAWN, N_TIMES = 400, 31
QUANTITIES = {"duration": "durations", "posture": "directions of bones"}
"""What is asked for, and its plural in words."""
Progress = Callable[[int, int, str], None] | None


@dataclass(frozen=True)
class PersonCovered:
    """One person, left out: the share of his repetitions inside the central intervals (50 %, 90 %) of new people.

    duration, posture : (inside 50 %, inside 90 %), of posture the mean over bones, their coordinates and moments
    refused           : why the fit without him could not be made; empty where it was, and then the shares are known
    """

    task: str
    name: str
    duration: tuple[float, float] = (np.nan, np.nan)
    posture: tuple[float, float] = (np.nan, np.nan)
    refused: str = ""


def coverage(
    motions: MotionSet, seed: int = 0, n_drawn: int = N_DRAWN, progress: Progress = None
) -> list[PersonCovered]:
    """Fit without each person in turn, draw ``n_drawn`` performances of new people each time, and look for him there.

    Raises ValueError for recordings of one person: nothing then says how people differ.
    """
    if len(motions.workers) < 2:
        raise ValueError(f"{motions.task}: found one person, expected two or more: one is left out at a time")
    rows = []
    for number, name in enumerate(motions.workers):
        if progress is not None:
            progress(number, len(motions.workers), "people left out")
        rows.append(covered(motions, name, seed, n_drawn))
    return rows


def covered(motions: MotionSet, name: str, seed: int = 0, n_drawn: int = N_DRAWN) -> PersonCovered:
    """The fit without this person, and where he lies among new people; a refused fit is told, not raised."""
    out = np.array([motion.worker == name for motion in motions.motions])
    others, own = motions.subset(np.flatnonzero(~out)), motions.subset(np.flatnonzero(out))
    with threadpool_limits(1, user_api="blas"):
        try:
            model = MotionEmulator.fit(others)
        except ValueError as error:
            return PersonCovered(motions.task, name, refused=str(error))
        drawn = model.sample(n_drawn, stream(seed, "coverage", motions.task, name))
        duration = inside(own.duration_s[:, None], drawn.duration_s[:, None])
        posture = inside(_postures(own), _rows(drawn.directions(n_times=N_TIMES)))
        return PersonCovered(motions.task, name, duration, posture)


def pooled_coverage(rows: Sequence[PersonCovered], quantity: str) -> tuple[float, float]:
    """Shares inside 50 and 90 % over people, each counted once; NaN where none was fitted."""
    known = [getattr(row, quantity) for row in rows if not row.refused]
    return tuple(float(share) for share in np.mean(known, axis=0)) if known else (np.nan, np.nan)  # type: ignore


def inside(own: np.ndarray, drawn: np.ndarray) -> tuple[float, float]:
    """Share of own (n, K) inside the central intervals of drawn (m, K), over both axes."""
    shares = []
    for level in LEVELS:
        low, high = np.quantile(drawn, ((1 - level) / 2, (1 + level) / 2), axis=0)
        shares.append(float(np.mean((own >= low) & (own <= high))))
    return shares[0], shares[1]


def _postures(motions: MotionSet) -> np.ndarray:
    """(N, T * B * 3) directions on even points of own time."""
    clock = np.linspace(0, 1, N_TIMES)
    return _rows(np.stack([resample(motion.directions, clock) for motion in motions.motions]))


def _rows(directions: np.ndarray) -> np.ndarray:
    return np.asarray(directions.reshape(len(directions), -1))
