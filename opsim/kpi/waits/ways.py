"""What each job that waits could go on with: the ways out of its waiting."""

from collections.abc import Mapping, Sequence

from opsim import log as states
from opsim.kpi.waits.fills import ways_to_fill
from opsim.kpi.waits.graph import Pool, Way
from opsim.kpi.waits.inside import Inside
from opsim.kpi.waits.parts import missing_parts
from opsim.kpi.waits.pools import next_steps, wanted
from opsim.log import BLOCKED, HELD, QUEUE, TRANSPORT
from opsim.plan import Plan
from opsim.plan.assembly import jobs_on_a_server
from opsim.plan.station import CONVEYOR


def ways_of(one: Inside, plan: Plan, inside: Sequence[Inside], pools: Mapping[str, Pool]) -> tuple[Way, ...] | None:
    """The ways out; None where a job waits for nothing that other jobs have."""
    if one.kind == HELD:
        return _held(one, plan, inside, pools)
    if one.kind == BLOCKED or one.waits(QUEUE, states.AFTER):
        return _onward(one, plan, pools)
    if plan.stations[one.station].kind == CONVEYOR and one.kind in (QUEUE, TRANSPORT):
        return (((f"server {one.station}", 1),),)
    if one.waits(QUEUE, states.STOCK):
        return (((f"taker {one.product}", 1),),)
    if one.waits(QUEUE, states.BATCH):
        return ways_to_fill(one, plan, inside)
    if one.kind == QUEUE and one.cause != states.PICKUP:
        return (((f"server {one.station}", 1),),)
    return None


def _held(one: Inside, plan: Plan, inside: Sequence[Inside], pools: Mapping[str, Pool]) -> tuple[Way, ...] | None:
    if one.cause == states.NO_WORKER:
        return (((f"hands {one.station}", 1),),)
    if one.cause == states.NO_PLACE:
        return _kept(one, plan, pools)
    if one.cause == states.NO_PARTS:
        return (tuple((pool, 1) for pool in missing_parts(one, plan, inside)),)
    if one.cause == states.NO_TOOL:
        return (tuple((f"tool {tool}", n) for tool, n in _tools(one, plan)),)
    if one.cause == states.BATCH:
        return (((f"leader {one.station}", 1),),)
    return None


def _tools(one: Inside, plan: Plan) -> tuple[tuple[int, int], ...]:
    """What a job waits for: what its task needs, or holds, or else what the station needs."""
    if one.task < 0:
        return plan.stations[one.station].needs
    task = plan.tasks[one.task]
    return task.needs if task.hold is None else ((task.hold.tool, 1),)


def _kept(one: Inside, plan: Plan, pools: Mapping[str, Pool]) -> tuple[Way, ...] | None:
    """A place at the next station. Where the way is drawn, it is to none that has room: that it would have by now."""
    ways = [((f"room {rank}", 1),) for step in next_steps(plan, one) for rank in _full(plan, one, step, pools)]
    cards = [_cards(one, plan, (step,), pools) for step in next_steps(plan, one)]
    return tuple(ways) or tuple(card for card in cards if card) or None


def _full(plan: Plan, one: Inside, step: int, pools: Mapping[str, Pool]) -> tuple[int, ...]:
    """The stations of a step, where none of them has room."""
    stations = plan.products[one.product].route[step].stations
    return () if any(pools[f"room {rank}"].free for rank in stations) else stations


def _onward(one: Inside, plan: Plan, pools: Mapping[str, Pool]) -> tuple[Way, ...] | None:
    """A place at one of the stations of the operation it wants, and the cards that this takes; or a place after."""
    stations = wanted(plan, one.operation)
    lacks_card = one.cause == states.NO_CARD
    alone = one.kind == BLOCKED and jobs_on_a_server(plan, one.station) == 1
    if one.station in stations and not lacks_card and alone:
        return None  # it may always take its own place again, where it shares it with nobody
    steps = [at for at, step in enumerate(plan.products[one.product].route) if step.name == one.operation]
    cards = _cards(one, plan, steps, pools) if lacks_card else ()
    ways: tuple[Way, ...] = (cards,) if lacks_card else tuple(((f"room {rank}", 1),) for rank in stations)
    after = plan.stations[one.station].buffer_after and one.kind == BLOCKED
    return (*ways, ((f"after {one.station}", 1),)) if after else ways


def _cards(one: Inside, plan: Plan, steps: Sequence[int], pools: Mapping[str, Pool]) -> Way:
    """The cards that a job has to take before some steps, and does not have."""
    return tuple(
        (f"card {rank}", 1)
        for rank, card in enumerate(plan.cards)
        if set(steps).intersection(card.steps[one.product]) and one.name not in pools[f"card {rank}"].holders
    )
