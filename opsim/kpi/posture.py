"""How bent people work: time with the trunk beyond an angle, and its mean and 95th percentile while working."""

from collections.abc import Iterator

import numpy as np

from opsim.ergonomics.exposure import DEGREES, Exposure, trunk_exposure
from opsim.kpi.figure import Figure
from opsim.kpi.values import window_length_s
from opsim.log import EventLog
from opsim.plan import Plan

LIMITS_DEG = (60, 20)
"""Trunk flexion beyond which work counts as strongly, and as moderately bent.

Source: ISO 11226:2000, Ergonomics, Evaluation of static working postures; McAtamney & Corlett 1993, RULA, Applied
Ergonomics 24(2), 91-99.
"""
PARTS = ("below_20", "from_20_to_60", "beyond_60", "unmeasured", "not_at_work")
MINUTES_PER_HOUR = 60.0


def trunk_flexion(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Figures of the trunk over all workers together (no subject) and of each; none where there are no workers.

    trunk_beyond_60_min_per_h, ..._20_... : measured minutes of work with the trunk flexed so far or further, in an hour
        of the window and of a worker, who is present all of it since no calendar closes anything yet. All together:
        an hour of all workers' time. So unmeasured work makes it too small; nan where no work at all was measured
    trunk_flexion_mean_deg, trunk_flexion_p95_deg : over the measured time of work, forward positive
    trunk_flexion_share    : parts of the window that sum to 1; not_at_work is walking and waiting, never measured
    posture_measured_share : of the time of work, how much has a known posture
    """
    if not plan.workers:
        return
    by_worker, hours = trunk_exposure(log, plan), window_length_s(plan) / 3600.0
    yield from _of("", by_worker.together(), 0, hours * len(plan.workers))
    for rank, worker in enumerate(plan.workers):
        yield from _of(worker.name, by_worker, rank, hours)


def _of(subject: str, exposure: Exposure, rank: int, hours: float) -> Iterator[Figure]:
    measured_s, unmeasured_s = exposure.measured_s[rank], exposure.unmeasured_s[rank]
    worked_s = measured_s + unmeasured_s
    beyond_s = {limit: exposure.beyond_s(limit)[rank] for limit in LIMITS_DEG}
    for limit, spent_s in beyond_s.items():
        minutes = spent_s / 60.0 if measured_s > 0 or worked_s == 0 else np.nan
        yield Figure(f"trunk_beyond_{limit}_min_per_h", subject, "", "min/h", minutes / hours)
    known = measured_s > 0
    mean_deg = exposure.degree_seconds[rank] / measured_s if known else np.nan
    yield Figure("trunk_flexion_mean_deg", subject, "", "deg", mean_deg)
    yield Figure("trunk_flexion_p95_deg", subject, "", "deg", _quantile(exposure.seconds_by_degree[rank], 0.95))
    window_s = hours * 3600.0
    spent = (measured_s - beyond_s[20], beyond_s[20] - beyond_s[60], beyond_s[60], unmeasured_s, window_s - worked_s)
    for part, spent_s in zip(PARTS, spent):
        yield Figure("trunk_flexion_share", subject, part, "share", max(spent_s, 0.0) / window_s)
    yield Figure("posture_measured_share", subject, "", "share", measured_s / worked_s if worked_s > 0 else np.nan)


def _quantile(seconds_by_degree: np.ndarray, q: float) -> float:
    """The flexion in degrees below which a share q of the time was spent, evenly spread within a degree."""
    until_s = np.r_[0.0, np.cumsum(seconds_by_degree)]
    if until_s[-1] <= 0:
        return np.nan
    wanted_s = q * until_s[-1]
    cell = int(np.searchsorted(until_s, wanted_s)) - 1
    return float(DEGREES[cell] + (wanted_s - until_s[cell]) / (until_s[cell + 1] - until_s[cell]))
