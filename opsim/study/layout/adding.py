"""A station more, like another: who may work there, and which jobs go there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from opsim.scenario.read import Loaded
from opsim.study.layout.floor import NoLayout


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


def _part_of(scenario: Any, like: str) -> Iterator[str]:
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
