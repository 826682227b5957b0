"""Changes of a layout, one after the other, as overrides of a scenario."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from opsim.problems import did_you_mean, enumerated, natural_key, shown
from opsim.scenario.fields import Moved, read_any_moved, read_moved
from opsim.scenario.variants import flow_text
from opsim.study.layout.floor import Floor, NoLayout, added_changes

TOGETHER = "all together"
WIDEST = 116
"""Letters in a line to paste."""


@dataclass(frozen=True)
class Candidate:
    """A layout beside the present one.

    changes  : dotted paths and values that make it of the scenario
    at       : where its stations stand; moved : places that are elsewhere, (x, y) in metres; added : new stations
    proposed : whether the study made it; predicted_m_per_h : walking that the flows of today would need there
    """

    name: str
    changes: Mapping[str, Any]
    at: Mapping[str, str]
    moved: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    added: tuple[str, ...] = ()
    proposed: bool = False
    predicted_m_per_h: float | None = None


def what_ifs(floor: Floor, block: Any) -> list[Candidate]:
    """The layouts that a study's block names: each change by itself, all of them together, and those with a name.

    Where each is possible, but not all of them together, that one is left out (``clash`` says why).
    Raises NoLayout with everything that is wrong with any of them.
    """
    single = _single(block)
    named = {str(moved): [moved] for moved in single}
    if len(single) > 1 and not clash(floor, block):
        named[TOGETHER] = single
    for name, texts in block.what_ifs.items():
        named[name] = [read_any_moved(text) for text in texts]
    found, wrong = [], []
    for name, moves in named.items():
        try:
            found.append(candidate(floor, name, moves))
        except NoLayout as error:
            wrong += [line if line.startswith(name) else f"{name}: {line}" for line in str(error).splitlines()]
    if wrong:
        raise NoLayout("\n".join(dict.fromkeys(wrong)))
    return found


def clash(floor: Floor, block: Any) -> str:
    """Why not all changes can be made together; "" where they can."""
    try:
        candidate(floor, TOGETHER, _single(block))
    except NoLayout as error:
        return "; ".join(str(error).splitlines())
    return ""


def _single(block: Any) -> list[Moved]:
    return [read_moved(kind, text) for kind in ("move", "swap", "place", "add") for text in getattr(block, kind)]


def candidate(floor: Floor, name: str, moves: Sequence[Moved]) -> Candidate:
    """The layout that some changes make, one after the other. Raises NoLayout with what is wrong with them."""
    at = dict(floor.at)
    moved: dict[str, list[str]] = {}
    added: dict[str, tuple[str, ...]] = {}
    for one in moves:
        _check(floor, one, at, added)
        if one.kind == "move":
            moved[one.what[0]] = list(one.what[1:])
        elif one.kind == "swap":
            a, b = one.what
            at[a], at[b] = at[b], at[a]
        elif one.kind == "place":
            at[one.what[0]] = one.what[1]
        else:
            added[one.what[0]] = one.what[1:]
            at[one.what[0]] = one.what[2]
    together = list(_too_near(floor, at))
    if together:
        raise NoLayout("\n".join(together))
    at_of = {place: f"{place}.at" for place in floor.scenario.layout.with_heights}
    changes: dict[str, Any] = {f"layout.places.{at_of.get(place, place)}": said for place, said in moved.items()}
    changes |= changes_of(floor, {station: place for station, place in at.items() if station not in added})
    for station, (like, place) in added.items():
        changes |= added_changes(floor.loaded, station, like, place, changes)
    return Candidate(name, changes, at, {place: _metres(said) for place, said in moved.items()}, tuple(added))


def changes_of(floor: Floor, at: Mapping[str, str]) -> dict[str, str]:
    """Overrides that put stations where ``at`` says.

    Where any moves, those whose place is that of another one they are like are told where they stay.
    """
    moves = {station for station, place in at.items() if floor.at[station] != place}
    if moves:
        moves |= floor.inherits & set(at)
    return {f"stations.{station}.at": at[station] for station in sorted(moves, key=natural_key)}


def override_text(candidates: Sequence[Candidate]) -> str:
    """What to paste into the scenario's file so that it has these layouts too."""
    lines = ["overrides:"]
    for one in candidates:
        said = [f"{path}: {flow_text(value)}" for path, value in one.changes.items()]
        lines += _in_lines(f"  {_key(one.name)}: {{", said)
    listed = [f"  {_key(one.name)}: [{_key(one.name)}]" for one in candidates]
    return "\n".join([*lines, "scenarios:", "  base: []", *listed])


def _in_lines(head: str, parts: Sequence[str]) -> Iterator[str]:
    """A block in braces, its lines broken between parts."""
    line = head
    for number, part in enumerate(parts):
        part += "}" if number == len(parts) - 1 else ","
        if len(line) + len(part) > WIDEST and line != head:
            yield line.rstrip()
            line = "    "
        line += f"{part} "
    yield line.rstrip()


def _key(name: str) -> str:
    """A name as a key of the file."""
    kept = "".join(letter if letter.isalnum() else "_" for letter in name).strip("_")
    return "_".join(filter(None, kept.split("_"))) or "layout"


def _check(floor: Floor, one: Moved, at: Mapping[str, str], added: Mapping[str, Any]) -> None:
    wrong = list(_wrong(floor, one, at))
    if wrong:
        raise NoLayout("\n".join(f"{one}: {what}" for what in wrong))


def _wrong(floor: Floor, one: Moved, at: Mapping[str, str]) -> Iterator[str]:
    """Names that nobody knows, each with the nearest one that is known."""
    stations = {"move": (), "swap": one.what, "place": one.what[:1], "add": one.what[1:2]}[one.kind]
    places = {"move": one.what[:1], "swap": (), "place": one.what[1:], "add": one.what[2:]}[one.kind]
    yield from (f"no station {shown(name)}; {did_you_mean(name, at)}" for name in stations if name not in at)
    yield from (
        f"no place {shown(name)}; {did_you_mean(name, floor.places)}" for name in places if name not in floor.places
    )
    if one.kind == "add" and one.what[0] in {*at, *floor.scenario.stores, *floor.scenario.conveyors}:
        yield f"there is a {one.what[0]} already; give the new station another name"
    if one.kind in ("place", "swap"):
        for station in stations:
            if station in floor.tied and floor.tied[station].startswith("the belt"):
                yield f"{station} cannot leave its place: {floor.tied[station]} and would stay; move the place"


def _too_near(floor: Floor, at: Mapping[str, str]) -> Iterator[str]:
    """Stations that would stand at one place, and do not today."""
    found: dict[str, list[str]] = {}
    for station, place in at.items():
        found.setdefault(place, []).append(station)
    for place, stations in found.items():
        came = [station for station in stations if floor.at.get(station) != place]
        if came and len(stations) > 1 and len({floor.at.get(station) for station in stations}) > 1:
            yield f"{enumerated(stations)} would stand at one place, {place}; swap them, or name another place"


def _metres(said: Sequence[str]) -> tuple[float, float]:
    from opsim import units

    x, y = (units.parse(length, "length") for length in said)
    return x, y
