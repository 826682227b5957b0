"""What is wrong with stops: teams that exist, tasks that can be done, time left to work.

What the assumption sheet says of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from opsim.plan import Plan
from opsim.problems import Assumption, Problem, did_you_mean, listed, shown
from opsim.scenario.checks.lookup import block_read, quantity
from opsim.scenario.tree import Node, Part, child, entries, problem
from opsim.subjects.breakdowns.plan import BUSY, CLOCK, CYCLES, NO_TEAM
from opsim.subjects.breakdowns.words import Maintenance

KINDS = ("breakdowns", "maintenance")


def failure_problems(tree: Node) -> Iterator[Problem]:
    """Teams that do not exist, two stops of one name, maintenance that takes all the time there is."""
    for name, station in entries(tree, "stations").items():
        path = ("stations", name)
        for kind in KINDS:
            for stop, node in entries(station, kind).items():
                yield from _team(tree, node, (*path, kind, stop))
        if child(station, "maintenance") is not None:
            yield from _one_name(station, path)
            yield from _time_left(tree, station, path)


def stop_times(tree: Node) -> Iterator[tuple[tuple[Part, ...], Node]]:
    """Where times stand in the stops of stations, each with its path."""
    for name, station in entries(tree, "stations").items():
        for kind in KINDS:
            for stop, node in entries(station, kind).items():
                for key in ("every", "repair", "lasts"):
                    time = child(node, key)
                    if time is not None:
                        yield ("stations", name, kind, stop, key), time


def _team(tree: Node, stop: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    team, known = child(stop, "team"), entries(tree, "repair_teams")
    if team is not None and isinstance(team.value, str) and team.value not in known:
        hint = did_you_mean(team.value, known, otherwise="known teams")
        hint = hint or f"add a section 'repair_teams: {{{team.value}: {{n: 1}}}}'"
        yield problem(team.place, (*path, "team"), f"no repair team {shown(team.value)}", hint)


def _one_name(station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    for name, node in entries(station, "maintenance").items():
        if name in entries(station, "breakdowns"):
            found = f"a breakdown of this station is called {shown(name)} as well"
            yield problem(node.name_place, (*path, "maintenance", name), found, "figures go by these names: change one")


def _time_left(tree: Node, station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    """A stop that outlasts the run, and stops that together take all the time."""
    horizon_s = quantity(child(tree, "run", "horizon"), "time") or math.inf
    share = 0.0
    for name, node in entries(station, "maintenance").items():
        read = block_read(Maintenance, node)
        if read is None or read.lasts_s is None:
            continue
        share += read.lasts_s / read.every_s
        if read.lasts_s >= horizon_s:
            found = f"lasts {read.lasts_s:g} s, and the whole run only {horizon_s:g} s"
            place = node.value["lasts"].place
            yield problem(place, (*path, "maintenance", name, "lasts"), found, "make it shorter, or the run longer")
    if share >= 1 and len(entries(station, "maintenance")) > 1:
        found = f"these together take {share:.0%} of the time: the station would never work"
        node = station.value["maintenance"]
        yield problem(node.name_place, (*path, "maintenance"), found, "make them shorter, or rarer")


_COUNTED = {
    CLOCK: "while the station is up, in work or not",
    BUSY: "only while something is done there",
    CYCLES: "by operations, and it stops as the next one would begin",
}


def stopped(plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of every kind of stop that the plan has."""
    for by, counted in _COUNTED.items():
        names = [one.name for one in plan.breakdowns if one.by == by]
        if names:
            yield "breakdowns", f"{listed(names)}: what leads to it counts {counted}"
    if plan.stops:
        yield (
            "breakdowns",
            "a stop stops all servers of a station; one stop at a time, and what falls due meanwhile follows; a "
            "station that stands neither wears nor breaks down",
        )
    for fate, words in (("restart", "begins anew, with a time of its own"), ("scrap", "is scrap")):
        names = [one.name for one in plan.breakdowns if one.job == fate]
        if names:
            yield "breakdowns", f"{listed(names)}: what was in work {words}"
    alone = [one.name for one in plan.stops if one.team == NO_TEAM]
    if alone:
        yield "breakdowns", f"{listed(alone)}: ends by itself after its time; no worker and no team is needed"
    if plan.repair_teams:
        yield "breakdowns", "a repair team comes without a walk, to the stop that waits longest; it knows no other work"
