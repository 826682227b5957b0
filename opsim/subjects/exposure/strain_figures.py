"""Energy that work costs, and the rest that it asks for.

Postures held still, movements a minute, repetition, and the limits of ISO 11226 and EN 1005-4 over the shift.

Lifting indices by the revised NIOSH equation: of tasks with a load, and composite of those who lift.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from opsim.ergonomics.shift.walks import carried_kg, carries
from opsim.ergonomics.strain.energy import (
    STANDARD_KCAL_PER_MIN,
    Energy,
    Spent,
    energy,
    murrell_rest_share,
    of_whole,
    price_relaxation,
    rohmert_rest_share,
)
from opsim.ergonomics.strain.lifting import Indices, Lifted, Lifts, composite_of, indices, loads_kg, too_often
from opsim.ergonomics.strain.posture_limits import ISO_11226, NOT_RECOMMENDED, ZONED, Still, begun, judged_static
from opsim.ergonomics.strain.static_holds import REGIONS, hold_share
from opsim.history import walk_rows
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, in_window, inside_s
from opsim.log import BREAK, SETUP, WALK, WORK, EventLog
from opsim.plan import Plan
from opsim.subjects.shifts.figures import present_s

ENERGY, REST = "energy_kcal_per_min", "rest_allowance_share"
PARTS = ("", "at_most")
LEANING = ("trunk", "left_arm", "right_arm")


class Resting:
    """A fold for rest allowances: what is spent, and what is held."""

    def __init__(self, plan: Plan):
        self.spent, self.still = Spent(plan), Still(len(plan.workers), plan.start_s)

    def add(self, frames: Any, scores: Any = None) -> None:
        """The next stretch."""
        self.spent.add(frames)
        self.still.add(frames)


def energy_spent(spent: Spent, log: EventLog, plan: Plan) -> Iterator[Figure]:
    """energy_kcal_per_min : of each worker, over the time in which he is there, breaks included, at least and
    (``at_most``) with light work of both arms whenever he works without a load, with the body's part of every bend
    without one, and with what may be in his hands; without a subject, of all together, and
    of the one who spends most (``worst``)."""
    found = _energy(spent, log, plan)
    minutes = found.work_min + found.break_min
    together = (found.work_kcal + found.break_kcal[:, None]).sum(axis=0) / (minutes.sum() or np.nan)
    each = found.kcal_per_min
    for side, part in enumerate(PARTS):
        yield figure(ENERGY, "", part, together[side])
        for worker, value in zip(plan.workers, each[:, side].tolist()):
            yield figure(ENERGY, worker.name, part, value)
    yield figure(ENERGY, "", "worst", _most(each[:, 0]))


def rest_allowances(resting: Resting, log: EventLog, plan: Plan) -> Iterator[Figure]:
    """rest_allowance_share : of each worker, the share of his time at work (there, and in no break) together with the
    rest that it asks for, which should be rest; one base for all

    murrell, price : for the energy of his work, at least; murrell_at_most, price_at_most : at most
    rohmert : for what his back and shoulders hold still out of neutral, whichever asks for most
    """
    spent = _energy(resting.spent, log, plan)
    rate, rohmert = spent.work_kcal_per_min, _rohmert(resting.still, 60.0 * spent.work_min, plan)
    for rank, worker in enumerate(plan.workers):
        standards = [STANDARD_KCAL_PER_MIN[sex] for sex in ("mm", "ff", "mf")[_known(worker.body.sex)]]
        values = {
            "murrell": murrell_rest_share(rate[rank, 0], standards[0]),
            "murrell_at_most": murrell_rest_share(rate[rank, 1], standards[1]),
            "price": of_whole(price_relaxation(rate[rank, 0])),
            "price_at_most": of_whole(price_relaxation(rate[rank, 1])),
            "rohmert": rohmert[rank],
        }
        for part, value in values.items():
            yield figure(REST, worker.name, part, float(value))


def _energy(spent: Spent, log: EventLog, plan: Plan) -> Energy:
    times_s = present_s(log, plan), _spent_s(log, plan, BREAK), _spent_s(log, plan, WALK)
    return energy(spent, *times_s, plan, list(_carried(log, plan)))


def _carried(log: EventLog, plan: Plan) -> Iterator[tuple[int, float, float]]:
    """(worker, kilograms, seconds in the window) of walks with a job whose mass is told."""
    rows = walk_rows(log)
    rows = rows[carries(log, plan, rows)]
    worker, product, seconds = log["worker"][rows], log["product"][rows], inside_s(log, rows, plan)
    for rank, which in sorted(set(zip(worker.tolist(), product.tolist()))):
        kg = carried_kg(plan, rank, which)
        if kg:
            yield rank, kg, float(seconds[(worker == rank) & (product == which)].sum())


def _spent_s(log: EventLog, plan: Plan, kind: int) -> np.ndarray:
    """(W,) seconds of the window in one state."""
    rows = np.flatnonzero((log["kind"] == kind) & (log["worker"] >= 0))
    return np.bincount(log["worker"][rows], weights=inside_s(log, rows, plan), minlength=len(plan.workers))


def _known(sex: str | None) -> int:
    return {"m": 0, "f": 1}.get(sex or "", 2)


def _rohmert(still: Still, work_s: np.ndarray, plan: Plan) -> np.ndarray:
    """(W,) rest that holding asks for, as a share of the seconds at work (W,) and that rest together."""
    rest_s = np.zeros((len(plan.workers), len(LEANING)))
    runs = still.close()
    for place, region in enumerate(LEANING):
        own = runs[region]
        for rank, worker in enumerate(plan.workers):
            mine = own.worker == rank
            share = hold_share(region, own.angle_deg[mine], worker.body)
            rest_s[rank, place] = own.seconds[mine] @ rohmert_rest_share(own.seconds[mine] / 60.0, share)
    return of_whole(rest_s.max(axis=1) / np.where(work_s > 0, work_s, np.nan))


def _most(values: np.ndarray) -> float:
    return float(np.nanmax(values)) if np.isfinite(values).any() else float("nan")


def energy_sentences(
    figures: dict[tuple[str, str, str], float], breaks_share: dict[str, float] | None = None
) -> Iterator[str]:
    """Whose work asks for rest, from (kpi, subject, part) -> value; breaks_share : share of his time each one has."""
    for (kpi, subject, part), value in figures.items():
        if kpi == REST and part in ("murrell", "price", "rohmert") and value >= 0.01:
            why = "what is held still" if part == "rohmert" else "the energy of the work"
            has = "" if breaks_share is None else f"; his breaks are {breaks_share.get(subject, 0.0):.0%}"
            yield f"{subject}: {value:.0%} of the time should be rest for {why} ({part.capitalize()}){has}."


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
        yield figure("longest_hold_s", "", region, longest.max())
        for worker, value in zip(plan.workers, longest.tolist()):
            yield figure("longest_hold_s", worker.name, region, value)
    for place, region in enumerate(ZONED):
        minutes = still.not_acceptable_s[:, place] / 60.0
        yield from _each("en_1005_4_min_per_h", region, minutes, there_s / SECONDS_PER_HOUR, plan)
        if region in ("trunk", "left_arm", "right_arm"):
            known_min = still.known_s[:, place] / 60.0
            yield from _each("movements_per_min", region, still.moves[:, place], known_min, plan)
    yield from repetitions(log, plan)


def _each(kpi: str, part: str, amount: np.ndarray, per: np.ndarray, plan: Plan) -> Iterator[Figure]:
    """All together, and each worker."""
    yield figure(kpi, "", part, amount.sum() / (per.sum() or np.nan))
    for worker, one, of in zip(plan.workers, amount.tolist(), per.tolist()):
        yield figure(kpi, worker.name, part, one / of if of > 0 else np.nan)


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
        yield figure(REPETITIONS, worker.name, "", times.sum() / per)
        yield figure(REPETITIONS, worker.name, "most", times.max() / per)


def hold_sentences(figures: dict[tuple[str, str, str], float]) -> Iterator[str]:
    """Who holds what beyond ISO 11226 and EN 1005-4, from (kpi, subject, part) -> value."""
    for standard, kpi in (("ISO 11226", "iso_11226_min_per_h"), ("EN 1005-4", "en_1005_4_min_per_h")):
        found = [(value, who, part) for (name, who, part), value in figures.items() if name == kpi and who]
        for value, who, part in sorted(found, reverse=True):
            if value >= 0.1:
                yield f"{who}: {value:.1f} min/h beyond {standard} ({part.replace('_', ' ')})."


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
            yield figure(INDEX, name, part, each.index[own, side].mean() if own.any() else np.nan)
        yield figure(INDEX, name, "most", each.index[own, 1].max() if own.any() else np.nan)
        yield figure("lifts_per_h", name, "", own.sum() / hours)
        share = each.out_of_range[own].mean() if own.any() else np.nan
        yield figure(OUT_OF_RANGE, name, "", share)
    yield from _composite(lifts, each, plan)


def _composite(lifts: Lifts, each: Indices, plan: Plan) -> Iterator[Figure]:
    found = np.zeros((len(plan.workers), 2))
    for rank, worker in enumerate(plan.workers):
        rows = np.flatnonzero(lifts.worker == rank)
        own = each.some(rows)
        found[rank] = composite_of(lifts.some(rows), own, plan)
        for part, value in zip(PARTS, found[rank].tolist()):
            yield figure(COMPOSITE, worker.name, part, value)
        share = 1.0 if too_often(lifts.some(rows), plan) else own.out_of_range.mean() if rows.size else np.nan
        yield figure(OUT_OF_RANGE, worker.name, "", share)
    worst = np.nanmax(found[:, 0]) if np.isfinite(found[:, 0]).any() else np.nan
    yield figure(COMPOSITE, "", "worst", float(worst))


def lifting_sentences(figures: dict[tuple[str, str, str], float]) -> Iterator[str]:
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
