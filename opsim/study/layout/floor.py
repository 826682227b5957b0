"""What stands where on a floor, what may be moved and where to.

A station more, like another: who may work there, and which jobs go there.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, Any

from opsim.layout import Ways, ways
from opsim.problems import did_you_mean, enumerated, natural_key, shown
from opsim.scenario.schema.scenario import Loaded

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


class NoLayout(ValueError):
    """A layout study that makes no sense, and why."""


@dataclass(frozen=True)
class Floor:
    """A scenario's places and what stands on them.

    at       : the place of each station, both in natural order of stations
    inherits : stations whose place is that of the station they are like: it must be said where they stay
    """

    loaded: Loaded
    at: Mapping[str, str]
    inherits: frozenset[str] = frozenset()

    @property
    def scenario(self) -> Any:
        return self.loaded.scenario

    @cached_property
    def ways(self) -> Ways:
        """The shortest ways between all places."""
        return ways(self.scenario.layout)

    @property
    def places(self) -> dict[str, tuple[float, float]]:
        """x and y in metres of every place."""
        return self.scenario.layout.places

    @cached_property
    def stations_at(self) -> dict[str, tuple[str, ...]]:
        """By place, the stations there, in natural order."""
        found: dict[str, list[str]] = {}
        for station, place in self.at.items():
            found.setdefault(place, []).append(station)
        return {place: tuple(stations) for place, stations in found.items()}

    @cached_property
    def others_at(self) -> dict[str, list[str]]:
        """By place, what is there beside stations, in words: it stays where it is."""
        found: dict[str, list[str]] = {}
        for place, words in _others(self.scenario):
            found.setdefault(place, []).append(words)
        return found

    @cached_property
    def tied(self) -> dict[str, str]:
        """Stations that proposals leave where they are unless somebody names them, and why."""
        found: dict[str, str] = {}
        for name, line in self.scenario.lines.items():
            found |= dict.fromkeys(line.stations, f"it is part of the line {name}")
        for name, belt in self.scenario.conveyors.items():
            for place in (belt.start, belt.end):
                found |= dict.fromkeys(self.stations_at.get(place, ()), f"the belt {name} begins or ends there")
        for place, words in self.others_at.items():
            stores = [one for one in words if one.startswith("the store")]
            for one in stores:
                found |= dict.fromkeys(self.stations_at.get(place, ()), f"{one} is there")
        return found


def floor_of(loaded: Loaded, own_places: Mapping[str, bool] | None = None) -> Floor:
    """The floor of a scenario. own_places : by station, whether the file says its place in the station's own block."""
    at = {name: loaded.scenario.stations[name].at for name in sorted(loaded.scenario.stations, key=natural_key)}
    inherits = frozenset(name for name, own in (own_places or {}).items() if not own)
    return Floor(loaded, at, inherits)


@dataclass(frozen=True, slots=True)
class Movable:
    """Places whose stations may move, each as one thing, and where to; places by name in natural order."""

    things: tuple[str, ...]
    allowed: tuple[str, ...]
    exclusive: bool


def movable(floor: Floor, fixed: Sequence[str] = (), places: Sequence[str] | None = None) -> Movable:
    """What may be moved where. Raises NoLayout with everything that is wrong, each with the nearest word."""
    wrong = [*_unknown(fixed, floor.at, "station", "fixed"), *_unknown(places or (), floor.places, "place", "places")]
    if wrong:
        raise NoLayout("\n".join(wrong))
    stay = {floor.at[name] for name in (*fixed, *floor.tied)}
    things = tuple(place for place in floor.stations_at if place not in stay)
    if not things:
        why = "; ".join(f"{name}: {reason}" for name, reason in list(floor.tied.items())[:3])
        raise NoLayout(f"no station may be moved: all of them are fixed{f' ({why})' if why else ''}; free one of them")
    allowed = _by_default(floor, things) if places is None else tuple(places)
    wrong = [*_taken(floor, allowed, stay), *_unreached(floor, allowed, things)]
    if len(things) > len(allowed):
        wrong.append(
            f"places: {len(things)} {'stations' if len(things) > 1 else 'station'} "
            f"({enumerated([' and '.join(floor.stations_at[place]) for place in things])}) and only "
            f"{len(allowed)} place{'s' if len(allowed) > 1 else ''} for them; name more places, or fix some stations"
        )
    if wrong:
        raise NoLayout("\n".join(wrong))
    return Movable(_natural(things), _natural(allowed), places is not None)


def _unknown(names: Sequence[str], known: Mapping[str, Any], what: str, key: str) -> Iterator[str]:
    where = f"{key}: " if key else ""
    yield from (f"{where}no {what} {shown(name)}; {did_you_mean(name, known)}" for name in names if name not in known)


def _natural(names: Sequence[str]) -> tuple[str, ...]:
    return tuple(sorted(dict.fromkeys(names), key=natural_key))


