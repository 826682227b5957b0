"""How a stretch of a Gantt chart looks: jobs by product, what else stands at stations, and what people do.

Stations and people minute by minute: a Gantt chart of a typical hour, with more to either side to move to.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from opsim.plan import Plan
from opsim.report.material import Material
from opsim.report.numbers import clock, listing, rough
from opsim.report.page import Chart, Section, Words
from opsim.report.plot.plotly import FONT, GRID, OTHER, STATE_COLOURS, WORDS, at_ms, clock_axis, label, layout_of
from opsim.report.sections.common import worked_on
from opsim.report.sections.gantt_rows import (
    HOUR_S,
    MOST_HOURS,
    Stretch,
    Stretches,
    of_workers,
    on_servers,
    standing,
    typical_hour_s,
)
from opsim.report.sections.yamazumi import Bar, Look, bar_traces, fitting

PRODUCTS = (
    *(("#0072B2", "#ffffff"), ("#56B4E9", "#111111"), ("#009E73", "#ffffff"), ("#CC79A7", "#111111")),
    *(("#7E6BA8", "#ffffff"), ("#F0E442", "#111111"), ("#5c6570", "#ffffff"), ("#B5D6A5", "#111111")),
)
OF_STATION = {
    "setup": Look("set-up", "#8A6D3B", "#ffffff", "x"),
    "blocked": Look("done, no room behind it", "#D55E00", "#ffffff", "/"),
    "held": Look("stands there and waits", "#E69F00", "#111111", "."),
    "down": Look(WORDS["down"], "#7a1f1f", "#ffffff", "\\"),
    "repair": Look(WORDS["repair"], "#a05a5a", "#ffffff", "\\"),
    "closed": Look("closed", "#c9c4bb", "#111111"),
}
OF_WORKER = {
    "work": Look("people at work", "#43536b"),
    "setup": Look("people setting up", "#8A6D3B", "#ffffff", "x"),
    "walk": Look("walking", "#9aa1a9", "#111111", "/"),
    "break": Look("in a break", "#b9a7d6", "#111111"),
    "meeting": Look("in a meeting", "#7E6BA8", "#ffffff", "\\"),
    "held": Look("stands by a blocked job", "#CC79A7", "#111111", "/"),
    "team": Look("waits for the team", "#B58BB0", "#111111", "."),
    "absent": Look("absent", "#d6d6d6", "#111111", "x"),
}
WAIT_CAUSES = {
    "worker": "waits for a worker",
    "takt": "waits for the line to move",
    "line_stop": "the line stands",
    "parts": "waits for parts",
    "tool": "waits for a tool",
    "place": "waits for a place downstream",
    "pickup": "waits for a transporter",
    "away": "waits for who began it",
    "down": "the station is down",
    "setup": "waits for the set-up",
    "team": "waits for the team",
}


def products(plan: Plan) -> dict[int, Look]:
    """A colour a product, with dots where they come round again."""
    n = len(PRODUCTS)
    return {
        rank: Look(product.name, *PRODUCTS[rank % n], pattern="." if rank // n % 2 else "")
        for rank, product in enumerate(plan.products)
    }


def of_station(one: Stretch, plan: Plan, row: int, looks: dict[int, Look]) -> Bar:
    """A bar of what is on a lane of a station, or of the station as a whole."""
    whole = one.what in ("down", "repair", "closed")
    thick = 0.8 if whole else 0.8 / one.lanes
    middle = row if whole else row - 0.4 + 0.8 * (one.lane + 0.5) / one.lanes
    look = looks[one.product] if one.what == "work" else OF_STATION[one.what]
    name = plan.stations[one.row].name
    job = f", job {one.job}" if one.job >= 0 else ""
    cause = f", {WAIT_CAUSES[one.cause]}" if one.cause in WAIT_CAUSES else ""
    text = str(one.job) if one.what == "work" and one.lanes == 1 else ""
    return _bar(look, middle, one, plan, text, f"{name}{job}{cause}", thick)


def of_worker(one: Stretch, plan: Plan, row: int) -> Bar:
    """A bar of what somebody does."""
    station = plan.stations[one.station].name if one.station >= 0 else ""
    look = OF_WORKER.get(one.what) or Look(WORDS.get(one.what, one.what), *STATE_COLOURS.get(one.what, OTHER))
    job = f"job {one.job}" if one.job >= 0 else ""
    at = {"walk": "to "}.get(one.what, "") + station if station else ""
    text = station if one.what in ("work", "setup") else ""
    return _bar(look, row, one, plan, text, ", ".join(filter(None, (plan.workers[one.row].name, at, job))), 0.8)


def _bar(look: Look, row: float, one: Stretch, plan: Plan, text: str, said: str, thick: float) -> Bar:
    begin_ms, end_ms = at_ms(plan.start_s, [one.start_s, one.end_s]).tolist()
    lasts = rough(one.end_s - one.start_s)
    return Bar(look, row, begin_ms, end_ms - begin_ms, text, f"{said}, {lasts}", round(thick, 4))


MOST_BARS, MOST_ROWS, ROW_PX = 2200, 30, 26
MOST_HOURS_S = 16 * HOUR_S
"""To either side of the hour."""
MOST_IN_A_ROW, LENGTHS_S = 36, (3600.0, 1800.0, 1200.0, 600.0, 300.0)
"""Bars of a row that can be told apart at first, and what is then in sight."""


def gantt_section(material: Material) -> Section | None:
    """The chart and which time it shows; None where no rows are kept or nothing was worked on."""
    log, plan, start = material.log, material.plan, material.summary["start"]
    if log is None or not worked_on(plan):
        return None
    hour = typical_hour_s(log, plan)
    near = max(plan.window_s[0], hour[0] - MOST_HOURS_S), min(plan.window_s[1], hour[1] + MOST_HOURS_S)
    floor, people = on_servers(log, plan, *near), of_workers(log, *near)
    whole = shown_s(floor, people, plan.window_s, hour)
    jobs, done = floor.between(*whole), people.between(*whole)
    if not jobs:
        return None
    drawn = Drawn(
        plan,
        [rank for rank in worked_on(plan) if rank in {one.row for one in jobs}][:MOST_ROWS],
        [rank for rank in range(len(plan.workers)) if rank in {one.row for one in done}][:MOST_ROWS],
        _seen_s(floor, people, hour if whole[1] >= hour[1] else whole),
        whole,
    )
    figure, legend = _figure(drawn, [*jobs, *standing(log, plan, *whole)], done)
    said = f"{len(drawn.stations)} stations and {len(drawn.people)} workers, "
    said += f"{clock(start, drawn.seen_s[0])} to {clock(start, drawn.seen_s[1])}"
    left = _left_out(len(worked_on(plan)) - len(drawn.stations), len(plan.workers) - len(drawn.people))
    chart = Chart("gantt-clock", figure, said, "", legend, note=left)
    return Section("gantt", "Who does what, when", [Words(_shown_words(start, drawn)), chart], "Gantt")


@dataclass(frozen=True)
class Drawn:
    """What the chart shows: ranks of stations and of workers from above, the time in sight, and all that is there."""

    plan: Plan
    stations: Sequence[int]
    people: Sequence[int]
    seen_s: tuple[float, float]
    whole_s: tuple[float, float]


def shown_s(
    floor: Stretches, people: Stretches, window_s: tuple[float, float], hour: tuple[float, float]
) -> tuple[float, float]:
    """The time whose bars are in the page: about the hour, as much of the window as there is room for."""

    def fits(span: tuple[float, float]) -> bool:
        return floor.count(*span) + people.count(*span) <= MOST_BARS

    if not fits(hour):
        pieces = [(hour[0], hour[0] + (hour[1] - hour[0]) / n) for n in (2, 3, 4, 6, 12, 60)]
        return next((piece for piece in pieces if fits(piece)), pieces[-1])
    chosen = hour
    for hours in (0.5, 1, 2, 4, 8, 16):
        wider = max(window_s[0], hour[0] - hours * HOUR_S), min(window_s[1], hour[1] + hours * HOUR_S)
        chosen = wider if fits(wider) else chosen
    return chosen


def _seen_s(floor: Stretches, people: Stretches, hour: tuple[float, float]) -> tuple[float, float]:
    """As much of the hour as can be told apart at first: not too many bars in a row."""
    n_rows = max(1, len({*floor.columns["row"].tolist()}) + len({*people.columns["row"].tolist()}))
    each = (floor.count(*hour) + people.count(*hour)) / n_rows
    length_s = next((s for s in LENGTHS_S if each * s / HOUR_S <= MOST_IN_A_ROW), LENGTHS_S[-1])
    return hour[0], min(hour[1], hour[0] + length_s)


def _shown_words(start: str, drawn: Drawn) -> str:
    first, last = (clock(start, at_s) for at_s in drawn.seen_s)
    text = f"The first replication from {first} to {last.split()[-1]}"
    low_s, high_s = drawn.plan.window_s
    days = f" in the first {MOST_HOURS} h" if high_s - low_s > (MOST_HOURS + 1) * HOUR_S else ""
    text += f", of an hour with as much work as is usual{days}" if high_s - low_s >= 2 * HOUR_S else ""
    if drawn.whole_s != drawn.seen_s:
        text += f"; {clock(start, drawn.whole_s[0])} to {clock(start, drawn.whole_s[1])} is there to move to"
    return text + ". Numbers in bars are those of jobs, names in bars those of stations."


def _left_out(stations: int, people: int) -> str:
    """What is white, and who has no row."""
    none = [f"{n} {what}" for n, what in ((stations, "stations"), (people, "workers")) if n > 0]
    text = "White is idle, off shift or empty."
    return f"{text} Without a row, as nothing is done there or by them in this time: {listing(none)}." if none else text


def _figure(
    drawn: Drawn, on_floor: Iterable[Stretch], done: Iterable[Stretch]
) -> tuple[dict[str, Any], list[tuple[str, str]]]:
    """Rows of stations above rows of people, on one clock so that they move together; and its legend."""
    plan, looks = drawn.plan, products(drawn.plan)
    first = len(drawn.stations) + 1
    row_of_station = {rank: row for row, rank in enumerate(drawn.stations)}
    row_of_worker = {rank: first + row for row, rank in enumerate(drawn.people)}
    bars = [of_station(one, plan, row_of_station[one.row], looks) for one in on_floor if one.row in row_of_station]
    bars += [of_worker(one, plan, row_of_worker[one.row]) for one in done if one.row in row_of_worker]
    n_rows = first + len(drawn.people) if drawn.people else len(drawn.stations)
    names = [plan.stations[rank].name for rank in drawn.stations] + [plan.workers[rank].name for rank in drawn.people]
    rows = [*row_of_station.values(), *row_of_worker.values()]
    layout = layout_of(54 + ROW_PX * n_rows) | fitting()
    low, high = at_ms(plan.start_s, drawn.whole_s).tolist()
    layout["xaxis"] |= clock_axis(plan.start_s, *drawn.seen_s, zoomed=True) | {"side": "top"}
    layout["xaxis"] |= {"minallowed": low, "maxallowed": high}
    layout["yaxis"] |= {"tickvals": rows, "ticktext": [label(name) for name in names], "showgrid": False}
    layout["yaxis"] |= {"range": [n_rows - 0.4, -0.6]}
    layout["margin"] |= {"t": 44, "b": 8}
    layout["shapes"] = [_line(row + 0.5) for row in rows]
    layout["annotations"] = [_heading("People", first - 1)] if drawn.people else []
    seen = dict.fromkeys(bar.look for bar in bars)
    return {"data": bar_traces(bars, clock=True), "layout": layout}, [look.swatch for look in _in_order(seen, looks)]


def _in_order(seen: Iterable[Look], looks: dict[int, Look]) -> list[Look]:
    """Products, then what else stands at stations, then what people do."""
    order = [*looks.values(), *OF_STATION.values()]
    return sorted(seen, key=lambda look: order.index(look) if look in order else len(order))


def _line(y: float) -> dict[str, Any]:
    place = {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": y, "y1": y, "layer": "below"}
    return {**place, "line": {"color": GRID, "width": 1}}


def _heading(words: str, row: float) -> dict[str, Any]:
    place = {"xref": "paper", "x": 0, "xanchor": "left", "y": row, "yanchor": "middle", "showarrow": False}
    return {**place, "text": f"<b>{words}</b>", "font": {**FONT, "size": 13}}
