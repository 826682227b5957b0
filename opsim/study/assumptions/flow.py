"""How jobs come in and what holds them back, as lines of the assumption sheet.

What the sheet says of the blocks of the station model that a scenario uses, and which of them it does not.

What is assumed of stations that break down or are maintained.

What the sheet says of paced lines.

What the assumption sheet says of the flow of material: transport, stations, allocation, buffers, release.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING

from opsim.plan import LinePlan, Plan
from opsim.plan.resources import BUSY, CLOCK, CYCLES, NO_TEAM
from opsim.plan.sequence import FIFO, FINISH_FIRST
from opsim.plan.sources import BASE_STOCK, INSIDE, POISSON, RENEWAL, SATURATED, SCHEDULE, SourcePlan
from opsim.plan.stations import STATION, STORE
from opsim.problems import listed
from opsim.study.assumptions.assignment import assignment, crews, qualities
from opsim.study.assumptions.people import Line

if TYPE_CHECKING:
    from opsim.scenario.read import Loaded

_HOW = {POISSON: "at random (Poisson)", RENEWAL: "with gaps of their own distribution (renewal)"}


def released(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of each source, and of the loops of cards."""
    sources = [source for source in plan.sources if source.kind != INSIDE]
    for source in sources:
        said = _released_how(plan, source)
        if said:
            yield "release", said if len(sources) == 1 else f"{source.name}: {said}"
    for card in plan.cards:
        who = [product.name for product, steps in zip(plan.products, card.steps) if steps]
        whose = "" if len(who) == len(plan.products) else f" of {listed(who)}"
        back = " or ".join(plan.stations[rank].name for rank in card.back)
        end = f"when it leaves {back}" if back else "on the way out"
        yield "cards", f"{card.name}: at most {card.n} jobs{whose} at once; a job gives its card back {end}, in no time"


def _released_how(plan: Plan, source: SourcePlan) -> str:
    if source.kind in _HOW:
        rate = f"jobs come {_HOW[source.kind]}, one every {source.every_s:g} s on average; none come in lots"
        several = f"{source.at_once} jobs come at once {_HOW[source.kind]}, every {source.every_s:g} s on average"
        return rate if source.at_once == 1 else several
    if source.kind == SCHEDULE:
        n_jobs, total = sum(order.quantity for order in source.orders), len(source.orders) + source.n_late
        late = f"; {source.n_late} of its {total} orders come at the horizon or later" if source.n_late else ""
        return f"{n_jobs} jobs come at the times of the file, none early or late{late}"
    if source.kind == BASE_STOCK:
        product, store = plan.products[source.mix[0][0]].name, plan.stations[source.store].name
        return (
            f"a {product} is begun whenever fewer than {source.level} are in {store} or on the way, less those wanted"
        )
    assert source.kind == SATURATED
    return "in the order of the sequence, again and again" if source.sequence else ""


def station_model(plan: Plan) -> Iterator[Line]:
    """(topic, what is assumed) of all of them, most weighty first."""
    yield from _absent(plan)
    for part in (
        assumed_setups,
        assumed_queues,
        assumed_buffers,
        assumed_assembly,
        assumed_batches,
        assumed_quality,
        assumed_tools,
    ):
        yield from part(plan)


def _absent(plan: Plan) -> Iterator[Line]:
    """What goes wrong on a real floor and not on this one."""
    inspected = [one for one in plan.quality if one.inspects]
    reworks = any(one.back for one in inspected)
    missing = [] if plan.setups else ["set-ups"]
    missing += [] if plan.stops else ["breakdowns"]
    missing += [] if plan.quality else ["scrap"]
    if reworks:
        rework = ""
    elif any(len(ways) > 1 for product in plan.products for ways in product.onward):
        rework = ", and rework only as the routing says" if missing else ""
    else:
        rework = " or rework" if missing else "no rework"
    named = " or ".join(missing) if len(missing) < 3 else "set-ups, breakdowns or scrap"
    if named or rework:
        yield "stations", (f"no {named}{rework}" if named else rework)


