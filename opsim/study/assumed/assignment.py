"""What the assumption sheet says of who does what: zones, floaters, priorities, qualities, shared work."""

from collections.abc import Iterator

from opsim.names import listed
from opsim.plan import Plan

Line = tuple[str, str]


def assignment(plan: Plan) -> Iterator[Line]:
    """(topic, what is assumed) of all of them, most weighty first."""
    yield from _whose(plan)
    yield from _priorities(plan)
    yield from _shared(plan)
    if plan.idle == "patrol" and plan.serve == "one":
        yield "allocation", "who patrols does one operation at a stop, with all its tasks, and walks on"


def qualities(plan: Plan) -> Iterator[Line]:
    """Of those who leave defects of their own."""
    who = [
        f"{worker.name} at {plan.stations[rank].name} {quality:.4g}"
        for worker in plan.workers
        for rank, quality in enumerate(worker.quality)
        if quality < 1
    ]
    if who:
        yield (
            "quality",
            "shares of operations that workers leave without a defect are the scenario's own, not measured: "
            f"{listed(who)}; times the station's yield, each by chance alone; of several on an operation the lowest",
        )


def _whose(plan: Plan) -> Iterator[Line]:
    zones = [
        f"{worker.name} ({listed(plan.stations[rank].name for rank in worker.zone)})"
        for worker in plan.workers
        if worker.zone
    ]
    if zones:
        yield (
            "allocation",
            "own stations first, others only where none of these calls and nobody whose own it is, and no floater, is "
            "free: " + listed(zones),
        )
    floaters = [worker.name for worker in plan.workers if worker.floater]
    if floaters:
        yield (
            "allocation",
            f"{listed(floaters)}: sent only where nobody is free whose own station it is, but before others leave "
            "their zones",
        )


def _priorities(plan: Plan) -> Iterator[Line]:
    ranked = [f"{station.name} ({station.priority})" for station in plan.stations if station.priority]
    for what in plan.priorities:
        if what == "stations" and ranked:
            yield "allocation", f"stations of a higher priority are served first, before the rule: {listed(ranked)}"
        elif what == "products" and any(product.priority for product in plan.products):
            yield "allocation", "where jobs of a higher priority call, workers go first, before the rule"


def _shared(plan: Plan) -> Iterator[Line]:
    for share in plan.shares:
        here, there = plan.stations[share.station].name, plan.stations[share.partner].name
        tasks = listed(plan.tasks[task].name for task in share.tasks)
        filled = "its buffer is full" if share.filled == 1 else "at least half of its buffer is taken"
        yield (
            "stations",
            f"{tasks}: done at {here} where {there} has no free server and {filled}, else at {there}; what was begun "
            "is finished where it was begun",
        )
