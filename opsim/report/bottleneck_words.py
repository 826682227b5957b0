"""What it means that a station is the bottleneck, and whether waiting before and behind it says the same."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from opsim.plan import Plan
from opsim.report.demand import keeps_up
from opsim.report.flow_order import along
from opsim.report.material import Material
from opsim.report.open_time import of_open, open_share
from opsim.report.rough import percent
from opsim.report.sentence import find, with_interval
from opsim.report.words import is_number, listing

CLEARLY, MUCH = 0.5, 0.25
"""Shares of the time: alone the bottleneck for so long that it is called the one; or that a second is named."""
IDLE, NOBODY = 0.1, 0.4
"""Shares of the time without any station that is active: beyond the first none is said to set the pace, beyond the
second none is what holds up the floor."""
NOTABLE = 0.03
"""A share of blocking or starving that is worth a word."""


def bottleneck_sentences(material: Material, order: Sequence[str]) -> list[str]:
    """Which station, for how long, what to do about it, and the pattern of blocking and starving about it.

    order : stations along the flow
    """
    rows = bottleneck_rows(material)
    share = {
        (row["subject"], row["part"]): row["mean"] for row in rows if is_number(row["mean"]) and row["subject"] in order
    }
    momentary = {name: share.get((name, "momentary"), 0.0) for name in order}
    ranked = sorted(order, key=lambda name: -momentary[name])
    return [*_which(material, rows, ranked, momentary), *_pattern(material, ranked[0], order)]


def time_open(material: Material) -> float:
    """Share of the window that all shares of this section are of: the open time."""
    none = find(material.rows("bottleneck"), "bottleneck", "", "none")
    return open_share(material.plan, 0.0 if none is None else 1.0 - none["mean"])


def bottleneck_rows(material: Material) -> list[dict[str, Any]]:
    """Those of the summary, as shares of the time for which the floor is open."""
    share = time_open(material)
    found = [of_open(row, share) for row in material.rows("bottleneck")]
    closed = 1.0 / share - 1.0
    return [
        {**row, **{end: max(0.0, row[end] - closed) for end in ("mean", "low", "high") if is_number(row.get(end))}}
        if row["part"] == "none"
        else row
        for row in found
    ]


def _which(
    material: Material, rows: Sequence[Mapping[str, Any]], ranked: Sequence[str], momentary: Mapping[str, float]
) -> Iterator[str]:
    first, second, time = ranked[0], ranked[1], "open time" if time_open(material) < 1 else "time"
    top, sole = find(rows, "bottleneck", first, "momentary"), find(rows, "bottleneck", first, "sole")
    if top is None:
        return
    alone = f"; for {with_interval(sole)} it is so alone" if sole is not None else ""
    yield f"{first} is the bottleneck for {with_interval(top)} of the {time}, longer than any other station{alone}."
    none = find(rows, "bottleneck", "", "none")
    idle, clearly = 0.0 if none is None else none["mean"], sole is not None and sole["mean"] >= CLEARLY
    if (clearly or idle > NOBODY) and keeps_up(material):
        yield (
            f"Yet demand sets the pace: as much leaves as comes in, and for {percent(idle)} of the {time} no station "
            f"is busy on all its servers. Time saved at {first} shortens how long jobs stay, and adds no output."
        )
        return
    if clearly and idle <= IDLE:
        yield (
            f"So it sets the pace: time saved at {first}, or a stop avoided there, comes out as output; "
            "elsewhere it mostly becomes waiting."
        )
        return
    if clearly or idle > NOBODY:
        yield (
            f"For {percent(idle)} of the {time} no station is busy on all its servers: what is missing then is "
            "not a faster station but jobs, or people who are elsewhere; see what stations and workers were doing."
        )
        return
    near = [name for name in ranked if momentary[name] >= MUCH] or [first, second]
    near = near if len(near) > 1 else [first, second]
    shares = listing([f"{name} ({percent(momentary[name])})" for name in near])
    yield (
        f"No station holds up the floor by itself: it moves between {shares}. Making one of them faster gains "
        "little while the others stay as they are; room between them, or evener times, helps all."
    )


def _pattern(material: Material, first: str, order: Sequence[str]) -> Iterator[str]:
    """Blocking before the bottleneck and starving behind it are its shadow; where they fall elsewhere, it is said.

    Source: Li, Chang & Ni 2009, Data driven bottleneck detection of manufacturing systems, Int. J. Production Research
    47(18), 5019-5036 (the turning point).
    """
    order = _on_its_way(material.plan, first, order)
    rows, share = material.rows("station_states"), time_open(material)
    blocked, starved = (
        {
            row["subject"]: min(1.0, row["mean"] / share)
            for row in rows
            if row["part"] == part and is_number(row["mean"])
        }
        for part in ("blocked", "starved")
    )
    known = [name for name in order if name in blocked and name in starved]
    if len(known) < 2 or first not in known or max([*blocked.values(), *starved.values()]) < NOTABLE:
        return
    at, time = known.index(first), "open time" if share < 1 else "time"
    said = []
    if before := _mean([blocked[name] for name in known[:at]]):
        said.append(f"ahead of it stations are blocked for {percent(before)} of the {time} on average")
    if behind := _mean([starved[name] for name in known[at + 1 :]]):
        said.append(f"behind it {'they' if said else 'stations'} have no job for {percent(behind)}")
    own = f"{first} itself is blocked for {percent(blocked[first])}"
    own += f" and without a job for {percent(starved[first])}"
    text = listing([*said, own])
    yield text[:1].upper() + text[1:] + "."
    least = min(known, key=lambda name: blocked[name] + starved[name])
    if least != first and blocked[first] + starved[first] - blocked[least] - starved[least] >= NOTABLE:
        yield (
            f"{least} waits least of all ({percent(blocked[least] + starved[least])} blocked or without a "
            "job): by that sign it may be the narrower one; look at both."
        )


def _on_its_way(plan: Plan, station: str, order: Sequence[str]) -> list[str]:
    """Of some stations along the flow, those on the first route that comes to one of them."""
    ways = ([plan.stations[rank].name for rank in along(product)] for product in plan.products)
    way = next((way for way in ways if station in way), [])
    return [name for name in order if name in way]


def _mean(shares: Sequence[float]) -> float:
    return sum(shares) / len(shares) if shares else 0.0
