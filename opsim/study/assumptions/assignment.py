"""What the assumption sheet says of who does what: zones, floaters, priorities, qualities, shared work.

What the sheet says of job rotation.

What the sheet says of crews.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from opsim.plan import Plan
from opsim.plan.compile import LEAST_EXPOSED
from opsim.plan.lines import BUCKET_BRIGADE
from opsim.plan.workers import IN_TURN, RotationPlan
from opsim.problems import listed

if TYPE_CHECKING:
    from opsim.scenario.read import Loaded

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


def rotations(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of each rotation."""
    new = ", and nobody is slower for being new at a post" if plan.human.learning is None else ""
    for rotation in plan.rotations:
        names = listed([plan.workers[worker].name for worker in rotation.workers])
        yield (
            "rotation",
            f"{rotation.name}: {names} share {len(rotation.posts)} posts, and change {_when(rotation)}, "
            f"{_who(rotation)}; what was begun is finished at the old post, a change takes no time but the walk{new}",
        )


def _when(rotation: RotationPlan) -> str:
    if rotation.every_s is not None:
        return f"every {rotation.every_s / 3600:g} h from the start of the run, work time or not"
    if rotation.after == 1:
        return "after every operation at one of the posts"
    return f"when {rotation.after} operations were done at one of the posts, by whomever"


def _who(rotation: RotationPlan) -> str:
    if rotation.rule == IN_TURN:
        return "each to the next post"
    if rotation.rule == "least_time":
        return "a post going to who was there for the shortest time so far, breaks included"
    if rotation.rule == LEAST_EXPOSED:
        return "the heaviest post going to whose body has gone through least so far"
    return f"by the rule {rotation.rule}"


_HOW_CREWS_SHARE = {
    True: "who comes back takes over the job of the one before him where it is, with a time of his own for what is "
    "left of the task; handing over takes no time",
    False: "everybody goes with his job to the end of the line, and straight back to its start",
}


def crews(loaded: Loaded, plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of each crew."""
    for crew in plan.crews:
        names = [plan.workers[worker].name for worker in crew.workers]
        yield "crews", f"{crew.name}: {listed(names)}, in this order; {_HOW_CREWS_SHARE[crew.kind == BUCKET_BRIGADE]}"
        stations = [plan.stations[rank] for rank in crew.stations]
        wide = [station.name for station in stations if station.servers > 1]
        if wide:
            yield "crews", f"{listed(wide)}: side by side somebody may be further in a task, nobody leaves out of turn"
        yield from _others(loaded.scenario.workers, crew.name, names, {station.name for station in stations})


def _others(workers, crew: str, members: list[str], stations: set[str]) -> Iterator[tuple[str, str]]:
    """Skills that count for nothing: at the stations of a crew its members work, and they work nowhere else."""
    able = [name for name, worker in workers.items() if name not in members and not stations.isdisjoint(worker.skills)]
    if able:
        yield "crews", f"{listed(able)}: could work at stations of {crew} as well, and never do: no members"
    elsewhere = [name for name in members if set(workers[name].skills) - stations]
    if elsewhere:
        yield "crews", f"{listed(elsewhere)}: could work elsewhere as well, and never do: members of {crew}"
