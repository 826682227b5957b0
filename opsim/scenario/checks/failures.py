"""Stops of stations: their teams exist, each has a name of its own, and maintenance leaves time to work."""

from __future__ import annotations

import math
from collections.abc import Iterator

from pydantic import ValidationError

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.positions import Node, Part, child, entries, problem
from opsim.scenario.schema.failures import Maintenance
from opsim.units import UnitError, parse

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
    horizon_s = _seconds(child(tree, "run", "horizon"))
    share = 0.0
    for name, node in entries(station, "maintenance").items():
        read = _read(node)
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


def _read(node: Node) -> Maintenance | None:
    """A maintenance as the schema reads it; None where the schema refuses it."""
    try:
        return Maintenance.model_validate(node.plain())
    except ValidationError:
        return None


def _seconds(node: Node | None) -> float:
    try:
        return math.inf if node is None else parse(node.value, "time")
    except UnitError:
        return math.inf
