"""Layouts simulated and compared with the present one, replication by replication."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from opsim.kpi.better import LESS, Asked, read_asked
from opsim.study.compare import holm, paired
from opsim.study.interval import CONFIDENCE, Interval, t_interval
from opsim.study.jobs import Answers, Job

WALKED, EACH, SHARE = "walked_m_per_h", "walked_m_per_part", "walking_share"
BEST, EXPOSURE, EXPOSURE_EACH = "best", "exposure", "exposure_per_part"
MEASURES = (BEST, WALKED, EACH, SHARE, EXPOSURE, EXPOSURE_EACH)
WORST = "worst"
"""The part of a figure that is of the worker who has most of it already."""


@dataclass(frozen=True, slots=True)
class Against:
    """One measure of a layout against the present one on the same random numbers; p_together : Holm over layouts."""

    now: Interval
    then: Interval
    difference: Interval
    p: float
    p_together: float

    @property
    def measured(self) -> bool:
        """Whether both layouts have the figure in any replication that they share."""
        return bool(np.isfinite(self.difference.mean))

    @property
    def clear(self) -> bool:
        """Whether all layouts compared together are rightly told apart from the present one with 95 %."""
        return bool(self.p_together <= 1 - CONFIDENCE) and self.difference.mean != 0

    @property
    def less(self) -> bool:
        """Whether it is clearly less than now."""
        return self.clear and self.difference.mean < 0

    @property
    def more(self) -> bool:
        """Whether it is clearly more than now."""
        return self.clear and self.difference.mean > 0

    def within(self, share: float) -> bool:
        """Whether the whole interval lies within +- a share of the present mean."""
        mean, half = self.relative
        return bool(abs(mean) + half <= share)

    @property
    def identical(self) -> bool:
        """The same in every replication, but for rounding."""
        return self.difference.mean == 0 and self.difference.sd == 0

    @property
    def relative(self) -> tuple[float, float]:
        """(mean, half-width) as a share of the present mean; nan where that is 0."""
        of = abs(self.now.mean) or np.nan
        return self.difference.mean / of, self.difference.half_width / of


def measures(
    answers: Answers, jobs: Sequence[Job], hours: float, best: Asked, exposure: Asked | None
) -> dict[str, np.ndarray]:
    """By measure, its (R,) values in the replications of one layout; hours : of the window.

    walked_m_per_h : of all people together; walking_share : of people's time, their mean; best : the figure asked for,
    summed over its subjects where it has no value of the whole; exposure : of the worker who has most of it
    walked_m_per_part, exposure_per_part : by good parts made, since who makes more walks and bends more
    """
    keys = answers.keys(jobs)
    values = answers.values(jobs, keys)

    def of(kpi: str, part: str | None = None) -> np.ndarray:
        columns = [n for n, key in enumerate(keys) if key[0] == kpi and (part is None or key[2] == part)]
        return values[:, columns]

    found = {
        BEST: _whole(keys, values, best),
        WALKED: of("walked_m").sum(axis=1) / hours,
        SHARE: _mean(of("worker_states", "walk")),
    }
    parts_per_h = _whole(keys, values, Asked("throughput_per_h"))
    parts_per_h = np.where(parts_per_h > 0, parts_per_h, np.nan)
    found[EACH] = found[WALKED] / parts_per_h
    if exposure is not None:
        found[EXPOSURE] = _worst(keys, values, exposure)
        if exposure.kpi.endswith("_per_h"):
            found[EXPOSURE_EACH] = found[EXPOSURE] / parts_per_h
    return found


def against(
    layouts: Mapping[str, Mapping[str, np.ndarray]], now: Mapping[str, np.ndarray]
) -> dict[str, dict[str, Against]]:
    """By layout and measure, the paired comparison with the present one; tests of a measure held together (Holm)."""
    found: dict[str, dict[str, Against]] = {name: {} for name in layouts}
    for measure in MEASURES:
        if measure not in now:
            continue
        for name, values in layouts.items():
            difference, p, _ = paired(values[measure].tolist(), now[measure].tolist())
            found[name][measure] = Against(t_interval(now[measure]), t_interval(values[measure]), difference, p, p)
        together = holm([found[name][measure].p for name in layouts])
        for name, p in zip(layouts, together):
            found[name][measure] = replace(found[name][measure], p_together=float(p))
    return found


def exposure_asked(outputs: Sequence[str], said: str | None) -> Asked | None:
    """The second criterion: what was said, or the first output that says what bodies go through, and less is better."""
    from opsim.kpi.names import EXPOSURE as SCORED
    from opsim.kpi.names import POSTURE, WALKING

    if said is not None:
        return read_asked(said)
    bodily = [kpi for kpi in outputs if kpi in (*POSTURE, *SCORED) and kpi not in WALKING]
    return next((asked for asked in map(read_asked, bodily) if asked.better == LESS), None)


def _whole(keys: Sequence[tuple[str, ...]], values: np.ndarray, asked: Asked) -> np.ndarray:
    named = [n for n, key in enumerate(keys) if key[0] == asked.kpi and key[2] == asked.part]
    if asked.subject or any(keys[n][1] == "" for n in named):
        named = [n for n in named if keys[n][1] == asked.subject]
    if not named:
        raise ValueError(f"no figure {asked.name} in this scenario; name another one with --best or --exposure")
    return values[:, named].sum(axis=1)


def _worst(keys: Sequence[tuple[str, ...]], values: np.ndarray, asked: Asked) -> np.ndarray:
    """(R,) of the worker who has most of it, of those of whom it is known; nan where it is of nobody."""
    of_each = [n for n, key in enumerate(keys) if key[0] == asked.kpi and key[1] and key[2] == asked.part]
    if asked.subject or asked.part == WORST or not of_each:
        return _whole(keys, values, asked)
    most = np.where(np.isnan(values[:, of_each]), -np.inf, values[:, of_each]).max(axis=1)
    return np.where(np.isfinite(most), most, np.nan)


def _mean(values: np.ndarray) -> np.ndarray:
    return values.mean(axis=1) if values.shape[1] else np.zeros(len(values))