def assumed_setups(plan: Plan) -> Iterator[Line]:
    if plan.setups:
        alone = [plan.stations[one.station].name for one in plan.setups if not one.attended]
        who = f"; at {listed(alone)} without a worker" if alone else ""
        where = listed([plan.stations[one.station].name for one in plan.setups])
        yield (
            "set-ups",
            f"{where}: a server is set up when its next job is on it, not before, and stays so{who}",
        )


def assumed_queues(plan: Plan) -> Iterator[Line]:
    for rule in dict.fromkeys(queue.rule for queue in plan.queues if queue.rule != FIFO):
        where = listed([plan.stations[queue.station].name for queue in plan.queues if queue.rule == rule])
        yield "sequence", f"{where}: waiting jobs go by {rule.replace('_', ' ')}, higher priorities before it"
    for queue in plan.queues:
        name = plan.stations[queue.station].name
        if queue.preempt != FINISH_FIRST:
            then = "goes on where it was" if queue.preempt == "resume" else "begins its task anew"
            yield "sequence", f"{name}: a job of higher priority takes the server of a lower one, which {then} later"
    if plan.queues and all(queue.rule == FIFO for queue in plan.queues):
        yield "sequence", "higher priorities first, and first come, first served among equals"
    due = [product.name for product in plan.products if product.due_s < inf]
    if due:
        yield "sequence", f"{listed(due)}: due so long after they come in; a job that is late is made all the same"
    dated = [source.name for source in plan.sources if any(order.due_s < inf for order in source.orders)]
    if dated:
        instead = ", whatever their product's own due date" if due else ""
        yield "sequence", f"{listed(dated)}: orders are due when their file says, counted from the start{instead}"


def assumed_buffers(plan: Plan) -> Iterator[Line]:
    first = [place.name for place in plan.stations if place.place_first]
    if first:
        yield "blocking", f"{listed(first)}: a job is begun only when its place downstream is kept for it"
    stores = [place.name for place in plan.stations if place.kind == STORE and place.buffer == inf]
    if stores:
        yield "buffers", f"unlimited in {listed(stores)}"


def assumed_assembly(plan: Plan) -> Iterator[Line]:
    if plan.kits:
        where = listed(sorted({plan.stations[kit.station].name for kit in plan.kits}))
        yield (
            "parts",
            f"{where}: a job on its server takes all its parts at once, the oldest first; fetching takes no time",
        )
    if plan.splits:
        yield "parts", "pieces of a job that is split leave the server one by one, which is free when the last is gone"
    lots = [f"{product.name} ({product.lot})" for product in plan.products if product.lot > 1]
    if lots:
        yield "lots", f"{listed(lots)}: a lot moves as one, and is good or bad as one"


def assumed_batches(plan: Plan) -> Iterator[Line]:
    for batch in plan.batches:
        name = plan.stations[batch.station].name
        wait = (
            "and waits until it is full" if batch.most_wait_s == inf else f"and waits at most {batch.most_wait_s:g} s"
        )
        yield "batches", f"{name}: {batch.size} jobs at once, {wait}; the time is that of one, however many there are"


def assumed_quality(plan: Plan) -> Iterator[Line]:
    for one in plan.quality:
        name = plan.stations[one.station].name
        if one.yield_share < 1:
            yield "quality", f"{name}: {one.yield_share:.4g} of its operations leave no defect, each by chance alone"
        if one.inspects and (one.finds < 1 or one.false_alarms > 0):
            alarms = f", and {one.false_alarms:.4g} of good ones is held to be bad" if one.false_alarms else ""
            yield "quality", f"{name}: {one.finds:.4g} of bad jobs is found to be bad{alarms}"
        if one.back:
            often = "as often as it takes" if one.most == inf else f"at most {one.most:g} times, then it is scrap"
            yield (
                "quality",
                f"{name}: a job is reworked {often}; it is good then until an operation leaves a defect anew",
            )
    unseen = not any(one.inspects for one in plan.quality)
    if plan.quality and unseen:
        yield "quality", "nobody inspects: jobs with a defect go on and out, and are not counted as good"
    elif any(one.yield_share < 1 for one in plan.quality):
        yield "quality", "throughput counts good jobs only: one that leaves with a defect nobody found is not in it"


