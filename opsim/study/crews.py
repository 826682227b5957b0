"""What the sheet says of crews."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.crews import BUCKET_BRIGADE, CrewPlan

_HOW = {
    True: "who comes back takes over the job of the one before him where it is, with a time of his own for what is "
    "left of the task; handing over takes no time",
    False: "everybody goes with his job to the end of the line, and straight back to its start",
}


def crews(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of each crew."""
    for crew in plan.crews:
        names = listed([plan.workers[worker].name for worker in crew.workers])
        yield "crews", f"{crew.name}: {names}, in this order; {_HOW[crew.kind == BUCKET_BRIGADE]}"
        wide = [plan.stations[rank].name for rank in crew.stations if plan.stations[rank].servers > 1]
        if wide:
            yield "crews", f"{listed(wide)}: side by side somebody may be further in a task, nobody leaves out of turn"
        yield from _others(plan, crew)


def _others(plan: Plan, crew: CrewPlan) -> Iterator[tuple[str, str]]:
    """Skills that count for nothing: at the stations of a crew its members work, and they work nowhere else."""
    able = [
        worker.name
        for rank, worker in enumerate(plan.workers)
        if rank not in crew.workers and any(worker.rating[station] > 0 for station in crew.stations)
    ]
    if able:
        yield "crews", f"{listed(able)}: could work at stations of {crew.name} as well, and never do: no members"
    elsewhere = [
        plan.workers[rank].name
        for rank in crew.workers
        if any(rating > 0 and at not in crew.stations for at, rating in enumerate(plan.workers[rank].rating))
    ]
    if elsewhere:
        yield "crews", f"{listed(elsewhere)}: could work elsewhere as well, and never do: members of {crew.name}"
