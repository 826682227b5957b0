"""How many there were over the clock: levels that go up and down in steps, and fewer of them for a picture.

What the jobs inside say: how many, whether they grow, and where there is no room left.

How many jobs were inside over the clock, and where: all together, and a strip a station, store and conveyor.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from opsim.log import CREATE, JOB_KINDS, LEAVING_KINDS, EventLog
from opsim.plan import Plan
from opsim.report.material import Material
from opsim.report.numbers import clock, digits, listing, percent, three_digits
from opsim.report.page import Block, Bullets, Chart, Section
from opsim.report.plot.plotly import ACCENT, FONT, GRID, INK, SHADE, at_ms, clock_axis, label, layout_of, shaded
from opsim.report.sections.common import flow_order
from opsim.report.sections.summary import find, with_interval
from opsim.report.sections.yamazumi import in_hover
from opsim.subjects.release.plan import SATURATED
from opsim.subjects.stations.plan import STORE


@dataclass(frozen=True, eq=False)
class Steps:
    """``level`` (N,) from ``at_s`` (N,) on, until the next; the last one until ``end_s``. The first begins at 0."""

    at_s: np.ndarray
    level: np.ndarray
    end_s: float

    @property
    def seconds(self) -> np.ndarray:
        """(N,) how long each level lasted."""
        return np.diff(self.at_s, append=self.end_s)

    def within(self, low_s: float, high_s: float) -> Steps:
        """The part of them between two times, which becomes its own clock's beginning and end."""
        first = max(0, int(np.searchsorted(self.at_s, low_s, side="right")) - 1)
        last = int(np.searchsorted(self.at_s, high_s, side="left"))
        at_s = np.maximum(self.at_s[first:last], low_s)
        return Steps(at_s, self.level[first:last], high_s)

    @property
    def mean(self) -> float:
        """Over the time they last."""
        seconds = self.seconds
        return float((self.level * seconds).sum() / seconds.sum()) if seconds.sum() > 0 else float("nan")


def steps_of(up_s: np.ndarray, down_s: np.ndarray, end_s: float) -> Steps:
    """The level that rises by one at some instants and falls by one at others; what happens at one instant is one
    step, and one that changes nothing is none."""
    times = np.concatenate([[0.0], up_s, down_s])
    by = np.concatenate([[0], np.ones(up_s.size), -np.ones(down_s.size)]).astype(np.int64)
    order = np.argsort(times, kind="stable")
    times, level = times[order], np.cumsum(by[order])
    settled = np.r_[times[1:] != times[:-1], True]
    times, level = times[settled], level[settled]
    kept = np.r_[True, level[1:] != level[:-1]] & (times < end_s)
    kept[:1] = True
    return Steps(times[kept], level[kept], end_s)


def jobs_inside(log: EventLog) -> Steps:
    """Jobs on the floor: created, and not left."""
    left = np.isin(log["kind"], LEAVING_KINDS)
    return steps_of(log["end_s"][log["kind"] == CREATE], log["end_s"][left], log.horizon_s)


def jobs_at(log: EventLog, n_points: int) -> list[Steps]:
    """By point of the flow: the jobs there, waiting, in work or kept. With those that are nowhere (before a gate, on a
    vehicle) they are ``jobs_inside``."""
    rows = np.flatnonzero((log["job"] >= 0) & (log["station"] >= 0) & np.isin(log["kind"], JOB_KINDS))
    rows = rows[np.argsort(log["station"][rows], kind="stable")]
    ends = np.searchsorted(log["station"][rows], np.arange(n_points + 1))
    parts = [rows[first:last] for first, last in pairwise(ends.tolist())]
    return [steps_of(log["start_s"][part], log["end_s"][part], log.horizon_s) for part in parts]


