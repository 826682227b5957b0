"""Held-out durations and mark times: does the emulator give what the same people did in repetitions it never saw?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.model import MotionEmulator
from emulator.motion import MotionSet

QUANTILES = (0.1, 0.25, 0.5, 0.75, 0.9)


@dataclass(frozen=True)
class HeldOutRow:
    """One quantity of one task: Kolmogorov-Smirnov distance and p, and emulated less held-out quantiles in per cent.

    Correct p by ``holm`` over a whole table; the quantiles are those of ``QUANTILES``.
    """

    task: str
    quantity: str
    n_fit: int
    n_held: int
    distance: float
    p: float
    quantile_error_percent: tuple[float, ...]


def split_within_workers(motions: MotionSet, seed: int) -> tuple[MotionSet, MotionSet]:
    """Each worker's repetitions dealt at random into two halves; an odd one out goes to the first."""
    rng = np.random.default_rng(seed)
    first: list[int] = []
    for worker in range(len(motions.workers)):
        mine = rng.permutation(np.flatnonzero(motions.worker_index == worker))
        first += mine[: (len(mine) + 1) // 2].tolist()
    rest = sorted(set(range(len(motions))) - set(first))
    return motions.subset(sorted(first)), motions.subset(rest)


def held_out_rows(motions: MotionSet, seed: int = 0, n_each: int = 400) -> list[HeldOutRow]:
    """Fit one half, draw ``n_each`` for each held-out one of the same worker; compare duration and marks."""
    fitted, held = split_within_workers(motions, seed)
    return emulated_rows(MotionEmulator.fit(fitted, seed=seed), len(fitted), held, np.random.default_rng(seed), n_each)


def emulated_rows(
    emulator: MotionEmulator, n_fit: int, held: MotionSet, rng: np.random.Generator, n_each: int = 400
) -> list[HeldOutRow]:
    """Duration and marks that the emulator draws for the same workers, beside those of the held-out motions."""
    drawn = [emulator.sample(n_each, rng, worker=m.worker) for m in held.motions]
    mark_s = np.concatenate([p.mark_s for p in drawn])
    return _rows(held, n_fit, np.concatenate([p.duration_s for p in drawn]), mark_s)


def resampled_rows(fitted: MotionSet, held: MotionSet, rng: np.random.Generator, n_each: int = 400) -> list[HeldOutRow]:
    """The control: duration and marks of the same workers' fitted repetitions, drawn again with replacement."""
    names = np.array([m.worker for m in fitted.motions])
    again = np.concatenate([rng.choice(np.flatnonzero(names == m.worker), n_each) for m in held.motions])
    return _rows(held, len(fitted), fitted.duration_s[again], fitted.mark_s[again])


def _rows(held: MotionSet, n_fit: int, duration_s: np.ndarray, mark_s: np.ndarray) -> list[HeldOutRow]:
    marks = [(name, mark_s[:, e], held.mark_s[:, e]) for e, name in enumerate(held.mark_names)]
    pairs = [("duration", duration_s, held.duration_s), *marks]
    return [_row(held.task, name, n_fit, emulated, seen) for name, emulated, seen in pairs]


def _row(task: str, quantity: str, n_fit: int, emulated: np.ndarray, seen: np.ndarray) -> HeldOutRow:
    from scipy.stats import ks_2samp

    test = ks_2samp(emulated, seen)
    error = 100 * (np.quantile(emulated, QUANTILES) / np.quantile(seen, QUANTILES) - 1)
    return HeldOutRow(
        task, quantity, n_fit, len(seen), float(test.statistic), float(test.pvalue), tuple(float(e) for e in error)
    )


def holm(p: Sequence[float]) -> np.ndarray:
    """p values corrected for all being looked at (Holm 1979): (M,) in, (M,) out, at most 1."""
    given = np.asarray(p, float)
    order = np.argsort(given)
    stepped = np.maximum.accumulate((len(given) - np.arange(len(given))) * given[order])
    corrected = np.empty(len(given))
    corrected[order] = np.minimum(stepped, 1.0)
    return corrected


def table_text(rows: Sequence[HeldOutRow]) -> str:
    """The table as lines of text, Holm's correction over all its rows."""
    head = "  ".join(f"q{int(100 * q):02d} %" for q in QUANTILES)
    lines = [f"{'task':20s} {'quantity':9s} {'fit':>3s} {'held':>4s}    KS      p  p Holm  {head}"]
    for row, corrected in zip(rows, holm([row.p for row in rows])):
        errors = "  ".join(f"{e:+5.1f}" for e in row.quantile_error_percent)
        counts = f"{row.n_fit:3d} {row.n_held:4d}"
        lines.append(
            f"{row.task:20s} {row.quantity:9s} {counts}  {row.distance:.3f}  {row.p:.3f}   {corrected:.3f}  {errors}"
        )
    return "\n".join(lines)
