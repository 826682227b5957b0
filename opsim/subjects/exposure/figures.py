"""From which region of the body the minutes at a high score come.

Levels of exposure that are counted, and minutes at them, of what a ledger says.

Where, at what, with which product and when of the day people are exposed.

How evenly something is spread over people.

RULA, REBA, OWAS and raised arms over the shift: minutes at a level, mean, P90, most, dose, and how evenly.

What bodies went through: one pass over all postures of a replication, for whatever figures are asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from opsim.clock import on_the_clock
from opsim.ergonomics.shift.day import UPRIGHT, fold, hours_s
from opsim.ergonomics.shift.frames import WAITING, WALKING
from opsim.ergonomics.shift.ledger import AT_MOST, BINS, HOUR_S, HOURS, LEVELS, REGIONS, Booking, Ledger, Regions
from opsim.ergonomics.strain.energy import Spent
from opsim.ergonomics.strain.lifting import Lifted
from opsim.ergonomics.strain.posture_limits import Still
from opsim.kpi.catalogue import ENERGY, EXPOSURE, HELD, LIFTED, POSTURE, REGION, REST, SCORED, Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR
from opsim.log import ABSENT, OFF, EventLog
from opsim.plan import Plan
from opsim.subjects.exposure.strain_figures import Resting, energy_spent, holds, lifting, rest_allowances
from opsim.subjects.shifts.figures import present_s


def exposure_by_region(regions: Regions, log: EventLog, plan: Plan) -> Iterator[Figure]:
    """exposure_by_region: measured minutes at RULA 5 (part rula_from_5) or 7, in an hour of all workers' time, dealt
    out to trunk, neck, arms, wrists and legs, to the load and to ``time`` (what repeating or holding adds) by the
    points of the score that each brings in. They sum to the minutes there are.
    """
    hours = float(present_s(log, plan).sum()) / SECONDS_PER_HOUR
    minutes = regions.seconds.sum(axis=0) / 60.0
    for row, region in enumerate(REGIONS):
        for column, level in enumerate(LEVELS):
            value = float(minutes[row, column]) / hours if hours else float("nan")
            yield figure("exposure_by_region", region, f"rula_from_{level}", value)


class Level(NamedTuple):
    """At least ``value`` of a score or an angle of the ledger."""

    measure: str
    value: int


LEVEL_KPIS = {
    "rula_from_5": Level("rula", 5),
    "rula_from_7": Level("rula", 7),
    "reba_from_8": Level("reba", 8),
    "owas_from_3": Level("owas", 3),
    "arm_beyond_60": Level("arm", 60),
    "arm_beyond_90": Level("arm", 90),
    "trunk_beyond_60": Level("trunk", 60),
    "trunk_beyond_20": Level("trunk", 20),
}
"""RULA 5 and 6: changes soon, 7: at once (McAtamney & Corlett 1993, Applied Ergonomics 24(2), 91-99). REBA 8: high risk
(Hignett & McAtamney 2000, Applied Ergonomics 31, 201-205). OWAS 3: as soon as possible (Karhu, Kansi & Kuorinka 1977,
Applied Ergonomics 8(4), 199-201). Upper arm and trunk: ISO 11226:2000, EN 1005-4:2005."""


def bounds_of_level(name: str) -> tuple[str, ...]:
    """Parts of a figure at a level: "" for at least, and AT_MOST where the score is an interval."""
    return ("", AT_MOST) if LEVEL_KPIS[name].measure + AT_MOST in BINS else ("",)


def minutes(ledger: Ledger, name: str, bound: str = "") -> np.ndarray:
    """(M,) measured minutes of each cell at a level; nan where there is time, and none of it measured."""
    measure, value = LEVEL_KPIS[name]
    spent_s, known_s = ledger.from_s(measure + bound, value), ledger.known_s(measure + bound)
    return np.where((known_s <= 0) & (ledger.seconds > 0), np.nan, spent_s / 60.0)


def quantile(ledger: Ledger, measure: str, q: float) -> np.ndarray:
    """(M,) the score at or below which a share q of the known time is; q 1: the highest; nan where none is known."""
    first = BINS[measure].first
    until_s = np.cumsum(ledger.bins[measure][:, 1:], axis=1)
    whole_s = until_s[:, -1:]
    reached = until_s >= q * whole_s * (1 - 1e-12)
    return np.where(whole_s[:, 0] > 0, first + np.argmax(reached, axis=1), np.nan)


def mean_score(ledger: Ledger, measure: str) -> np.ndarray:
    """(M,) over the known time; nan where there is none."""
    known_s = ledger.known_s(measure)
    return np.where(known_s > 0, ledger.score_seconds(measure) / np.where(known_s > 0, known_s, 1.0), np.nan)


NONE = -1
Subjects = dict[int, str]


def exposure_by(ledger: Ledger, plan: Plan, hours: float, log: EventLog) -> Iterator[Figure]:
    """Measured minutes at each of ``LEVELS`` (part; with ``_at_most`` behind it: as many as there may be).

    exposure_by_station, exposure_by_task, exposure_by_product : in an hour of all workers' time, so that those of all
        stations (tasks, products) sum to the figure of all; but for the trunk, whose figures of all
        (``trunk_beyond_60_min_per_h``) are of work alone, while these are of walking and waiting too. Tasks ``walking``
        and ``waiting`` where these count, and ``none`` for what is done at no station, or for no product
    exposure_by_hour : by the hour of the day in which it was ("07:00"), in an hour of the time of those who were there
    """
    for column, subjects in _subjects(plan).items():
        cells = ledger.by(column, np.array(list(subjects), dtype=int))
        yield from _figures(f"exposure_by_{column}", cells, list(subjects.values()), np.full(len(subjects), hours))
    there_h = _present_s(log, plan) / SECONDS_PER_HOUR
    which = np.flatnonzero(there_h > 0)
    names = [on_the_clock(hour * HOUR_S) for hour in which.tolist()]
    yield from _figures("exposure_by_hour", ledger.by("hour", which), names, there_h[which])


def _figures(kpi: str, cells: Ledger, subjects: list[str], hours: np.ndarray) -> Iterator[Figure]:
    there = np.where(hours > 0, hours, np.nan)
    for name in LEVEL_KPIS:
        for bound in bounds_of_level(name):
            for subject, value in zip(subjects, minutes(cells, name, bound) / there):
                yield figure(kpi, subject, name + bound, value)


def _subjects(plan: Plan) -> dict[str, Subjects]:
    """By column of the ledger's key: whatever people may be exposed at."""
    tasks = {rank: task.name for rank, task in enumerate(plan.tasks) if not task.automatic and task.levels is None}
    beside = _beside_work(plan)
    stations = {rank: station.name for rank, station in enumerate(plan.stations) if station.tasks}
    products = {rank: product.name for rank, product in enumerate(plan.products)}
    nowhere = {NONE: "none"} if beside else {}
    no_product = {NONE: "none"} if beside or plan.setups or plan.subjects else {}
    return {"station": stations | nowhere, "task": tasks | beside, "product": products | no_product}