def assumed_tools(plan: Plan) -> Iterator[Line]:
    if plan.tools:
        yield "tools", "a tool is where it is needed at once; jobs take all they need together, the first that can"
    if any(task.needs for task in plan.tasks):
        yield "tools", "tools of a task are taken as its worker sets out, and put back when the work is broken off"
    attended = [task.name for task in plan.tasks if task.attended]
    if attended:
        yield "stations", f"{listed(attended)}: takes the station's time, whoever attends it and whatever his skill"
    teams = [task.name for task in plan.tasks if task.team > 1]
    if teams:
        yield "teams", f"{listed(teams)}: nobody comes before all can, and the slowest ends it; each has his own time"


def vehicles(plan: Plan) -> Iterator[Line]:
    """Of conveyors and transporters."""
    if plan.transporters:
        names = listed([pool.name for pool in plan.transporters])
        yield "transport", f"{names}: drivers and batteries always there; vehicles do not meet on the road"
        yield "transport", f"{names}: called when a job's next place is sure, oldest call first; never waits to fill"
    if plan.conveyors:
        names = listed([plan.stations[belt.station].name for belt in plan.conveyors])
        yield "transport", f"{names}: belts run all the time, and never break"


def by_themselves(plan: Plan) -> bool:
    """Whether some jobs pass from a station to another without anybody or anything that brings them."""
    brought = {(leg.before, leg.after) for pool in plan.transporters for leg in pool.legs}
    brought |= {pair for line in plan.lines for pair in pairwise(line.stations)}
    belts = {belt.station for belt in plan.conveyors}
    for product in plan.products:
        if not product.carried:
            for step, onward in zip(product.route, product.onward):
                ahead = {rank for _, to in onward if to >= 0 for rank in product.route[to].stations}
                pairs = {(here, there) for here in step.stations for there in ahead}
                if not pairs <= brought | {pair for pair in pairs if belts.intersection(pair)}:
                    return True
    return not any(len(product.route) > 1 for product in plan.products)


_COUNTED = {
    CLOCK: "while the station is up, in work or not",
    BUSY: "only while something is done there",
    CYCLES: "by operations, and it stops as the next one would begin",
}


