"""Energy that work costs, and the rest that it asks for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from opsim.ergonomics.shift.carried import carried_kg, carries
from opsim.ergonomics.strain.energy import Energy, Spent, energy
from opsim.ergonomics.strain.hold_shares import hold_share
from opsim.ergonomics.strain.rest_allowance import (
    STANDARD_KCAL_PER_MIN,
    murrell_rest_share,
    of_whole,
    price_relaxation,
    rohmert_rest_share,
)
from opsim.ergonomics.strain.still import Still
from opsim.kpi.duty import present_s
from opsim.kpi.figure import Figure
from opsim.kpi.values import inside_s
from opsim.log import BREAK, WALK, EventLog
from opsim.plan import Plan
from opsim.walks import walk_rows

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
        yield Figure(ENERGY, "", part, "kcal/min", together[side])
        for worker, value in zip(plan.workers, each[:, side].tolist()):
            yield Figure(ENERGY, worker.name, part, "kcal/min", value)
    yield Figure(ENERGY, "", "worst", "kcal/min", _most(each[:, 0]))


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
            yield Figure(REST, worker.name, part, "share", float(value))


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


def sentences(
    figures: dict[tuple[str, str, str], float], breaks_share: dict[str, float] | None = None
) -> Iterator[str]:
    """Whose work asks for rest, from (kpi, subject, part) -> value; breaks_share : share of his time each one has."""
    for (kpi, subject, part), value in figures.items():
        if kpi == REST and part in ("murrell", "price", "rohmert") and value >= 0.01:
            why = "what is held still" if part == "rohmert" else "the energy of the work"
            has = "" if breaks_share is None else f"; his breaks are {breaks_share.get(subject, 0.0):.0%}"
            yield f"{subject}: {value:.0%} of the time should be rest for {why} ({part.capitalize()}){has}."
