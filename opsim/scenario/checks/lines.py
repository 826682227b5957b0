"""Paced lines: stations that can move their jobs together, and people who are there and called."""

from __future__ import annotations

from collections.abc import Iterator

from opsim import units
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.references import named
from opsim.scenario.positions import Node, child, entries, items, problem, text
from opsim.scenario.schema.lines import INDEXED, MOVING
from opsim.scenario.schema.workers import USUAL_WALK_M_PER_S

Path = tuple[str | int, ...]
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


def _andon(tree: Node, line: Node, on_it: list[str], path: Path) -> Iterator[Problem]:
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


def _too_slow(tree: Node, line: Node, on_it: list[str], path: Path) -> Iterator[Problem]:
    """Workers who could not walk after a job that moves away from them."""
    speed = _speed_m_per_s(line)
    for name, worker in entries(tree, "workers").items():
        said = child(worker, "walk")
        walk = USUAL_WALK_M_PER_S if said is None else _quantity(said, "speed")
        if speed and walk and walk <= speed and set(on_it) & set(entries(worker, "skills")):
            found = f"{name} walks {walk:g} m/s, and the line moves {speed:g} m/s"
            place = worker.name_place if said is None else said.place
            yield problem(place, ("workers", name, "walk"), found, "he could not follow a job")


def _speed_m_per_s(line: Node) -> float | None:
    said = child(line, "speed")
    if said is not None:
        return _quantity(said, "speed")
    length, takt = _quantity(child(line, "length"), "length"), _quantity(child(line, "takt"), "time")
    return length / takt if length and takt else None


def _quantity(node: Node | None, kind: str) -> float | None:
    try:
        return None if node is None else units.parse(node.value, kind)
    except units.UnitError:
        return None