def _beside_work(plan: Plan) -> Subjects:
    walking = {} if plan.walking is None else {WALKING: "walking"}
    return walking | ({WAITING: "waiting"} if plan.ergonomics.waiting == UPRIGHT else {})


def _present_s(log: EventLog, plan: Plan) -> np.ndarray:
    """(24,) seconds of the window in which workers were there, all together, by the hour of the day."""
    gone = log.where(np.isin(log["kind"], (OFF, ABSENT)) & (log["worker"] >= 0))
    found = np.zeros(HOURS)
    for low_s, high_s in pairwise(hours_s(plan)):
        hour = int((plan.start_s + low_s) // HOUR_S) % HOURS
        found[hour] += (high_s - low_s) * len(plan.workers) - gone.clipped_s(low_s, high_s).sum()
    return found


def gini(values: np.ndarray) -> float:
    """The Gini coefficient of what n people have: 0 where all have the same, 1 - 1/n where one has all of it.

    The mean difference of two of them (each with each, himself too) over twice the mean. nan values are of nobody; 0
    where nobody has anything, nan where there is nobody. Raises ValueError for what is below 0.
    Source: Gini 1912, Variabilita e mutabilita; Sen 1973, On Economic Inequality, eq. 2.8.2.
    """
    have = np.sort(np.asarray(values, float)[~np.isnan(values)])
    if not have.size:
        return np.nan
    if have[0] < 0:
        raise ValueError(f"nobody can have less than nothing, found {have[0]:g}")
    whole = have.sum()
    rank = 2 * np.arange(1, have.size + 1) - have.size - 1
    return max(0.0, float(rank @ have / (have.size * whole))) if whole > 0 else 0.0


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
    for kpi, part, of_all, of_each in _values(own, everyone, hours):
        yield figure(kpi, "", part, of_all)
        for worker, value in zip(plan.workers, of_each):
            yield figure(kpi, worker.name, part, value)
        if not part:
            yield figure(kpi, "", WORST, _most(of_each))
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
        yield figure("posture_measured_share", name, "", share)


def _values(own: Ledger, everyone: Ledger, hours: np.ndarray) -> Iterator[tuple[str, str, float, np.ndarray]]:
    """KPI, part, value of all together, (workers,) of each."""
    there, all_there = np.where(hours > 0, hours, np.nan), float(hours.sum()) or np.nan
    for name in LEVEL_KPIS:
        if not name.startswith("trunk"):
            for part, bound in _parts(name):
                both = minutes(everyone, name, bound)[0] / all_there, minutes(own, name, bound) / there
                yield f"{name}_min_per_h", part, *both
    for measure in ("rula", "reba"):
        for kpi, of in OF_SCORES.items():
            for part, bound in BOUNDS.items():
                yield f"{measure}_{kpi}", part, of(everyone, measure + bound)[0], of(own, measure + bound)
    for part, bound in BOUNDS.items():
        dose, all_dose = _dose(own, bound), _dose(everyone, bound)
        yield "posture_dose", part, all_dose[0], dose


def _parts(level: str) -> list[tuple[str, str]]:
    return [(part, bound) for part, bound in BOUNDS.items() if bound in bounds_of_level(level)]


def _dose(ledger: Ledger, bound: str) -> np.ndarray:
    """(M,) hours times score; nan where there is time, and none of it measured."""
    none = (ledger.known_s("rula") <= 0) & (ledger.seconds > 0)
    return np.where(none, np.nan, ledger.score_seconds("rula" + bound) / SECONDS_PER_HOUR)


def _evenness(own: Ledger, hours: np.ndarray) -> Iterator[Figure]:
    """Of those who were ever there."""
    there = hours > 0
    for name in LEVEL_KPIS:
        yield figure("exposure_gini", "", name, gini((minutes(own, name)[there]) / hours[there]))
    yield figure("exposure_gini", "", "posture_dose", gini(_dose(own, "")[there]))


def _most(values: np.ndarray) -> float:
    known = values[~np.isnan(values)]
    return float(known.max()) if known.size else np.nan


class Asking(NamedTuple):
    """Some figures, the fold over postures that they are made from, and how they are made from it."""

    names: tuple[str, ...]
    make: Callable[[EventLog, Plan], Any]
    figures: Callable[[Any, EventLog, Plan], Iterator[Figure]]


ASKING: tuple[Asking, ...] = (
    Asking(REGION, lambda log, plan: Regions(plan), exposure_by_region),
    Asking(LIFTED, lambda log, plan: Lifted(plan), lifting),
    Asking(HELD, lambda log, plan: Still(len(plan.workers), plan.start_s), holds),
    Asking(ENERGY, lambda log, plan: Spent(plan), energy_spent),
    Asking(REST, lambda log, plan: Resting(plan), rest_allowances),
)
"""What is asked beside ``SCORED``, in the order in which it stands in the summary."""


def exposure(log: EventLog, plan: Plan, asked: Collection[str]) -> Iterator[Figure]:
    """Whatever is asked for of what needs all postures, from one pass over them; nothing where there are no workers.

    How much of the work was measured stands beside it, where ``trunk_figures`` does not say so already.
    Raises what ``opsim.ergonomics.shift.day.days`` raises.
    """
    if not plan.workers or set(EXPOSURE).isdisjoint(asked):
        return
    wanted = [asking for asking in ASKING if not set(asking.names).isdisjoint(asked)]
    booking, folds = Booking(plan.start_s), [asking.make(log, plan) for asking in wanted]
    fold(log, plan, [booking, *folds])
    if not set(SCORED).isdisjoint(asked):
        yield from exposure_levels(booking, log, plan)
    for asking, made in zip(wanted, folds):
        yield from asking.figures(made, log, plan)
    if set(POSTURE).isdisjoint(asked):
        yield from measured_share(booking, plan)
