"""How bent people work and walk: time with the trunk beyond an angle, its mean and 95th percentile; steps."""

from collections.abc import Iterator

import numpy as np

from opsim.ergonomics.trunk import DEGREES, Exposure, trunk_exposure
from opsim.ergonomics.walking import Walked, walking_exposure
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.subjects.shifts.figures import present_s

LIMITS_DEG = (60, 20)
"""Trunk flexion beyond which work counts as strongly, and as moderately bent.

Source: ISO 11226:2000, Ergonomics, Evaluation of static working postures; McAtamney & Corlett 1993, RULA, Applied
Ergonomics 24(2), 91-99.
"""
WORKED = ("below_20", "from_20_to_60", "beyond_60", "unmeasured")
WALKED = ("walking_below_20", "walking_from_20", "walking_unmeasured")
WALKING, TOGETHER = "walking", "together"
"""Parts of the figures of trunks where walking has postures; without a part they are of work alone, there too."""


def trunk_flexion(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Figures of the trunk over all workers together (no subject) and of each; none where there are no workers.

    trunk_beyond_60_min_per_h, ..._20_... : measured minutes of work with the trunk flexed so far or further, in an hour
        of the window in which the worker is there, breaks included. All together: an hour of all workers' time. So
        unmeasured work makes it too small; nan where no work at all was measured, or nobody was ever there
    trunk_flexion_mean_deg, trunk_flexion_p95_deg : over the measured time of work, forward positive
    trunk_flexion_share    : parts of that time, which sum to 1; not_at_work is walking and waiting, never measured
    posture_measured_share : of the time of work, how much has a known posture

    Where the plan names a walking emulator, minutes, mean and percentile have the parts ``walking`` and ``together``
    (work and walking) besides, the shares tell walking from waiting, and there are more:

    walking_min_per_h : measured minutes of walking, of an hour as above
    walking_measured_share : of the time of walking, how much has a known posture
    steps_per_h, step_length_m, cadence_per_min : steps of the measured walking: in an hour, how long, how many a minute
    """
    if not plan.workers:
        return
    worked, hours = trunk_exposure(log, plan), present_s(log, plan) / SECONDS_PER_HOUR
    walked = None if plan.walking is None else walking_exposure(log, plan)
    all_walked = None if walked is None else walked.together()
    yield from _of("", worked.together(), all_walked, 0, float(hours.sum()) or np.nan)
    for rank, worker in enumerate(plan.workers):
        yield from _of(worker.name, worked, walked, rank, float(hours[rank]) or np.nan)


def _of(subject: str, worked: Exposure, walked: Walked | None, rank: int, hours: float) -> Iterator[Figure]:
    exposures = {"": worked}
    if walked is not None:
        exposures |= {WALKING: walked.exposure, TOGETHER: worked + walked.exposure}
    for limit in LIMITS_DEG:
        for part, exposure in exposures.items():
            minutes = _minutes_beyond(exposure, rank, limit)
            yield figure(f"trunk_beyond_{limit}_min_per_h", subject, part, minutes / hours)
    for name, angle in (("mean", _mean_deg), ("p95", _p95_deg)):
        for part, exposure in exposures.items():
            yield figure(f"trunk_flexion_{name}_deg", subject, part, angle(exposure, rank))
    window_s = hours * SECONDS_PER_HOUR
    for part, spent_s in _spent(worked, walked, rank, window_s):
        yield figure("trunk_flexion_share", subject, part, max(spent_s, 0.0) / window_s)
    yield figure("posture_measured_share", subject, "", _measured_share(worked, rank))
    if walked is not None:
        yield from _steps(subject, walked, rank, hours)


def _minutes_beyond(exposure: Exposure, rank: int, limit: int) -> float:
    """Measured minutes; nan where there is time, and none of it measured."""
    none = exposure.measured_s[rank] <= 0 and exposure.unmeasured_s[rank] != 0
    return np.nan if none else float(exposure.beyond_s(limit)[rank] / 60.0)


def _mean_deg(exposure: Exposure, rank: int) -> float:
    measured_s = exposure.measured_s[rank]
    return float(exposure.degree_seconds[rank] / measured_s) if measured_s > 0 else np.nan


def _p95_deg(exposure: Exposure, rank: int) -> float:
    return _quantile(exposure.seconds_by_degree[rank], 0.95)


def _measured_share(exposure: Exposure, rank: int) -> float:
    spent_s = exposure.measured_s[rank] + exposure.unmeasured_s[rank]
    return float(exposure.measured_s[rank] / spent_s) if spent_s > 0 else np.nan


def _spent(worked: Exposure, walked: Walked | None, rank: int, window_s: float) -> Iterator[tuple[str, float]]:
    """Seconds of each part of the window."""
    measured_s, unmeasured_s = worked.measured_s[rank], worked.unmeasured_s[rank]
    beyond_s = {limit: worked.beyond_s(limit)[rank] for limit in LIMITS_DEG}
    yield from zip(WORKED, (measured_s - beyond_s[20], beyond_s[20] - beyond_s[60], beyond_s[60], unmeasured_s))
    worked_s = measured_s + unmeasured_s
    if walked is None:
        yield "not_at_work", window_s - worked_s
        return
    walked_s, bent_s = walked.exposure.measured_s[rank], walked.exposure.beyond_s(20)[rank]
    unknown_s = walked.exposure.unmeasured_s[rank]
    yield from zip(WALKED, (walked_s - bent_s, bent_s, unknown_s))
    yield "waits", window_s - worked_s - walked_s - unknown_s


def _steps(subject: str, walked: Walked, rank: int, hours: float) -> Iterator[Figure]:
    minutes, steps = walked.exposure.measured_s[rank] / 60.0, walked.steps[rank]
    yield figure("walking_min_per_h", subject, "", minutes / hours)
    yield figure("steps_per_h", subject, "", steps / hours)
    yield figure("step_length_m", subject, "", walked.metres[rank] / steps if steps > 0 else np.nan)
    yield figure("cadence_per_min", subject, "", steps / minutes if minutes > 0 else np.nan)
    yield figure("walking_measured_share", subject, "", _measured_share(walked.exposure, rank))


def _quantile(seconds_by_degree: np.ndarray, q: float) -> float:
    """The flexion in degrees below which a share q of the time was spent, evenly spread within a degree."""
    until_s = np.r_[0.0, np.cumsum(seconds_by_degree)]
    if until_s[-1] <= 0:
        return np.nan
    wanted_s = q * until_s[-1]
    cell = int(np.searchsorted(until_s, wanted_s)) - 1
    return float(DEGREES[cell] + (wanted_s - until_s[cell]) / (until_s[cell + 1] - until_s[cell]))