def _by_default(floor: Floor, things: Sequence[str]) -> tuple[str, ...]:
    """Where the things stand, and what nobody uses; where people follow paths, a free place may be a mere crossing."""
    if floor.scenario.layout.distance == "paths":
        return tuple(things)
    free = [place for place in floor.places if place not in floor.stations_at and place not in floor.others_at]
    return (*things, *free)


def _taken(floor: Floor, allowed: Sequence[str], stay: set[str]) -> Iterator[str]:
    for place in allowed:
        if place in stay:
            yield f"places: {' and '.join(floor.stations_at[place])} stays at {place}: nothing else can stand there"
        elif any(not words.startswith("the home") for words in floor.others_at.get(place, ())):
            yield f"places: {floor.others_at[place][0]} is at {place}: no station can stand there"


def _unreached(floor: Floor, allowed: Sequence[str], things: Sequence[str]) -> Iterator[str]:
    """Places that no path leads to from where stations stand, or from which none leads back."""
    rank = {name: number for number, name in enumerate(floor.ways.places)}
    distance_m = floor.ways.distance_m
    seen_from = next(iter(floor.stations_at))
    for place in allowed:
        there, back = distance_m[rank[seen_from]][rank[place]], distance_m[rank[place]][rank[seen_from]]
        if not isfinite(there):
            yield f"places: no path leads from {seen_from} to {place}; add one to layout.paths, or leave {place} out"
        elif not isfinite(back):
            yield f"places: no path leads from {place} back to {seen_from}; add one to layout.paths, or leave it out"


def _others(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """(place, words) of what is not a station."""
    for name, store in scenario.stores.items():
        yield store.at, f"the store {name}"
    for name, belt in scenario.conveyors.items():
        yield belt.start, f"the beginning of the belt {name}"
        yield belt.end, f"the end of the belt {name}"
    for name, vehicle in scenario.transporters.items():
        yield vehicle.at, f"the stand of {name}"
    for name, shift in scenario.shifts.items():
        for pause, one in {**shift.breaks, **getattr(shift, "meetings", {})}.items():
            if one.place is not None:
                yield one.place, f"the place of {pause} of the shift {name}"
    people = {**scenario.workers, **({} if scenario.workforce is None else {"the workforce": scenario.workforce})}
    for name, worker in people.items():
        if worker.home is not None:
            yield worker.home, f"the home of {name}"


def added_changes(loaded: Loaded, name: str, like: str, place: str, before: Mapping[str, Any]) -> dict[str, Any]:
    """Overrides that add a station: jobs of a route go to it or to the one it is like, whichever the rule of routing
    takes; whoever has the skill for that one has it for this.

    before : what other changes say already
    Raises NoLayout where the station is part of something it cannot be added to.
    """
    wrong = list(_part_of(loaded.scenario, like))
    if wrong:
        raise NoLayout("\n".join(f"add {name}=like {like} at {place}: {one}" for one in wrong))
    plain = loaded.resolved
    changes: dict[str, Any] = {f"stations.{name}": {"like": like, "at": place}}
    for product, said in plain["products"].items():
        if like in _flat(said.get("route", [])):
            path = f"products.{product}.route"
            changes[path] = [_with(step, name, like) for step in before.get(path, said["route"])]
        for key in ("parts", "split"):
            if like in said.get(key, {}):
                changes[f"products.{product}.{key}.{name}"] = said[key][like]
    for path, person in _people(plain):
        if like in person.get("skills", {}):
            changes[f"{path}.skills.{name}"] = person["skills"][like]
        zone = before.get(f"{path}.zone", person.get("zone")) or ()
        if like in zone:
            changes[f"{path}.zone"] = [*zone, name]
    return changes


def _people(plain: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    yield from ((f"workers.{name}", person) for name, person in plain.get("workers", {}).items())
    if plain.get("workforce"):
        yield "workforce", plain["workforce"]


def _with(step: Any, name: str, like: str) -> Any:
    """A step of a route with one station more where it has the other."""
    one_of = step if isinstance(step, list) else [step]
    return [*one_of, name] if like in one_of else step


def _flat(route: list[Any]) -> set[str]:
    return {name for step in route for name in (step if isinstance(step, list) else [step])}


def _part_of(scenario: Scenario, like: str) -> Iterator[str]:
    """What knows the station by name and would not know the new one."""
    for name, product in scenario.products.items():
        if product.routing is not None and (
            like in product.routing or any(like in to for to in product.routing.values())
        ):
            yield f"{name} comes to {like} with a probability; say yourself with which it goes to the new one"
    for kind, blocks in (("crew", scenario.crews), ("line", scenario.lines)):
        for name, block in blocks.items():
            if like in block.stations:
                yield f"{like} is part of the {kind} {name}; add the new station to it in an override of your own"
    for name, vehicle in scenario.transporters.items():
        if any(like in leg for leg in vehicle.legs):
            yield f"{name} brings jobs to or from {like}; add its legs in an override of your own"
    for name, rotation in scenario.rotations.items():
        if any(like in (post if isinstance(post, list) else [post]) for post in rotation.posts):
            yield f"{like} is a post of the rotation {name}; add the new station in an override of your own"
