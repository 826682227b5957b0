"""Lifting indices by the revised NIOSH equation: of tasks with a load, and composite of those who lift."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.ergonomics.strain.lifting import Indices, composite_of, indices, too_often
from opsim.ergonomics.strain.lifts import Lifted, Lifts, loads_kg
from opsim.kpi.figure import Figure
from opsim.log import EventLog
from opsim.plan import Plan

PARTS = ("", "at_most")
INDEX, COMPOSITE, OUT_OF_RANGE = "lifting_index", "composite_lifting_index", "lifts_out_of_range_share"


def lifting(found: Lifted, log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of lifts and lowers in the window whose postures are known, at least and (part ``at_most``) at most:

    lifting_index : of each task with a load, over its lifts: the mean, and the most of any (part ``most``); nan for a
        task in which nothing goes up or down by 10 cm, and for one that is done sitting. Above 1 fewer and fewer people
        can, beyond 3 many are hurt
    composite_lifting_index : of each worker, 0 where he lifts nothing, nan where he lifts sitting only; part ``worst``
        without a subject: the worst of them
    lifts_per_h : of each task, all workers together, of an hour of the window
    lifts_out_of_range_share : lifts beyond the equation's range, for which the edge of the range stands, or that are
        done sitting; of a worker all of them, where all he lifts together may be more often than its table knows.
        Where it is not 0, at_most is no bound
    """
    lifts = found.lifts()
    each = indices(lifts, plan)
    hours = (plan.window_s[1] - plan.window_s[0]) / 3600.0
    for task in np.flatnonzero(loads_kg(plan) > 0).tolist():
        own, name = lifts.task == task, plan.tasks[task].name
        for side, part in enumerate(PARTS):
            yield Figure(INDEX, name, part, "1", each.index[own, side].mean() if own.any() else np.nan)
        yield Figure(INDEX, name, "most", "1", each.index[own, 1].max() if own.any() else np.nan)
        yield Figure("lifts_per_h", name, "", "1/h", own.sum() / hours)
        share = each.out_of_range[own].mean() if own.any() else np.nan
        yield Figure(OUT_OF_RANGE, name, "", "share", share)
    yield from _composite(lifts, each, plan)


def _composite(lifts: Lifts, each: Indices, plan: Plan) -> Iterator[Figure]:
    found = np.zeros((len(plan.workers), 2))
    for rank, worker in enumerate(plan.workers):
        rows = np.flatnonzero(lifts.worker == rank)
        own = each.some(rows)
        found[rank] = composite_of(lifts.some(rows), own, plan)
        for part, value in zip(PARTS, found[rank].tolist()):
            yield Figure(COMPOSITE, worker.name, part, "1", value)
        share = 1.0 if too_often(lifts.some(rows), plan) else own.out_of_range.mean() if rows.size else np.nan
        yield Figure(OUT_OF_RANGE, worker.name, "", "share", share)
    worst = np.nanmax(found[:, 0]) if np.isfinite(found[:, 0]).any() else np.nan
    yield Figure(COMPOSITE, "", "worst", "1", float(worst))


def sentences(figures: dict[tuple[str, str, str], float]) -> Iterator[str]:
    """Who lifts, in which task, beyond what the equation recommends, from (kpi, subject, part) -> value.

    A figure that is nan has no sentence here; the assumption sheet names the tasks that are done sitting.
    """
    for (kpi, subject, part), low in figures.items():
        if kpi not in (INDEX, COMPOSITE) or part or not subject:
            continue
        high = figures.get((kpi, subject, "at_most"), low)
        what = f"In {subject} the load is" if kpi == INDEX else f"All that {subject} lifts together comes to"
        least, most = f"{low:.1f}", f"{high:.1f}"
        between = least if least == most else f"{least} to {most}"
        beyond = _beyond(figures.get((OUT_OF_RANGE, subject, ""), 0.0))
        if low > 1:
            yield f"{what} {between} times the recommended limit (NIOSH){beyond}."
        elif high > 1:
            yield f"{what} up to {most} times the recommended limit (NIOSH), depending on what nobody said{beyond}."


def _beyond(share: float) -> str:
    """What is to be known of lifts that the equation has no number for."""
    if not share > 0:
        return ""
    return f"; {max(share, 0.01):.0%} of lifts are beyond the equation's range, whose edge stands for them: no bound"
