"""RULA, REBA, OWAS and raised arms over the shift: minutes at a level, mean, P90, most, dose, and how evenly."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.ergonomics.shift.booking import Booking
from opsim.ergonomics.shift.ledger import AT_MOST, Ledger
from opsim.kpi.duty import present_s
from opsim.kpi.evenness import gini
from opsim.kpi.exposure_by import exposure_by
from opsim.kpi.figure import Figure
from opsim.kpi.levels import LEVELS, bounds_of_level, mean_score, minutes, quantile
from opsim.kpi.values import SECONDS_PER_HOUR
from opsim.log import EventLog
from opsim.plan import Plan

WORST = "worst"
BOUNDS = {"": "", "at_most": AT_MOST}
"""Parts of figures, and what they are of in the ledger: the least that a score may be, and the most."""
OF_SCORES = {
    "mean": mean_score,
    "p90": lambda ledger, measure: quantile(ledger, measure, 0.9),
    "most": lambda ledger, measure: quantile(ledger, measure, 1.0),
}


def exposure_levels(booking: Booking, log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Figures over all workers together (no subject) and of each, of work, walking and waiting as far as measured.

    rula_from_5_min_per_h, ..., owas_from_3_min_per_h : measured minutes at this score or a higher one, in an hour of
        the window in which the worker is there, breaks included; all together: an hour of all workers' time. Without a
        part the least that the score may be, ``at_most`` the most; ``worst`` (no subject) is the worker with most of it
    arm_beyond_60_min_per_h, arm_beyond_90_min_per_h : the same with the higher upper arm raised so far against gravity
    rula_mean, rula_p90, rula_most, reba_... : over the measured time; P90 is the score at or below which nine tenths of
        it are
    posture_dose : RULA's score, integrated over the measured hours of the window; all together: the sum
    exposure_gini : how unevenly workers share it, 0 to 1 (``evenness.gini``); part: of which measure
    exposure_by_station, ..._task, ..._product, ..._hour : as ``exposure_by``
    """
    ledger, hours = booking.close(), present_s(log, plan) / SECONDS_PER_HOUR
    own, everyone = ledger.by("worker", np.arange(len(plan.workers))), ledger.together()
    for kpi, unit, part, of_all, of_each in _values(own, everyone, hours):
        yield Figure(kpi, "", part, unit, of_all)
        for worker, value in zip(plan.workers, of_each):
            yield Figure(kpi, worker.name, part, unit, value)
        if not part:
            yield Figure(kpi, "", WORST, unit, _most(of_each))
    yield from _evenness(own, hours)
    yield from exposure_by(ledger, plan, hours.sum(), log)


def measured_share(booking: Booking, plan: Plan) -> Iterator[Figure]:
    """posture_measured_share: of the time of work and set-ups, how much has a known posture."""
    ledger = booking.close()
    at_work = ledger.where(ledger.key[:, 2] >= 0)
    own = at_work.by("worker", np.arange(len(plan.workers)))
    for name, of in (("", at_work.together()), *((w.name, own.where([rank])) for rank, w in enumerate(plan.workers))):
        spent_s = of.seconds[0]
        share = 1.0 - of.unmeasured_s[0] / spent_s if spent_s > 0 else np.nan
        yield Figure("posture_measured_share", name, "", "share", share)


def _values(own: Ledger, everyone: Ledger, hours: np.ndarray) -> Iterator[tuple[str, str, str, float, np.ndarray]]:
    """KPI, unit, part, value of all together, (workers,) of each."""
    there, all_there = np.where(hours > 0, hours, np.nan), float(hours.sum()) or np.nan
    for name in LEVELS:
        if not name.startswith("trunk"):
            for part, bound in _parts(name):
                both = minutes(everyone, name, bound)[0] / all_there, minutes(own, name, bound) / there
                yield f"{name}_min_per_h", "min/h", part, *both
    for measure in ("rula", "reba"):
        for kpi, of in OF_SCORES.items():
            for part, bound in BOUNDS.items():
                yield f"{measure}_{kpi}", "1", part, of(everyone, measure + bound)[0], of(own, measure + bound)
    for part, bound in BOUNDS.items():
        dose, all_dose = _dose(own, bound), _dose(everyone, bound)
        yield "posture_dose", "score h", part, all_dose[0], dose


def _parts(level: str) -> list[tuple[str, str]]:
    return [(part, bound) for part, bound in BOUNDS.items() if bound in bounds_of_level(level)]


def _dose(ledger: Ledger, bound: str) -> np.ndarray:
    """(M,) hours times score; nan where there is time, and none of it measured."""
    none = (ledger.known_s("rula") <= 0) & (ledger.seconds > 0)
    return np.where(none, np.nan, ledger.score_seconds("rula" + bound) / SECONDS_PER_HOUR)


def _evenness(own: Ledger, hours: np.ndarray) -> Iterator[Figure]:
    """Of those who were ever there."""
    there = hours > 0
    for name in LEVELS:
        yield Figure("exposure_gini", "", name, "1", gini((minutes(own, name)[there]) / hours[there]))
    yield Figure("exposure_gini", "", "posture_dose", "1", gini(_dose(own, "")[there]))


def _most(values: np.ndarray) -> float:
    known = values[~np.isnan(values)]
    return float(known.max()) if known.size else np.nan
