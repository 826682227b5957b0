"""How many jobs were inside over the clock, and where: all together, and a strip a station, store and conveyor."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from opsim.plan import Plan
from opsim.plan.station import STORE
from opsim.report.bars import in_hover
from opsim.report.figures import FONT, label, layout_of
from opsim.report.flow_order import flow_order
from opsim.report.material import Material
from opsim.report.palette import ACCENT, GRID, INK
from opsim.report.rough import three_digits
from opsim.report.section import Block, Bullets, Chart, Section
from opsim.report.sentence import find
from opsim.report.steps import Steps, jobs_at, jobs_inside, room_of, thinned
from opsim.report.time_axis import SHADE, at_ms, clock_axis, shaded
from opsim.report.wip_words import wip_sentences
from opsim.report.words import digits

FILL, BAND, ROOM = "rgba(0,114,178,0.22)", "rgba(34,38,43,0.13)", "#B0410B"
MOST_POINTS, MOST_OF_A_STRIP, MOST_STRIPS = 600, 240, 16
TALL = 0.82
"""Of a strip's row: its highest level."""
ROOMY = 3.0
"""Times the highest level there: room beyond it is told in words, as the levels would shrink to nothing."""
Floor = Mapping[int, Steps]


def section(material: Material) -> Section | None:
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
