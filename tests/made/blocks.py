"""The blocks of the language, each put into a made floor with whole-second times and keys drawn at random.

Every function takes a floor, adds one block, and does nothing where the floor has no room for it.
"""

from __future__ import annotations

from collections.abc import Callable

from made.floors import Floor
from made.stations import (
    attended,
    blocking_before,
    breakdowns,
    buffer_after,
    carrying,
    conveyor,
    fixtures,
    maintenance,
    priorities,
    quality,
    queue_rule,
    setup,
    task_tools,
    teams,
    transporter,
)


def schedule(floor: Floor) -> None:
    if floor.mains == ["q0"]:
        floor.main = {"kind": "schedule", "file": "orders.csv"}
        floor["sources"]["again"] = {"kind": "renewal", "every": {"fixed": "40 s"}, "products": ["q0"]}


def sequence(floor: Floor) -> None:
    if len(floor.mains) == 2:
        floor.main["sequence"] = floor.pick.one_of([["q0", "q0", "q1"], ["q1", "q0"], "mix.csv"])
        floor["sources"]["more"] = {"kind": "poisson", "every": "90 s", "products": ["q0"]}


def at_once(floor: Floor) -> None:
    if floor.main["kind"] in ("poisson", "renewal"):
        floor.main["at_once"] = floor.pick.whole(2, 4)


def several_sources(floor: Floor) -> None:
    other = floor.pick.one_of([{"kind": "poisson", "every": "15 s"}, {"kind": "renewal", "every": {"fixed": "12 s"}}])
    floor["sources"]["other"] = {**other, "products": [floor.pick.one_of(floor.mains)]}


def conwip(floor: Floor) -> None:
    floor["cards"]["conwip"] = {"n": floor.pick.whole(2, 6)}


def kanban(floor: Floor) -> None:
    """Cards between two stations of a product; two loops that overlap are POLCA."""
    name = next(iter(floor.routed), None)
    if name is None:
        return
    route = [step for step in floor["products"][name]["route"] if isinstance(step, str)]
    spans = floor.pick.one_of([[(0, -1)], [(0, 1)], [(0, 1), (1, 2)], [(1, -1)]])
    for number, (a, b) in enumerate(spans):
        if b < len(route) and a < len(route):
            loop = {"n": floor.pick.whole(1, 4), "from": route[a], "to": route[b], "products": [name]}
            floor["cards"][f"loop{number}"] = loop


def assembly(floor: Floor) -> None:
    """A component with a source, a station and a store of its own goes into a main product."""
    pick, name = floor.pick, next(iter(floor.routed), None)
    if name is None:
        return
    at = next(step for step in floor["products"][name]["route"] if isinstance(step, str))
    station = floor.add_station("k0", servers=pick.whole(1, 2))
    floor["stores"]["rack"] = {"at": "p1", "capacity": pick.whole(2, 6), "initial": pick.whole(0, 2)}
    floor["products"]["c0"] = {"route": [station, "rack"]}
    floor["products"][name]["parts"] = {at: {"c0": pick.whole(1, 2)}}
    pull = {"kind": "base_stock", "store": "rack", "level": pick.whole(1, 3)}
    floor["sources"]["parts"] = pick.one_of([pull, {"kind": "saturated", "products": ["c0"]}])


def split(floor: Floor) -> None:
    """The last station of a main product makes two or three of another."""
    name = next(iter(floor.routed), None)
    if name is None or isinstance(floor["products"][name]["route"][-1], list):
        return
    station = floor.add_station("u0", servers=2)
    last = floor["products"][name]["route"][-1]
    if floor["products"][name]["route"].count(last) == 1:
        floor["products"]["b0"] = {"route": [station]}
        floor["products"][name]["split"] = {last: {"b0": floor.pick.whole(2, 3)}}
        floor["sources"].setdefault("more", {"kind": "poisson", "every": "90 s", "products": [name]})


def lots(floor: Floor) -> None:
    floor["products"][floor.pick.one_of(floor.mains)]["lot"] = floor.pick.whole(2, 3)
    floor["tasks"]["m"]["per"] = floor.pick.one_of(["lot", "unit"])


def batch(floor: Floor) -> None:
    batch = {"size": floor.pick.whole(2, 3), "of": floor.pick.one_of(["any", "product"]), "most_wait": "6 s"}
    floor.some_station.update(batch=batch, buffer=4, servers=floor.pick.whole(1, 2))


def choice(floor: Floor) -> None:
    """Which of several stations a job goes to."""
    if len(floor.stations) > 2 and floor.routed:
        for name in floor.routed:
            steps = floor.pick.shuffled(floor.stations)
            floor["products"][name] = {"route": [list(steps[:2]), *steps[2:]]}
        floor["flow"]["routing"] = floor.pick.one_of(["shortest_queue", "least_loaded", "first_free", "in_order"])


def passed(floor: Floor) -> None:
    """A point that is passed: a station without tasks."""
    if floor.routed:
        floor["products"][floor.routed[0]]["route"].append(floor.add_station("x0", tasks=[]))


BLOCKS: dict[str, Callable[[Floor], None]] = {
    block.__name__: block
    for block in (
        *(choice, passed, schedule, sequence, at_once, several_sources, conwip, kanban, assembly, split, lots, batch),
        *(buffer_after, blocking_before, queue_rule, priorities, setup, fixtures, task_tools, breakdowns),
        *(maintenance, quality, teams, attended, conveyor, transporter, carrying),
    )
}
"""By name, in the order in which they are put in: what changes ways comes first."""


def floor_with(pick, wanted: list[str]) -> dict:
    """A made scenario with some of the blocks, as values."""
    floor = Floor(pick)
    for name, put in BLOCKS.items():
        if name in wanted:
            put(floor)
    return floor.values
