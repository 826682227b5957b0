"""What the sheet says of crews."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.crews import BUCKET_BRIGADE

_HOW = {
    True: "who comes back takes over the job of the one before him where it is, with a time of his own for what is "
    "left of the task; handing over takes no time",
    False: "everybody goes with his job to the end of the line, and straight back to its start",
}


def crews(loaded, plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of each crew."""
    for crew in plan.crews:
        names = [plan.workers[worker].name for worker in crew.workers]
        yield "crews", f"{crew.name}: {listed(names)}, in this order; {_HOW[crew.kind == BUCKET_BRIGADE]}"
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