def stopped(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of every kind of stop that the plan has."""
    for by, counted in _COUNTED.items():
        names = [one.name for one in plan.breakdowns if one.by == by]
        if names:
            yield "breakdowns", f"{listed(names)}: what leads to it counts {counted}"
    if plan.stops:
        yield (
            "breakdowns",
            "a stop stops all servers of a station; one stop at a time, and what falls due meanwhile follows; a "
            "station that stands neither wears nor breaks down",
        )
    for fate, words in (("restart", "begins anew, with a time of its own"), ("scrap", "is scrap")):
        names = [one.name for one in plan.breakdowns if one.job == fate]
        if names:
            yield "breakdowns", f"{listed(names)}: what was in work {words}"
    alone = [one.name for one in plan.stops if one.team == NO_TEAM]
    if alone:
        yield "breakdowns", f"{listed(alone)}: ends by itself after its time; no worker and no team is needed"
    if plan.repair_teams:
        yield "breakdowns", "a repair team comes without a walk, to the stop that waits longest; it knows no other work"


def lines(plan: Plan) -> Iterator[Line]:
    """(topic, what is assumed) of each paced line, most weighty first."""
    for line in plan.lines:
        yield "lines", f"{line.name}: {_late(line)}"
        yield "lines", f"{line.name}: {_moves(line)}"
        if line.floaters:
            names = listed([plan.workers[rank].name for rank in line.floaters])
            how = (
                "takes his own share of what is left, and both are done at once"
                if line.helps
                else "takes a time of his own for what is left, and whoever was there is free"
            )
            yield "lines", f"{line.name}: {names} only when called; who comes {how}"


def _late(line: LinePlan) -> str:
    if line.sends_on:
        return (
            "a job that is not done in time goes on as it is and is bad, whatever is missing; nobody makes up for it "
            "further down, and inspections find it as they find other defects"
        )
    return "while a job that should move on is worked on, the line stands and all other work goes on"


def _moves(line: LinePlan) -> str:
    if not line.moves:
        return "moving on takes no time; while it stands because of a station or a break, its clock stands too"
    return (
        f"jobs come every {line.takt_s:g} s at the earliest, and the line moves {line.speed_m_per_s:.4g} m/s at once "
        "or not at all; workers do not get into each other's way, walk straight to the next job, and whoever comes "
        "from elsewhere is at the beginning of a stretch first"
    )


_IDLE = {
    "stay": "stay where they are",
    "home": "walk home, and can be called again when they are there",
    "patrol": "walk round their stations and serve only where they stand",
}


def flow(loaded: Loaded, plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed), most weighty first."""
    yield from _transport(plan)
    yield from station_model(plan)
    yield from stopped(plan)
    if len(plan.workers) > sum(len(crew.workers) for crew in plan.crews):
        rule, blocked = plan.rule.replace("_", " "), plan.when_blocked
        chosen = "chosen" if "allocation.rule" in loaded.given else "default"
        yield "allocation", f"free workers go by {rule} ({chosen}); with a blocked job a worker is {blocked}"
        yield "allocation", f"idle workers {_IDLE[plan.idle]}"
        yield from assignment(plan)
        yield from qualities(plan)
    yield from crews(loaded, plan)
    yield from lines(plan)
    paced = {rank for line in plan.lines for rank in line.stations}
    stations = [one for rank, one in enumerate(plan.stations) if one.kind == STATION and rank not in paced]
    unlimited = [station.name for station in stations if station.buffer == float("inf")]
    if unlimited:
        yield "buffers", f"unlimited in front of {listed(unlimited)}"
    yield from released(plan)


def _transport(plan: Plan) -> Iterator[tuple[str, str]]:
    carried = [product.name for product in plan.products if product.carried]
    if carried:
        yield (
            "transport",
            f"whoever did the last task at a station carries {listed(carried)} to the next at walking speed, "
            "unhampered by the load, and waits with it while that is full; after an automatic task it passes without "
            "time",
        )
    yield from _limits(plan)
    yield from vehicles(plan)
    if len(carried) < len(plan.products) and by_themselves(plan):
        others = carried or plan.transporters or plan.conveyors
        yield "transport", f"{'other jobs' if others else 'jobs'} pass between stations without time"


def _limits(plan: Plan) -> Iterator[tuple[str, str]]:
    """What is carried at once, where workers or products say something about it."""
    carried = [product for product in plan.products if product.carried]
    limited = [worker.name for worker in plan.workers if worker.most_load_kg is not None]
    weighed = [product.name for product in carried if product.mass_kg is not None]
    if limited and weighed:
        yield (
            "transport",
            f"{listed(limited)}: as many walks as the load limit asks for, with whole pieces of {listed(weighed)}",
        )
    unweighed = [product.name for product in carried if product.mass_kg is None]
    if limited and unweighed:
        yield "transport", f"{listed(unweighed)}: no mass is given, and anybody carries all of a job at once"
    unlimited = [worker.name for worker in plan.workers if worker.most_load_kg is None]
    if weighed and unlimited:
        yield "transport", f"{listed(unlimited)}: no load limit is given; they carry all of a job at once"
