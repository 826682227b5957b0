"""The evidence as lines of text."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from motion_evidence.drawers import COPIER, OURS, PAPER, REAL, SHAKER
from motion_evidence.judged import Split
from motion_evidence.verdicts import Figures, figures

from emulator.judge.held_out import QUANTILES, HeldOutRow, holm

_HEAD = (
    f"{'class':19} {'drawer':12} {'energy':>8} {'ratio':>6} {'of med.':>7} {'strat.':>6} "
    f"{'p>.05':>6} {'novelty':>7} {'rough':>6} {'2nd':>6} {'own t':>6}"
)
_TIMES_HEAD = f"{'class':19} {'quantity':9} {'drawer':10} {'KS':>6} {'p>.05':>6}  " + "  ".join(
    f"q{q:.2f}" for q in QUANTILES
)


def lines(splits: list[Split]) -> Iterator[str]:
    """Tables of the postures, of the reconstruction, and of durations and marks."""
    tasks = list(dict.fromkeys(split.task for split in splits))
    yield "Postures against the unseen half: energy (U-statistic) and its ratio to the paper's scheme"
    yield "(median of ratios, ratio of medians, and the same for a stratified sample), DISCO, novelty,"
    yield "temporal roughness and second differences (on the common clock, and in own time)"
    yield _HEAD
    for task in tasks:
        for drawer in (OURS, PAPER, COPIER, SHAKER, REAL):
            yield _drawer(figures(splits, task, drawer))
    yield "\nError of the unseen half (radians, summed over bones, mean over time)"
    for task in tasks:
        yield _reconstruction([split for split in splits if split.task == task])
    yield "\nReal time on unseen repetitions: median Kolmogorov-Smirnov, p after Holm, quantile errors in %"
    yield _TIMES_HEAD
    for name, kind in (("emulated", "emulated_times"), ("resampled", "resampled_times")):
        yield from _times(name, [row for split in splits for row in getattr(split, kind)])


def _drawer(f: Figures) -> str:
    own = "" if np.isnan(f.roughness_own_time) else f"{f.roughness_own_time:6.2f}"
    ratios = f"{f.ratio:6.2f} {f.ratio_of_medians:7.2f} {f.ratio_stratified:6.2f}"
    rough = f"{f.novelty:7.2f} {f.temporal_roughness:6.2f} {f.roughness:6.2f}"
    passed = f"{f.n_passed:3}/{f.n_splits:<2}"
    return f"{f.task:19} {f.drawer:12} {f.energy:8.3f} {ratios} {passed} {rough} {own}"


def _reconstruction(rows: list[Split]) -> str:
    ours, paper = (np.median([getattr(row, name) for row in rows]) for name in ("error", "paper_error"))
    most = max(row.n_components for row in rows)
    return f"{rows[0].task:19} {most:3} numbers {ours:.3f}; the paper's 300 {paper:.3f}"


def _times(name: str, rows: list[HeldOutRow]) -> Iterator[str]:
    corrected = holm([row.p for row in rows])
    for task, quantity in dict.fromkeys((row.task, row.quantity) for row in rows):
        mine = [i for i, row in enumerate(rows) if (row.task, row.quantity) == (task, quantity)]
        errors = np.median([rows[i].quantile_error_percent for i in mine], axis=0)
        distance = np.median([rows[i].distance for i in mine])
        passed = f"{np.sum(corrected[mine] > 0.05):3}/{len(mine):<2}"
        quantiles = "  ".join(f"{e:+5.1f}" for e in errors)
        yield f"{task:19} {quantity:9} {name:10} {distance:6.3f} {passed}  {quantiles}"
