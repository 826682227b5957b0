"""Postures held still, movements a minute, repetition, and the limits of ISO 11226 and EN 1005-4 over the shift."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.ergonomics.strain.holds import REGIONS
from opsim.ergonomics.strain.limits import ISO_11226, NOT_RECOMMENDED, judged_static
from opsim.ergonomics.strain.repetition import begun
from opsim.ergonomics.strain.still import Still
from opsim.ergonomics.strain.zones import ZONED
from opsim.kpi.duty import present_s
from opsim.kpi.figure import Figure
from opsim.kpi.values import SECONDS_PER_HOUR, in_window, inside_s
from opsim.log import SETUP, WORK, EventLog
from opsim.plan import Plan

REPETITIONS = "repetitions_per_min"


def holds(still: Still, log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of all workers together (no subject) and of each; the part is the region of the body.

    static_hold_min_per_h : minutes with the region out of neutral, forward or backward, and still (within 10 degrees)
        for longer than 4 s, in an hour in which he is there
    longest_hold_s        : the longest of these, in one go, over all tasks
    iso_11226_min_per_h   : minutes of holds that ISO 11226 does not recommend: too far, or longer than its time
    en_1005_4_min_per_h   : minutes in zones that EN 1005-4 does not accept for what is held, or for how often one moves
        into them
    movements_per_min     : how often the trunk bends, or an arm rises, beyond 20 degrees, a minute of known posture
    and repetitions_per_min, as ``repetitions`` gives it
    """
    runs, there_s = still.close(), present_s(log, plan)
    for place, region in enumerate(REGIONS):
        own = runs[region]
        verdict = judged_static(own.angle_deg, own.seconds, getattr(ISO_11226, region))
        beyond = np.bincount(own.worker, own.seconds * (verdict == NOT_RECOMMENDED), len(plan.workers))
        longest = np.zeros(len(plan.workers))
        np.maximum.at(longest, own.worker, own.seconds)
        yield from _each(
            "static_hold_min_per_h", region, still.held_s[:, place] / 60.0, there_s / SECONDS_PER_HOUR, plan
        )
        yield from _each("iso_11226_min_per_h", region, beyond / 60.0, there_s / SECONDS_PER_HOUR, plan)
        yield Figure("longest_hold_s", "", region, "s", longest.max())
        for worker, value in zip(plan.workers, longest.tolist()):
            yield Figure("longest_hold_s", worker.name, region, "s", value)
    for place, region in enumerate(ZONED):
        minutes = still.not_acceptable_s[:, place] / 60.0
        yield from _each("en_1005_4_min_per_h", region, minutes, there_s / SECONDS_PER_HOUR, plan)
        if region in ("trunk", "left_arm", "right_arm"):
            known_min = still.known_s[:, place] / 60.0
            yield from _each("movements_per_min", region, still.moves[:, place], known_min, plan, "1/min")
    yield from repetitions(log, plan)


def _each(
    kpi: str, part: str, amount: np.ndarray, per: np.ndarray, plan: Plan, unit: str = "min/h"
) -> Iterator[Figure]:
    """All together, and each worker."""
    yield Figure(kpi, "", part, unit, amount.sum() / (per.sum() or np.nan))
    for worker, one, of in zip(plan.workers, amount.tolist(), per.tolist()):
        yield Figure(kpi, worker.name, part, unit, one / of if of > 0 else np.nan)


def repetitions(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """repetitions_per_min : of each worker, how often he begins a performance of any task (no part), and of the task
    that he does most (``most``), a minute of the time he works; a function of the rows alone."""
    rows = begun(log)
    rows = rows[in_window(log["start_s"][rows], plan)]
    worked = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0))
    minutes = np.bincount(log["worker"][worked], inside_s(log, worked, plan), len(plan.workers)) / 60.0
    for rank, worker in enumerate(plan.workers):
        times = np.bincount(log["task"][rows][log["worker"][rows] == rank], minlength=len(plan.tasks))
        per = minutes[rank] if minutes[rank] > 0 else np.nan
        yield Figure(REPETITIONS, worker.name, "", "1/min", times.sum() / per)
        yield Figure(REPETITIONS, worker.name, "most", "1/min", times.max() / per)


def sentences(figures: dict[tuple[str, str, str], float]) -> Iterator[str]:
    """Who holds what beyond ISO 11226 and EN 1005-4, from (kpi, subject, part) -> value."""
    for standard, kpi in (("ISO 11226", "iso_11226_min_per_h"), ("EN 1005-4", "en_1005_4_min_per_h")):
        found = [(value, who, part) for (name, who, part), value in figures.items() if name == kpi and who]
        for value, who, part in sorted(found, reverse=True):
            if value >= 0.1:
                yield f"{who}: {value:.1f} min/h beyond {standard} ({part.replace('_', ' ')})."
