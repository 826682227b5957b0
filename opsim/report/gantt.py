"""Stations and people minute by minute: a Gantt chart of a typical hour, with more to either side to move to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from opsim.plan import Plan
from opsim.report.bars import Look, bar_traces, fitting
from opsim.report.figures import FONT, label, layout_of
from opsim.report.flow_order import worked_on
from opsim.report.gantt_looks import OF_STATION, of_station, of_worker, products
from opsim.report.gantt_rows import (
    HOUR_S,
    MOST_HOURS,
    Stretch,
    Stretches,
    of_workers,
    on_servers,
    standing,
    typical_hour_s,
)
from opsim.report.material import Material
from opsim.report.palette import GRID
from opsim.report.section import Chart, Section, Words
from opsim.report.time_axis import at_ms, clock_axis
from opsim.report.words import clock, listing

MOST_BARS, MOST_ROWS, ROW_PX = 2200, 30, 26
MOST_HOURS_S = 16 * HOUR_S
"""To either side of the hour."""
MOST_IN_A_ROW, LENGTHS_S = 36, (3600.0, 1800.0, 1200.0, 600.0, 300.0)
"""Bars of a row that can be told apart at first, and what is then in sight."""


def section(material: Material) -> Section | None:
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
