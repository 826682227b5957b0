"""What it means that a station is the bottleneck, and whether waiting before and behind it says the same.

Which station holds up the floor: how much of the time, when, and what its neighbours say of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from opsim.kpi.states import active_periods, longest_under_way
from opsim.kpi.window import changes
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.report.material import Material
from opsim.report.numbers import is_number, listing, percent, quantity, rough
from opsim.report.page import Block, Bullets, Chart, Section, Words
from opsim.report.plot.plotly import FONT, at_ms, clock_axis, label, layout_of, shaded
from opsim.report.sections.common import along, of_open, open_share, worked_on
from opsim.report.sections.summary import busiest_worker, find, keeps_up, with_interval
from opsim.report.sections.yamazumi import Bar, Look, bar_traces, fitting

MUCH = 0.25
"""Share of the time as the bottleneck from which on a station is named beside the first."""
IDLE = 0.1
"""Share of the time without any station that is active that is worth a word."""
NOTABLE = 0.03
"""A share of blocking or starving that is worth a word."""


def bottleneck_sentences(material: Material, order: Sequence[str]) -> list[str]:
    """Which station, for how long, blocking and starving about it, the busiest people and tools, how to find out more.

    order : stations along the flow
    """
    rows = bottleneck_rows(material)
    share = {
        (row["subject"], row["part"]): row["mean"] for row in rows if is_number(row["mean"]) and row["subject"] in order
    }
    momentary = {name: share.get((name, "momentary"), 0.0) for name in order}
    ranked = sorted(order, key=lambda name: -momentary[name])
    which = _which(material, rows, ranked, momentary)
    return [*which, *_pattern(material, ranked[0], order), *_busiest(material), FIND_OUT]


FIND_OUT = (
    "What a faster station, more people or tools, or more room would change does not show in one run: vary that value "
    "with opsim sweep, or make it a variant for opsim compare."
)


def _busiest(material: Material) -> Iterator[str]:
    """The worker and the tool with the least time to spare."""
    if worker := busiest_worker(material.summary["kpis"]):
        yield worker
    known = [of_open(row, time_open(material)) for row in material.rows("tool_use") if is_number(row["mean"])]
    if known:
        top = max(known, key=lambda row: row["mean"])
        yield (
            f"The busiest tool is {top['subject']}: in use, or kept for a job, for {with_interval(top)} of the "
            f"{'open time' if time_open(material) < 1 else 'time'}."
        )


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
    first, time = ranked[0], "open time" if time_open(material) < 1 else "time"
    top, sole = find(rows, "bottleneck", first, "momentary"), find(rows, "bottleneck", first, "sole")
    if top is None:
        return
    alone = f", {with_interval(sole)} without another one beside it" if sole is not None else ""
    next_to_it = [f"{name} ({percent(momentary[name])})" for name in ranked[1:] if momentary[name] >= MUCH]
    others = f"; next {'is' if len(next_to_it) == 1 else 'are'} {listing(next_to_it)}" if next_to_it else ""
    of_all = f"of the {time}, the longest of all stations"
    yield f"{first} is the bottleneck for {with_interval(top)} {of_all}{alone}{others}."
    none = find(rows, "bottleneck", "", "none")
    if none is not None and none["mean"] > IDLE:
        yield f"For {percent(none['mean'])} of the {time} no station is busy on all its servers."
    if keeps_up(material):
        yield "As much leaves as comes in: the output is what is asked for."


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
        yield (f"{least} waits least of all ({percent(blocked[least] + starved[least])} blocked or without a job).")


def _on_its_way(plan: Plan, station: str, order: Sequence[str]) -> list[str]:
    """Of some stations along the flow, those on the first route that comes to one of them."""
    ways = ([plan.stations[rank].name for rank in along(product)] for product in plan.products)
    way = next((way for way in ways if station in way), [])
    return [name for name in order if name in way]


def _mean(shares: Sequence[float]) -> float:
    return sum(shares) / len(shares) if shares else 0.0


SOLE = Look("alone the bottleneck", "#D55E00")
SHIFTING = Look("while the bottleneck moves", "#E69F00", "#111111", "/")
MOMENT = Look("the bottleneck at that moment", "#0072B2")
LEAST = 0.005
"""A smaller share of the time is not drawn."""
MOST_ROWS, CELLS = 24, 400
LEAST_AXIS = 25.0
"""Per cent at the end of the axis, at least: short bars for what is seldom."""
NOTE = "Of the hours for which the floor is scheduled to be open; the table of all figures is of all hours counted."
METHOD = (
    "A station is active while it works, is set up or is down, and not while it waits; one with several servers only "
    "while all of them are. The station whose active period "
    "is the longest at a moment is the bottleneck then; where the periods of two such stations overlap, it moves from "
    "one to the other (Roser, Nakano and Tanaka 2002). All replications count; the strip is the first one."
)


def bottleneck_section(material: Material) -> Section | None:
    """Bars of shares of all replications, a strip over the clock of the first, and sentences; None for one station."""
    order = [material.plan.stations[rank].name for rank in worked_on(material.plan)]
    shares = _shares(bottleneck_rows(material))
    shown = [name for name in order if sum(shares.get(name, {}).values()) >= LEAST]
    shown = sorted(shown, key=lambda name: -sum(shares[name].values()))[:MOST_ROWS]
    shown = [name for name in order if name in shown]
    if len(order) < 2 or not shown:
        return None
    blocks: list[Block] = [Bullets(bottleneck_sentences(material, order))]
    legend = [look.swatch for look, part in ((SOLE, "sole"), (SHIFTING, "shifting")) if _any(shares, shown, part)]
    said = "; ".join(_said(name, shares[name]) for name in shown)
    time = "open time" if time_open(material) < 1 else "time"
    title, note = f"Share of the {time}", NOTE if time == "open time" else ""
    blocks.append(Chart("bottleneck-shares", _bars(shares, shown, time), said, title, legend, note=note))
    if material.log is not None:
        blocks += _strip_of(material.log, material.plan)
    return Section("bottleneck", "What holds up the floor", [*blocks, Words(METHOD, muted=True)], "Bottleneck")


def _shares(rows: Sequence[Mapping[str, Any]]) -> dict[str, dict[str, float]]:
    """By station, the mean shares sole and shifting."""
    found: dict[str, dict[str, float]] = {}
    for row in rows:
        if row["subject"] and row["part"] in ("sole", "shifting") and is_number(row["mean"]):
            found.setdefault(row["subject"], {})[row["part"]] = row["mean"]
    return found


def _any(shares: Mapping[str, Mapping[str, float]], shown: Sequence[str], part: str) -> bool:
    return any(shares[name].get(part, 0.0) > 0 for name in shown)


def _said(name: str, share: Mapping[str, float]) -> str:
    alone, shifting = (quantity(share.get(part, 0.0), "share") for part in ("sole", "shifting"))
    return f"{name}: {alone} of the time alone, {shifting} while it moves"


def _bars(shares: Mapping[str, Mapping[str, float]], shown: Sequence[str], time: str = "time") -> dict[str, Any]:
    bars = []
    for row, name in enumerate(shown):
        start = 0.0
        for look, part in ((SOLE, "sole"), (SHIFTING, "shifting")):
            share = 100 * shares[name].get(part, 0.0)
            if share > 0:
                bars.append(Bar(look, row, start, share, f"{share:.0f} %", f"{name}: {share:.1f} % of the {time}"))
            start += share
    layout = layout_of(64 + 32 * len(shown)) | fitting()
    layout["xaxis"] |= {"title": {"text": f"% of the {time}", "standoff": 6, "font": {**FONT, "size": 12}}, "nticks": 6}
    most = max(100 * sum(shares[name].values()) for name in shown)
    layout["xaxis"] |= {"range": [0, max(LEAST_AXIS, 1.04 * most)]}
    layout["yaxis"] |= _rows(shown)
    layout["margin"] |= {"t": 6}
    return {"data": bar_traces(bars), "layout": layout}


def _rows(names: Sequence[str]) -> dict[str, Any]:
    """An axis of rows from above, with their names."""
    ticks = {"tickvals": list(range(len(names))), "ticktext": [label(name) for name in names], "showgrid": False}
    return {**ticks, "range": [len(names) - 0.5, -0.5]}


def moments(log: EventLog, plan: Plan) -> tuple[np.ndarray, np.ndarray]:
    """(R + 1,) edges in seconds and (R,) the rank of the momentary bottleneck between them, -1 for nobody.

    The run's whole clock in at most ``CELLS`` even cells, in each the station that is so for most of it.
    """
    periods = active_periods(log, plan)
    edges_s, longest = longest_under_way(periods)
    cells_s = np.linspace(0.0, plan.horizon_s, CELLS + 1)
    n = len(plan.stations)
    spent_s = np.zeros((n + 1, CELLS))
    rank = np.where(longest >= 0, periods.station[longest], n) if longest.size else np.array([], dtype=int)
    for station in np.unique(rank):
        until_s = np.r_[0.0, np.cumsum(np.where(rank == station, np.diff(edges_s), 0.0))]
        spent_s[station] = np.diff(np.interp(cells_s, edges_s, until_s))
    spent_s[n] = np.diff(cells_s) - spent_s[:n].sum(axis=0)
    most = spent_s.argmax(axis=0)
    begins = np.flatnonzero(changes(most))
    return np.r_[cells_s[begins], cells_s[-1]], np.where(most[begins] == n, -1, most[begins])


def _strip_of(log: EventLog, plan: Plan) -> list[Block]:
    """When which station was it, in the first replication."""
    edges_s, rank = moments(log, plan)
    seen = set(rank.tolist())
    order = [station for station in worked_on(plan) if station in seen]
    if not order:
        return []
    row_of = {station: row for row, station in enumerate(order)}
    begin_ms = at_ms(plan.start_s, edges_s)
    bars = [
        Bar(
            MOMENT,
            row_of[station],
            int(begin_ms[n]),
            int(begin_ms[n + 1] - begin_ms[n]),
            said=f"{plan.stations[station].name}, {rough(edges_s[n + 1] - edges_s[n])}",
        )
        for n, station in enumerate(rank.tolist())
        if station >= 0
    ]
    layout = layout_of(64 + 26 * len(order)) | fitting()
    layout["xaxis"] |= clock_axis(plan.start_s, 0.0, plan.horizon_s, zoomed=True)
    layout["yaxis"] |= _rows([plan.stations[station].name for station in order])
    layout["margin"] |= {"t": 6, "b": 44}
    if plan.warm_up_s > 0:
        layout["shapes"] = [shaded(plan.start_s, 0.0, plan.warm_up_s)]
    said = f"{len(set(order))} stations take turns; {_turns(rank)} changes over the run"
    title = "Over the clock, first replication"
    note = "Shaded: warm-up, not counted." if plan.warm_up_s > 0 else ""
    figure = {"data": bar_traces(bars, clock=True), "layout": layout}
    return [Chart("bottleneck-strip", figure, said, title, [MOMENT.swatch], note=note)]


def _turns(rank: np.ndarray) -> int:
    """How often it went from one station to another."""
    somebody = rank[rank >= 0]
    return int(np.count_nonzero(somebody[1:] != somebody[:-1]))
