"""Which station holds up the floor: how much of the time, when, and what its neighbours say of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from opsim.kpi.active import active_periods
from opsim.kpi.bottleneck import longest_under_way
from opsim.kpi.values import changes
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.report.bars import Bar, Look, bar_traces, fitting
from opsim.report.bottleneck_words import bottleneck_rows, bottleneck_sentences, time_open
from opsim.report.figures import FONT, label, layout_of
from opsim.report.flow_order import worked_on
from opsim.report.material import Material
from opsim.report.rough import rough
from opsim.report.section import Block, Bullets, Chart, Section, Words
from opsim.report.time_axis import at_ms, clock_axis, shaded
from opsim.report.words import is_number, quantity

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


def section(material: Material) -> Section | None:
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
