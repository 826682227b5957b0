"""The law of what is shared: no more tools, cards, repair teams or vehicles are in use than there are."""

from collections.abc import Iterator

import numpy as np

from opsim.laws.stays import Stays, peak
from opsim.log import REPAIR, TOOL, TRANSPORT, EventLog
from opsim.plan import Plan
from opsim.plan.card_ways import has_card
from opsim.plan.cards import CardPlan


def shared(log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """Everything that several ask for and only so many can have."""
    yield from _tools(log, plan)
    yield from _teams(log, plan)
    yield from _vehicles(log, plan)
    for card in plan.cards:
        found = _most_cards(stays.rows, plan, card)
        if found > card.n:
            yield f"loop {card.name}: {found} jobs in it at once on {card.n} cards"


def _tools(log: EventLog, plan: Plan) -> Iterator[str]:
    if not plan.tools:
        return
    held = log.of(TOOL)
    for rank, tool in enumerate(plan.tools):
        found = peak(held.where(held["k"] == rank))
        if found > tool.n:
            yield f"tool {tool.name}: {found} in use at once of {tool.n}"


def _teams(log: EventLog, plan: Plan) -> Iterator[str]:
    if not plan.repair_teams:
        return
    repairs = log.of(REPAIR)
    for rank, team in enumerate(plan.repair_teams):
        tasks = [stop.task for stops in (plan.breakdowns, plan.maintenance) for stop in stops if stop.team == rank]
        found = peak(repairs.where(np.isin(repairs["task"], tasks)))
        if found > team.n:
            yield f"repair team {team.name}: at {found} stops at once, and can see to {team.n}"


def _vehicles(log: EventLog, plan: Plan) -> Iterator[str]:
    """A vehicle does one thing at a time, and there are no others."""
    if not plan.transporters:
        return
    rows = log.where((log["kind"] == TRANSPORT) & (log["job"] < 0) & (log["worker"] < 0))
    n = sum(pool.n for pool in plan.transporters)
    if len(rows) and not 0 <= rows["k"].min() <= rows["k"].max() < n:
        yield f"vehicle {rows['k'].max()} drives, and there are {n}"
    for vehicle in np.unique(rows["k"]):
        if peak(rows.where(rows["k"] == vehicle)) > 1:
            yield f"vehicle {vehicle} does two things at once"


def _most_cards(rows: EventLog, plan: Plan, card: CardPlan) -> int:
    """The most jobs at once that were seen to have a card: from a point where one is taken until they left its end."""
    wanted = [rank for rank, steps in enumerate(card.steps) if steps]
    here = np.flatnonzero(np.isin(rows["product"], wanted) & (rows["station"] >= 0))
    here = here[np.argsort(rows["job"][here], kind="stable")]
    firsts = np.flatnonzero(np.diff(rows["job"][here], prepend=-1))
    has = np.zeros(here.size, dtype=bool)
    for first, last in zip(firsts, [*firsts[1:], here.size]):
        product = int(rows["product"][here[first]])
        has[first:last] = has_card(card, product, plan, rows["station"][here[first:last]].tolist())
    return peak(rows.where(here[has]))
