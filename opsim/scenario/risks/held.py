"""Workers who stay with a blocked job, all of them, in front of something full that waits for one of them."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from opsim.graph import reached, reverse
from opsim.names import natural_key
from opsim.scenario.risks.ways import Ways, points_of, ways
from opsim.scenario.risks.words import listed
from opsim.scenario.schema import Scenario
from opsim.scenario.schema.rotations import Rotation


def held_risks(scenario: Scenario) -> Iterator[str]:
    """Everybody who can work at a station may be held in front of points that are full because nobody works there."""
    held = scenario.allocation.when_blocked == "held"
    why, remedy = ("when_blocked: held", "'when_blocked: free'") if held else ("carried: true", "'carried: false'")
    onward, stays = ways(scenario), ways(scenario, only_carried=not held)
    if not stays:
        return
    people, stuck = _people(scenario), _stuck(scenario, onward, stays)
    full = stuck & _limited(scenario)
    back, passed = reverse(onward | _takers(scenario)), full - {*people}
    for name in sorted(stuck.intersection(people), key=natural_key):
        ahead = reached(back, [name], without={*onward} - passed) & full
        near = _holders(name, people, ahead, stays, scenario)
        before = near or _holders(name, people, full, stays, scenario)
        if before and any(ahead & stays.get(one, set()) for one in people.keys() - {name}):
            who, where = (listed(sorted(names, key=natural_key)) for names in (people[name], before))
            who = f"those of {who} whose post it is" if _rotations(name, scenario) else who
            waits = f"{name} is full and" if name in full else f"work at {name}"
            yield (
                f"with {why}, {who} can all be held at {where} while {waits} waits for one of them: then nothing moves "
                f"any more; take {remedy}, or let somebody work at {name} alone"
            )


def _stuck(scenario: Scenario, onward: Ways, stays: Ways) -> set[str]:
    """The largest set of points that can all wait for each other: a point's jobs wait for a full one, its people are
    all held in front of full ones, or nobody takes anything from it.
    """
    people, limited, takers = _people(scenario), _limited(scenario), _takers(scenario)
    stuck = {*scenario.stations, *scenario.conveyors, *scenario.stores}
    while True:
        full = stuck & limited
        left = {
            name
            for name in stuck
            if onward.get(name, set()) & (full - {name})
            or takers.get(name, set()) & stuck
            or (name in people and _holders(name, people, full, stays, scenario))
        }
        if left == stuck:
            return stuck
        stuck = left


def _holders(name: str, people: Ways, full: set[str], stays: Ways, scenario: Scenario) -> set[str]:
    """The stations where all who can work at a station may be held in front of full points; empty where they cannot."""
    able = people[name]
    before = {one for one, who in people.items() if who & able and stays.get(one, set()) & (full - {one})}
    places = sum(scenario.stations[one].servers + scenario.stations[one].buffer_after for one in before)
    held = able.intersection(set().union(*(people[one] for one in before)))
    team = max((scenario.tasks[task].team for task in scenario.stations[name].tasks), default=1)
    return before if min(len(held), places) > _at_once(name, able, scenario) - team else set()


def _at_once(name: str, able: set[str], scenario: Scenario) -> int:
    """How many of those who can work at a station may work there at the same time, at least."""
    return len(able) - sum(max(0, len(able.intersection(one.workers)) - 1) for one in _rotations(name, scenario))


def _rotations(name: str, scenario: Scenario) -> list[Rotation]:
    """Those that may leave a station to one member for good; by the clock another one has his turn in time."""
    turning = [one for one in scenario.rotations.values() if one.every_s is None]
    return [one for one in turning if any(name in post for post in one.posts)]


def _limited(scenario: Scenario) -> set[str]:
    """The points that can be full."""
    stations = {name for name, station in scenario.stations.items() if station.buffer is not None}
    stations |= {name for line in scenario.lines.values() for name in line.stations}
    return stations | {*scenario.conveyors} | {n for n, s in scenario.stores.items() if (s.capacity or inf) < inf}


def _takers(scenario: Scenario) -> Ways:
    """Of each store, the stations that take parts from it."""
    takers: Ways = {}
    for made in scenario.products.values():
        for station, parts in made.parts.items():
            for store in (store for part in parts for store in points_of(scenario.products[part])):
                if store in scenario.stores:
                    takers.setdefault(store, set()).add(station)
    return takers


def _people(scenario: Scenario) -> Ways:
    """Who works at each station; no station where everything is automatic, or of a crew, whose people go with jobs."""
    by_hand = {task for task, block in scenario.tasks.items() if block.automatic is not True}
    manned = {name for name, station in scenario.stations.items() if not by_hand.isdisjoint(station.tasks)}
    manned -= {station for crew in scenario.crews.values() for station in crew.stations}
    able: Ways = {}
    for name, worker in scenario.workers.items():
        serves = manned.intersection(worker.skills)
        if scenario.allocation.idle == "patrol":
            serves &= set(worker.patrol or ())
        for station in serves:
            able.setdefault(station, set()).add(name)
    return able
