"""Paced lines: stations that can move their jobs together, and people who are there and called.

The ways of products over paced lines: on at the first station, from each to the next, off at the last.

Work that two stations share: the second follows the first on every way, and both have work of their own.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.lookup import named, one_of, onward, quantity
from opsim.scenario.tree import Node, Part, TreePath, child, entries, items, problem, text
from opsim.subjects.lines.words import INDEXED, MOVING
from opsim.subjects.people.words import USUAL_WALK_M_PER_S
from opsim.subjects.routes.words import OUT, START

_NOT_ON_A_LINE = {
    "buffer": "the line's own stretch is all the room there is",
    "buffer_after": "a job moves on with the line",
    "batch": "jobs move one by one",
    "preempt": "jobs move in the order in which they came",
    "share": "nobody can begin a job that comes when the line moves",
}


def line_problems(tree: Node) -> Iterator[Problem]:
    """Names that lead nowhere, stations that cannot be on a line, and lines on which nobody works."""
    stations, blocking = entries(tree, "stations"), child(tree, "flow", "blocking")
    seen: dict[str, str] = {}
    if blocking is not None and blocking.value == "before" and entries(tree, "lines"):
        found = "on a paced line a job has its next place when the line moves"
        yield problem(blocking.place, ("flow", "blocking"), found, "say it at the stations that are on no line")
    for name, line in entries(tree, "lines").items():
        path = ("lines", name)
        for number, station in enumerate(items(line, "stations")):
            where = (*path, "stations", number)
            yield from named(station, stations, "station", where)
            if isinstance(station.value, str) and station.value in stations:
                if station.value in seen:
                    found = f"{shown(station.value)} is on {seen[station.value]} already"
                    yield problem(station.place, where, found, "a station is on one line, once")
                seen.setdefault(station.value, name)
        on_it = [one.value for one in items(line, "stations") if isinstance(one.value, str) and one.value in stations]
        for known in dict.fromkeys(on_it):
            yield from _station(tree, known, name, text(line, "kind"))
        for said, length in entries(line, "lengths").items():
            if on_it and said not in on_it:
                hint = did_you_mean(said, on_it, otherwise="its stations")
                yield problem(length.name_place, (*path, "lengths"), f"no station {shown(said)} on {name}", hint)
        yield from _andon(tree, line, on_it, path)
        yield from _crews(tree, name, on_it)
        if text(line, "kind") == MOVING:
            yield from _too_slow(tree, line, on_it, path)


def _station(tree: Node, name: str, line: str, kind: str | None) -> Iterator[Problem]:
    """What a station of a line cannot say."""
    station, path = entries(tree, "stations")[name], ("stations", name)
    for key, why in _NOT_ON_A_LINE.items():
        said = child(station, key)
        if said is not None and said.value not in (None, 0):
            found = f"{name} is on the line {line}, and cannot say {key!r}: {why}"
            yield problem(said.name_place, (*path, key), found, "remove it")
    servers = child(station, "servers")
    if kind == INDEXED and servers is not None and servers.value != 1:
        hint = "for several workers at a job take a task with a 'team'"
        yield problem(servers.place, (*path, "servers"), f"{name} is on the line {line}, which brings one job", hint)
    blocking = child(station, "blocking")
    if blocking is not None and blocking.value == "before":
        found = f"{name} is on the line {line}, where a job has its next place when the line moves"
        yield problem(blocking.place, (*path, "blocking"), found, "write 'blocking: after'")
    rework = child(station, "inspect", "then", "rework")
    if rework is not None:
        found = f"{name} is on the line {line}, and a job that is turned down cannot leave it there"
        yield problem(rework.place, (*path, "inspect", "then"), found, "inspect it after the line, or 'then: scrap'")


def _crews(tree: Node, line: str, on_it: list[str]) -> Iterator[Problem]:
    """Crews go from station to station with their jobs, which a line moves by itself."""
    for name, crew in entries(tree, "crews").items():
        for number, station in enumerate(items(crew, "stations")):
            if isinstance(station.value, str) and station.value in on_it:
                found = f"{station.value} is on the line {line}, which moves the jobs"
                yield problem(station.place, ("crews", name, "stations", number), found, "a crew or a line, not both")


def _andon(tree: Node, line: Node, on_it: list[str], path: TreePath) -> Iterator[Problem]:
    """Who is called is there and can work; others do the usual work."""
    workers, called = entries(tree, "workers"), items(line, "andon", "workers")
    for number, worker in enumerate(called):
        where = (*path, "andon", "workers", number)
        yield from named(worker, workers, "worker", where)
        skills = entries(workers.get(worker.value), "skills") if isinstance(worker.value, str) else {}
        if isinstance(worker.value, str) and worker.value in workers and not set(on_it) & set(skills):
            hint = f"add e.g. '{next(iter(on_it), 'pack')}: 1.0' to his skills"
            yield problem(worker.place, where, f"{worker.value} has no skill on this line", hint)
    names = {one.value for one in called if isinstance(one.value, str)}
    for station in dict.fromkeys(on_it):
        able = {name for name, node in workers.items() if station in entries(node, "skills")}
        if able and able <= names:
            found = f"only {', '.join(sorted(able))} can work at {station}, and comes only when he is called"
            hint = f"add '{station}: 1.0' to the skills of somebody else"
            yield problem(line.value["andon"].name_place, (*path, "andon"), found, hint)


def _too_slow(tree: Node, line: Node, on_it: list[str], path: TreePath) -> Iterator[Problem]:
    """Workers who could not walk after a job that moves away from them."""
    speed = _speed_m_per_s(line)
    for name, worker in entries(tree, "workers").items():
        said = child(worker, "walk")
        walk = USUAL_WALK_M_PER_S if said is None else quantity(said, "speed")
        if speed and walk and walk <= speed and set(on_it) & set(entries(worker, "skills")):
            found = f"{name} walks {walk:g} m/s, and the line moves {speed:g} m/s"
            place = worker.name_place if said is None else said.place
            yield problem(place, ("workers", name, "walk"), found, "he could not follow a job")


def _speed_m_per_s(line: Node) -> float | None:
    said = child(line, "speed")
    if said is not None:
        return quantity(said, "speed")
    length, takt = quantity(child(line, "length"), "length"), quantity(child(line, "takt"), "time")
    return length / takt if length and takt else None


Step = tuple[str, str, Node]
"""(from, to, where it is said); START and OUT stand for the way in and the way out."""


def line_way_problems(tree: Node) -> Iterator[Problem]:
    """Ways that leave a line, or come onto it, in the middle; and what would move a job otherwise than the line."""
    lines = {name: [one.value for one in items(line, "stations")] for name, line in entries(tree, "lines").items()}
    for name, stations in lines.items():
        known = all(isinstance(one, str) and one in entries(tree, "stations") for one in stations)
        if not stations or not known or len(set(stations)) < len(stations):
            continue
        for product, node in entries(tree, "products").items():
            steps = [step for step in _steps(node) if set(stations) & {step[0], step[1]}]
            yield from _way(name, stations, product, steps)
            yield from _alternatives(name, stations, product, node)
            yield from _moved(stations, name, product, node, bool(steps))
        yield from _legs(tree, name, stations)
        yield from _cards(tree, name, stations)
        yield from _rework(tree, name, stations)
        yield from _kept(tree, name, stations)


def _way(line: str, stations: list[str], product: str, steps: list[Step]) -> Iterator[Problem]:
    """The first step of a product that a line does not go."""
    allowed = set(pairwise(stations))
    for before, after, node in steps:
        if (before, after) in allowed or (before not in stations and after == stations[0]):
            continue
        if before == stations[-1] and after not in stations[1:]:
            continue
        came = f"begins at {after}" if before == START else f"comes from {before} to {after}"
        found = f"{product} {came}" if after != OUT else f"{product} leaves from {before}"
        yield problem(
            node.place,
            ("products", product),
            f"{found}, and the line {line} goes {', '.join(stations)}",
            "a way goes over all its stations in this order; one without work there has no tasks",
        )
        return


def _alternatives(line: str, stations: list[str], product: str, node: Node) -> Iterator[Problem]:
    for number, step in enumerate(items(node, "route")):
        if len(one_of(step)) > 1 and set(one_of(step)) & set(stations):
            found = f"{product} goes to {' or '.join(one_of(step))}, and the line {line} leads to one of them alone"
            yield problem(step.place, ("products", product, "route", number), found, "name one station")


def _steps(product: Node) -> Iterator[Step]:
    """From where to where a product may go."""
    route = items(product, "route")
    ends = [] if not route else [Node(OUT, route[-1].place)]
    for here, there in pairwise([Node(START, product.place), *route, *ends]):
        yield from ((before, after, there) for before in one_of(here) for after in one_of(there))
    for name, row in entries(product, "routing").items():
        for other, node in onward(row):
            yield name, other, node


def _moved(stations: list[str], line: str, product: str, node: Node, passes: bool) -> Iterator[Problem]:
    carried = child(node, "carried")
    if passes and carried is not None and carried.value is True:
        found = f"{product} goes over the line {line}, which moves it"
        yield problem(carried.place, ("products", product, "carried"), found, "remove 'carried'")
    for station, pieces in entries(node, "split").items():
        if station in stations:
            found = f"{product} is split at {station}, on the line {line}"
            yield problem(pieces.name_place, ("products", product, "split"), found, "split it after the line")


def _legs(tree: Node, line: str, stations: list[str]) -> Iterator[Problem]:
    for name, vehicle in entries(tree, "transporters").items():
        for number, leg in enumerate(items(vehicle, "legs")):
            ends = [end.value for end in items(leg)]
            if len(ends) == 2 and (ends[1] in stations or ends[0] in stations):
                found = f"{name} would bring jobs to or from a station of the line {line}, which comes when it comes"
                hint = "put a store or a station between them"
                yield problem(leg.place, ("transporters", name, "legs", number), found, hint)


def _cards(tree: Node, line: str, stations: list[str]) -> Iterator[Problem]:
    for name, card in entries(tree, "cards").items():
        begin = child(card, "from")
        for node in [] if begin is None else items(begin) or [begin]:
            if node.value in stations[1:]:
                found = f"a card is taken before {node.value}, and the line {line} waits for nobody there"
                yield problem(node.place, ("cards", name, "from"), found, f"take it before {stations[0]}")


def _rework(tree: Node, line: str, stations: list[str]) -> Iterator[Problem]:
    for name, station in entries(tree, "stations").items():
        rework = child(station, "inspect", "then", "rework")
        if rework is not None and rework.value in stations and name not in stations:
            found = f"a job cannot come back to {shown(rework.value)}, on the line {line}"
            hint = "rework it at a station of its own"
            yield problem(rework.place, ("stations", name, "inspect", "then"), found, hint)


def _kept(tree: Node, line: str, stations: list[str]) -> Iterator[Problem]:
    """Stations from which jobs come onto the line, and that ask for a place there before they begin."""
    before = {
        step[0] for product in entries(tree, "products").values() for step in _steps(product) if step[1] == stations[0]
    }
    for name in sorted(before - set(stations)):
        blocking = child(tree, "stations", name, "blocking")
        if blocking is not None and blocking.value == "before":
            found = f"no place on the line {line} can be kept: a job comes onto it when it moves"
            yield problem(blocking.place, ("stations", name, "blocking"), found, "write 'blocking: after'")


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
