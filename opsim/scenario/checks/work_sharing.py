"""Work that two stations share: the second follows the first on every way, and both have work of their own."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.references import named
from opsim.scenario.checks.ways import one_of, onward
from opsim.scenario.positions import Node, Part, child, entries, items, problem
from opsim.scenario.schema.routing import START


def sharing_problems(tree: Node) -> Iterator[Problem]:
    """Shares whose tasks or stations do not fit together."""
    stations = entries(tree, "stations")
    takers: dict[str, str] = {}
    for name, station in stations.items():
        share, path = child(station, "share"), ("stations", name, "share")
        if not entries(share):
            continue
        yield from _tasks(tree, name, station, path)
        partner = child(share, "with")
        yield from named(partner, stations, "station", (*path, "with"))
        if partner is None or not isinstance(partner.value, str) or partner.value not in stations:
            continue
        if partner.value == name:
            yield problem(partner.place, (*path, "with"), f"{name} shares work with itself", "name the next station")
            continue
        first = takers.setdefault(partner.value, name)
        if first != name:
            found = f"{first} shares work with {shown(partner.value)} already"
            yield problem(partner.place, (*path, "with"), found, "one station shares with it, and may share more tasks")
        yield from _partner(stations, name, partner, (*path, "with"))
        yield from _ways(tree, name, partner, (*path, "with"))


def _tasks(tree: Node, name: str, station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    """What is shared are the station's last tasks, and not all of them; neither needs the other's batch."""
    here = [task.value for task in items(station, "tasks")]
    nodes = items(station, "share", "tasks")
    shared = [task.value for task in nodes]
    for number, node in enumerate(nodes):
        yield from named(node, entries(tree, "tasks"), "task", (*path, "tasks", number))
    known = all(isinstance(task, str) and task in entries(tree, "tasks") for task in (*shared, *here))
    if nodes and known and len(here) == 1:
        found = f"{shown(here[0])} is the only task of {name}, which must keep one of its own"
        hint = f"give {name} a task before it, or remove 'share'"
        yield problem(nodes[0].place, (*path, "tasks"), found, hint)
    elif nodes and known and (len(shared) >= len(here) or here[len(here) - len(shared) :] != shared):
        found = f"the shared tasks must be the last of those of {name}, after one of its own"
        example = ", ".join(str(task) for task in [*(task for task in here if task not in shared), *shared])
        yield problem(nodes[0].place, (*path, "tasks"), found, f"write 'tasks: [{example}]' at the station")


def _partner(stations: dict[str, Node], name: str, partner: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    """The next station has a buffer to look at and work of its own; jobs at both go one by one."""
    other = stations[partner.value]
    buffer = child(other, "buffer")
    if buffer is None or buffer.value in (None, "unlimited"):
        found = f"{shown(partner.value)} has an unlimited buffer, which is never half full"
        yield problem(partner.place, path, found, f"give {partner.value} a buffer, such as 'buffer: 4'")
    if not items(other, "tasks"):
        found = f"{shown(partner.value)} has no task of its own"
        yield problem(partner.place, path, found, "name a station where work is done")
    for one in (name, partner.value):
        if child(stations[one], "batch") is not None:
            yield problem(partner.place, path, f"{one} serves batches, whose jobs cannot share work one by one")


def _ways(tree: Node, name: str, partner: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    """Every job that comes to one of the two goes from the first to the second."""
    for made, product in entries(tree, "products").items():
        wrong = _wrong_way(product, name, partner.value)
        if wrong:
            hint = f"send {made} from {name} to {partner.value} and nowhere else, or let it pass both by"
            yield problem(partner.place, path, f"{shown(made)} {wrong}", hint)
        for one in (name, partner.value):
            if child(product, "split", one) is not None:
                yield problem(partner.place, path, f"{shown(made)} is split at {one}, and its pieces share no work")


def _wrong_way(product: Node, first: str, second: str) -> str:
    """What is wrong with a product's way past two stations, in words; nothing where it is right."""
    steps: list[tuple[list[str], list[str]]] = []
    route = [one_of(step) for step in items(product, "route")]
    steps += zip([[START], *route], [*route, ["out"]])
    steps += [([name], [to for to, _ in onward(row)]) for name, row in entries(product, "routing").items()]
    for before, after in steps:
        if first in before and set(after) != {second}:
            return f"does not always go from {first} to {second}"
        if second in after and set(before) != {first}:
            return f"comes to {second} without passing {first}"
    return ""