def thinned(steps: Steps, most: int) -> tuple[np.ndarray, np.ndarray]:
    """(times, levels) of a line in steps that has at most ``most`` points and ends where the clock does; of many, the
    first, the lowest and the highest level of each of even stretches of time, so that no peak is lost."""
    at_s, level = np.r_[steps.at_s, steps.end_s], np.r_[steps.level, steps.level[-1]]
    if at_s.size <= most:
        return at_s, level
    edges_s = np.linspace(0.0, steps.end_s, most // 3 + 1)
    begins = np.searchsorted(at_s, edges_s[:-1])
    begins = np.unique(begins[begins < at_s.size])
    order = np.lexsort([level, np.searchsorted(begins, np.arange(at_s.size), side="right")])
    lasts = np.r_[begins[1:], at_s.size] - 1
    kept = np.unique(np.r_[0, begins, order[begins], order[lasts], at_s.size - 1])
    return at_s[kept], level[kept]


def room_of(plan: Plan, rank: int) -> float:
    """Jobs that fit at a point, those kept behind its servers among them."""
    station = plan.stations[rank]
    return station.capacity + station.buffer_after


def share_full(steps: Steps, room: float, window_s: Sequence[float]) -> float:
    """The share of a window in which there is no room left."""
    counted = steps.within(*window_s)
    seconds = counted.seconds
    return (
        float(seconds[counted.level >= room].sum() / seconds.sum()) if np.isfinite(room) and seconds.sum() > 0 else 0.0
    )


GROWS, BY = 1.25, 2.0
"""Of the second half of the window to the first, and by so many jobs: more than chance on a floor that is settled."""
FULL, EMPTY = 0.1, 0.02
"""Shares of the window in which a point is full, or a store is empty, that are worth a word."""
MOST_NAMED = 3


def wip_sentences(material: Material, inside: Steps, floor: Mapping[int, Steps]) -> list[str]:
    """How many, whether they grow, where it is full, what runs out."""
    return [_many(material, inside), *_grows(material, inside), *_full(material, floor), *_empty(material, floor)]


def _many(material: Material, inside: Steps) -> str:
    start, (low_s, high_s) = material.summary["start"], material.plan.window_s
    counted = inside.within(low_s, high_s)
    most = int(counted.level.argmax())
    if counted.level.min() == counted.level[most]:
        return f"In the first replication there are always {counted.level[most]} jobs inside."
    text = f"In the first replication between {counted.level.min()} and {counted.level[most]} jobs are inside at once, "
    text += f"most at {clock(start, float(counted.at_s[most]))}"
    row = find(material.result.summary["kpis"], "work_in_progress")
    if row is None:
        return text + "."
    mean = with_interval(row).replace(" jobs", "")
    return f"On average {mean} jobs are inside. {text}."


def _grows(material: Material, inside: Steps) -> Iterator[str]:
    low_s, high_s = material.plan.window_s
    middle_s = (low_s + high_s) / 2
    first, second = inside.within(low_s, middle_s).mean, inside.within(middle_s, high_s).mean
    if second > GROWS * first and second - first > BY:
        yield (
            f"They grow: {three_digits(first)} in the first half of what is counted, {three_digits(second)} in the "
            "second. Either more comes in than goes out, or the floor has not settled: look at the warm-up and the "
            "horizon."
        )


def _full(material: Material, floor: Mapping[int, Steps]) -> Iterator[str]:
    plan = material.plan
    fed = _always_fed(plan)
    found = [
        (share_full(steps, room_of(plan, rank), plan.window_s), plan.stations[rank].name)
        for rank, steps in floor.items()
        if math.isfinite(room_of(plan, rank)) and room_of(plan, rank) > plan.stations[rank].servers and rank not in fed
    ]
    full = sorted((share, name) for share, name in found if share >= FULL)[::-1]
    if full:
        named = [f"{name} ({percent(share)} of the time)" for share, name in full[:MOST_NAMED]]
        yield f"No room is left at {listing(named)}: what comes before has to wait."


def _always_fed(plan: Plan) -> set[int]:
    """Ranks of the first stations of what is released whenever there is room: they are full by plan."""
    made = {product for source in plan.sources if source.kind == SATURATED for product, _ in source.mix}
    steps = [plan.products[product].route[step] for product in made for _, step in plan.products[product].start]
    return {rank for operation in steps for rank in operation.stations}


def _empty(material: Material, floor: Mapping[int, Steps]) -> Iterator[str]:
    plan = material.plan
    stores = [rank for rank, station in enumerate(plan.stations) if station.kind == STORE]
    found = []
    for rank in stores:
        row = find(material.result.summary["kpis"], "stock_empty", plan.stations[rank].name)
        if row is not None and row["mean"] >= EMPTY:
            found.append(f"{plan.stations[rank].name} for {with_interval(row)}")
    if found:
        yield f"Stock runs out: of the time, {listing(found[:MOST_NAMED])}."


FILL, BAND, ROOM = "rgba(0,114,178,0.22)", "rgba(34,38,43,0.13)", "#B0410B"
MOST_POINTS, MOST_OF_A_STRIP, MOST_STRIPS = 600, 240, 16
TALL = 0.82
"""Of a strip's row: its highest level."""
ROOMY = 3.0
"""Times the highest level there: room beyond it is told in words, as the levels would shrink to nothing."""
Floor = Mapping[int, Steps]


def wip_section(material: Material) -> Section | None:
    """Jobs inside over the clock of the first replication, and by point of the flow; None where no rows are kept."""
    log, plan = material.log, material.plan
    if log is None or not plan.stations:
        return None
    inside = jobs_inside(log)
    if inside.level.max(initial=0) < 1:
        return None
    floor = {rank: steps for rank, steps in enumerate(jobs_at(log, len(plan.stations))) if steps.level.any()}
    shown = _shown(floor, plan)
    blocks: list[Block] = [Bullets(wip_sentences(material, inside, floor))]
    blocks.append(_of_all(material, inside))
    if len(floor) > 1:
        more = len(floor) - len(shown)
        blocks.append(_by_point({rank: floor[rank] for rank in shown}, plan, more))
    return Section("wip", "Jobs inside, over the clock", blocks, "Jobs inside")


def _shown(floor: Floor, plan: Plan) -> list[int]:
    """Along the flow; of many those where most jobs were."""
    most = sorted(floor, key=lambda rank: -floor[rank].mean)[:MOST_STRIPS]
    return [rank for rank in flow_order(plan) if rank in most]


def _of_all(material: Material, inside: Steps) -> Chart:
    plan = material.plan
    at_s, level = thinned(inside, MOST_POINTS)
    line = {
        "type": "scatter",
        "mode": "lines",
        "name": "jobs inside",
        "x": at_ms(plan.start_s, at_s).tolist(),
        "y": level.tolist(),
        "line": {"color": ACCENT, "width": 1.5, "shape": "hv"},
        "fill": "tozeroy",
        "fillcolor": FILL,
        "hovertemplate": "%{x|%a %H:%M:%S}: %{y} inside<extra></extra>",
    }
    layout = layout_of(280) | {"shapes": _warm_up(plan)}
    layout["xaxis"] |= clock_axis(plan.start_s, 0.0, plan.horizon_s, zoomed=True)
    title = {"text": "jobs inside", "standoff": 8, "font": {**FONT, "size": 12}}
    layout["yaxis"] |= {"rangemode": "tozero", "title": title, "nticks": 6, "range": [0, 1.08 * level.max()]}
    layout["margin"] |= {"t": 10, "b": 44}
    legend: list[Any] = [(ACCENT, "solid", "first replication")]
    row = find(material.result.summary["kpis"], "work_in_progress")
    if row is not None:
        legend.append((INK, "dashed", f"mean of all {row['n']} replications, {digits(row['mean'], row['half_width'])}"))
        layout["shapes"] += _mean(plan, row)
        if row["half_width"] is not None:
            legend.append((BAND, "its 95 % interval"))
    said = f"between {level.min()} and {level.max()} jobs, {three_digits(inside.mean)} on average over the whole clock"
    if layout["shapes"] and plan.warm_up_s > 0:
        legend.append((SHADE, "warm-up, not counted"))
    return Chart("wip-inside", {"data": [line], "layout": layout}, said, "On the whole floor", legend)


def _warm_up(plan: Plan) -> list[dict[str, Any]]:
    return [shaded(plan.start_s, 0.0, plan.warm_up_s)] if plan.warm_up_s > 0 else []


def _mean(plan: Plan, row: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The mean over replications as a line across the window, on its interval."""
    x0, x1 = at_ms(plan.start_s, plan.window_s).tolist()
    line = {"color": INK, "width": 1.6, "dash": "dash"}
    found: list[dict[str, Any]] = [
        {"type": "line", "x0": x0, "x1": x1, "y0": row["mean"], "y1": row["mean"], "line": line}
    ]
    if row["half_width"] is not None and math.isfinite(row["half_width"]):
        band = {"x0": x0, "x1": x1, "y0": row["low"], "y1": row["high"], "fillcolor": BAND, "line": {"width": 0}}
        found.insert(0, {"type": "rect", "layer": "above", **band})
    return found


def _by_point(floor: Floor, plan: Plan, more: int) -> Chart:
    """Strips below each other, each on a scale of its own; the figures say what it is."""
    n, data, shapes, ticks = len(floor), [], _warm_up(plan), []
    for place, (rank, steps) in enumerate(floor.items()):
        base, station = float(n - 1 - place), plan.stations[rank]
        highest, room = int(steps.level.max()), room_of(plan, rank)
        scale = max(highest, room if room <= ROOMY * highest else 0) / TALL
        data.append(_strip(steps, plan, station.name, base, scale))
        shapes.append(_level(plan, base, GRID, "solid", 1.0))
        words = f"{highest}"
        if room <= ROOMY * highest:
            shapes.append(_level(plan, base + room / scale, ROOM, "dash", 1.2))
        if math.isfinite(room):
            words = f"{highest} of {room:g}"
        ticks.append((base + TALL / 2, f"{label(station.name)}<br>{words}"))
    layout = layout_of(60 + 50 * n) | {"shapes": shapes}
    layout["xaxis"] |= clock_axis(plan.start_s, 0.0, plan.horizon_s, zoomed=True)
    layout["yaxis"] |= {"tickvals": [at for at, _ in ticks], "ticktext": [name for _, name in ticks], "showgrid": False}
    layout["yaxis"] |= {"range": [-0.06, n + 0.12]}
    layout["margin"] |= {"t": 4, "b": 44}
    legend = [(ACCENT, "solid", "jobs there, waiting or in work"), (ROOM, "dashed", "room there, buffer and servers")]
    note = "First replication. Each strip has a scale of its own; below its name the most jobs at once, and the room."
    if more > 0:
        note += f" {more} more, with fewer jobs, are not drawn."
    said = "; ".join(_said(steps, plan, rank) for rank, steps in floor.items())
    return Chart("wip-points", {"data": data, "layout": layout}, said, "Where they are", legend, note=note)


def _strip(steps: Steps, plan: Plan, name: str, base: float, scale: float) -> dict[str, Any]:
    at_s, level = thinned(steps, MOST_OF_A_STRIP)
    x = at_ms(plan.start_s, at_s).tolist()
    y = [round(base + value / scale, 3) for value in level.tolist()]
    return {
        "type": "scatter",
        "mode": "lines",
        "x": [x[0], *x, x[-1]],
        "y": [base, *y, base],
        "customdata": [0, *level.tolist(), 0],
        "line": {"color": ACCENT, "width": 1.2, "shape": "hv"},
        "fill": "toself",
        "fillcolor": FILL,
        "hoveron": "points",
        "hovertemplate": f"{in_hover(name)}, %{{x|%a %H:%M:%S}}: %{{customdata}}<extra></extra>",
    }


def _level(plan: Plan, at: float, colour: str, dash: str, width: float) -> dict[str, Any]:
    x0, x1 = at_ms(plan.start_s, [0.0, plan.horizon_s]).tolist()
    line = {"color": colour, "width": width, "dash": dash}
    return {"type": "line", "x0": x0, "x1": x1, "y0": at, "y1": at, "line": line}


def _said(steps: Steps, plan: Plan, rank: int) -> str:
    room = room_of(plan, rank)
    of = f" of {room:g}" if math.isfinite(room) else ""
    what = "lie" if plan.stations[rank].kind == STORE else "are"
    counted = steps.within(*plan.window_s)
    mean = f"{three_digits(counted.mean)} {what} there on average"
    return f"{plan.stations[rank].name}: {mean}, at most {steps.level.max()}{of}"
