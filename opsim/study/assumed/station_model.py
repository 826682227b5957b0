"""What the sheet says of the blocks of the station model that a scenario uses, and which of them it does not."""

from collections.abc import Iterator
from itertools import pairwise
from math import inf

from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.sequence import FIFO, FINISH_FIRST
from opsim.plan.station import STORE

Line = tuple[str, str]


def station_model(plan: Plan) -> Iterator[Line]:
    """(topic, what is assumed) of all of them, most weighty first."""
    yield from _absent(plan)
    for part in (_setups, _queues, _rooms, _assembly, _batches, _quality, _tools):
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


def _setups(plan: Plan) -> Iterator[Line]:
    if plan.setups:
        alone = [plan.stations[one.station].name for one in plan.setups if not one.attended]
        who = f"; at {listed(alone)} without a worker" if alone else ""
        where = listed([plan.stations[one.station].name for one in plan.setups])
        yield (
            "set-ups",
            f"{where}: a server is set up when its next job is on it, not before, and stays so{who}",
        )


def _queues(plan: Plan) -> Iterator[Line]:
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


def _rooms(plan: Plan) -> Iterator[Line]:
    first = [place.name for place in plan.stations if place.place_first]
    if first:
        yield "blocking", f"{listed(first)}: a job is begun only when its place downstream is kept for it"
    stores = [place.name for place in plan.stations if place.kind == STORE and place.buffer == inf]
    if stores:
        yield "buffers", f"unlimited in {listed(stores)}"


def _assembly(plan: Plan) -> Iterator[Line]:
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


def _batches(plan: Plan) -> Iterator[Line]:
    for batch in plan.batches:
        name = plan.stations[batch.station].name
        wait = (
            "and waits until it is full" if batch.most_wait_s == inf else f"and waits at most {batch.most_wait_s:g} s"
        )
        yield "batches", f"{name}: {batch.size} jobs at once, {wait}; the time is that of one, however many there are"


def _quality(plan: Plan) -> Iterator[Line]:
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


def _tools(plan: Plan) -> Iterator[Line]:
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
