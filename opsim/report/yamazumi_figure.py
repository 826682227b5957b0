"""Stacks drawn: bars of tasks in a row each, with what is beside the work, whiskers below, and what takt leaves."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from opsim.report.bars import Bar, Look, bar_traces, fitting
from opsim.report.figures import FONT, label, layout_of
from opsim.report.palette import INK
from opsim.report.yamazumi_stacks import LINE, PACE, SETTING_UP, TAKT, WALKING, Stack
from opsim.report.yamazumi_words import in_s

TASKS = (
    *(("#0072B2", "#ffffff"), ("#E69F00", "#111111"), ("#009E73", "#ffffff"), ("#CC79A7", "#111111")),
    *(("#56B4E9", "#111111"), ("#7E6BA8", "#ffffff"), ("#B5651D", "#ffffff"), ("#5c6570", "#ffffff")),
    *(("#8FCFB8", "#111111"), ("#8A3E6B", "#ffffff"), ("#17456B", "#ffffff"), ("#E8D96A", "#111111")),
)
BESIDE = {
    SETTING_UP: Look("set-up", "#8A6D3B", "#ffffff", "x"),
    WALKING: Look("walking", "#9aa1a9", "#111111", "/"),
}
MARK = "#B0410B"
MOST_LEGEND = 16
BELOW, THICK = 0.41, 0.6
"""Where a whisker lies below the middle of its row, and how thick the bar above it is: neither hides the other."""
FAR, BEYOND = 4.0, 1.3
"""Times the longest bar: a takt beyond is told in words alone. Times the longer of both: a whisker is cut there."""

MARKS = {
    TAKT: ("solid", "takt: open time over demand, for each visit"),
    LINE: ("solid", "takt of the line, for each visit"),
    PACE: ("dashed", "pace: how often a job came"),
}


def looks_of(names: Iterable[str]) -> dict[str, Look]:
    """A colour a name, again and again where there are many: their words are in the bars too."""
    n_looks = len(TASKS)
    return {
        name: Look(name, *TASKS[n % n_looks], pattern="." if n // n_looks % 2 else "")
        for n, name in enumerate(dict.fromkeys(names))
    }


def legend_of(shown: Sequence[Stack], looks: dict[str, Look]) -> list[Any]:
    """Entries of what the figure shows; of very many tasks none, as their names are in the bars."""
    tasks = [look.swatch for look in looks.values()] if len(looks) <= MOST_LEGEND else []
    beside = [look.swatch for what, look in BESIDE.items() if any(what in stack.beside for stack in shown)]
    whisker = [(INK, "solid", "P10 to P90 of the work")] if any(stack.p10 is not None for stack in shown) else []
    top = _top(shown)
    marks = [(MARK, *MARKS[by]) for by in MARKS if any(stack.by == by and _is_near(stack, top) for stack in shown)]
    return [*tasks, *beside, *whisker, *marks]


def stack_figure(shown: Sequence[Stack], looks: dict[str, Look]) -> dict[str, Any]:
    """The figure, a row a stack from above. looks : of ``looks_of`` all tasks in them"""
    bars, ends = [], []
    for row, stack in enumerate(shown):
        start = 0.0
        parts = [(looks[task], task, s) for task, s in stack.tasks.items()]
        parts += [(BESIDE[what], what, s) for what, s in stack.beside.items()]
        for look, name, seconds in parts:
            bars.append(Bar(look, row, start, seconds, name, f"{stack.name}: {in_s(seconds)}", THICK))
            start += seconds
        ends.append(start)
    top = _top(shown)
    layout = layout_of(66 + 40 * len(shown)) | fitting()
    layout["xaxis"] |= {"title": {"text": "s a visit, per server", "standoff": 6, "font": {**FONT, "size": 12}}}
    if not any(stack.p10 is not None for stack in shown):
        layout["xaxis"]["title"]["text"] = "s a finished job"
    layout["xaxis"] |= {"range": [0, 1.14 * top], "nticks": 7}
    layout["yaxis"] |= {"tickvals": list(range(len(shown))), "ticktext": [_tick(stack) for stack in shown]}
    layout["yaxis"] |= {"showgrid": False, "range": [len(shown) - 0.45, -0.55]}
    layout["margin"] |= {"t": 8}
    layout["annotations"] = [_total(row, stack, end, top) for row, (stack, end) in enumerate(zip(shown, ends))]
    marks = [trace for trace in (_whiskers(shown, top), *_marks(shown, top)) if trace is not None]
    return {"data": [*bar_traces(bars), *marks], "layout": layout}


def _top(shown: Sequence[Stack]) -> float:
    """The end of the axis: all bars, what is allowed unless it is far off, and whiskers as far as they go with it."""
    longest = max(stack.total_s for stack in shown)
    near = [stack.allowed_s for stack in shown if stack.allowed_s is not None and stack.allowed_s <= FAR * longest]
    top = max([longest, *near])
    return max(top, min(BEYOND * top, max((stack.p90 or 0.0 for stack in shown), default=0.0)))


def _tick(stack: Stack) -> str:
    return label(stack.name) + (f" /{stack.share_of}" if stack.share_of > 1 else "")


def _total(row: int, stack: Stack, end: float, top: float) -> dict[str, Any]:
    """The sum, behind its bar, or behind the mark where it would lie on it."""
    if stack.allowed_s is not None and end <= stack.allowed_s < end + 0.14 * top:
        end = stack.allowed_s
    place = {"x": end, "y": row, "xanchor": "left", "xshift": 5, "showarrow": False}
    return {**place, "text": in_s(stack.total_s), "font": {**FONT, "size": 12}, "bgcolor": "rgba(255,255,255,0.8)"}


def _whiskers(shown: Sequence[Stack], top: float) -> dict[str, Any] | None:
    known = [
        (row, stack, stack.p10, stack.p90)
        for row, stack in enumerate(shown)
        if stack.p10 is not None and stack.p90 is not None and stack.p90 - stack.p10 > 0.005 * stack.work_s
    ]
    if not known:
        return None
    error = {
        "type": "data",
        "symmetric": False,
        "array": [max(0.0, min(p90, 1.12 * top) - stack.work_s) for _, stack, _, p90 in known],
        "arrayminus": [max(0.0, stack.work_s - p10) for _, stack, p10, _ in known],
        "color": INK,
        "thickness": 1.8,
        "width": 4,
    }
    return {
        "type": "scatter",
        "mode": "markers",
        "name": "P10 to P90",
        "x": [stack.work_s for _, stack, _, _ in known],
        "y": [row + BELOW for row, *_ in known],
        "error_x": error,
        "marker": {"size": 5, "color": INK},
        "customdata": [f"{in_s(p10)} to {in_s(p90)}" for _, _, p10, p90 in known],
        "hovertemplate": "P10 to P90: %{customdata}<extra></extra>",
    }


def _marks(shown: Sequence[Stack], top: float) -> list[dict[str, Any]]:
    """What is allowed, as a line across each row; what is far off is told in words alone."""
    found = []
    for by, (dash, words) in MARKS.items():
        rows = [(row, stack) for row, stack in enumerate(shown) if stack.by == by and _is_near(stack, top)]
        if rows:
            x = [value for _, stack in rows for value in (stack.allowed_s, stack.allowed_s, None)]
            y = [value for row, _ in rows for value in (row - 0.45, row + 0.5, None)]
            line = {"color": MARK, "width": 2.6, "dash": "solid" if dash == "solid" else "4px,3px"}
            said = [f"{words}: {in_s(stack.allowed_s or 0.0)}" for _, stack in rows for _ in range(3)]
            mark = {"type": "scatter", "mode": "lines", "name": words, "x": x, "y": y, "line": line}
            found.append({**mark, "customdata": said, "hovertemplate": "%{customdata}<extra></extra>"})
    return found


def _is_near(stack: Stack, top: float) -> bool:
    return stack.allowed_s is not None and stack.allowed_s <= 1.001 * top


def said_of(shown: Sequence[Stack]) -> str:
    """The bars in words."""
    said = []
    for stack in shown:
        parts = ", ".join(f"{name} {in_s(s)}" for name, s in {**stack.tasks, **stack.beside}.items())
        allowed = f", of {in_s(stack.allowed_s)}" if stack.allowed_s is not None else ""
        said.append(f"{stack.name}: {in_s(stack.total_s)}{allowed} ({parts})")
    return "; ".join(said)
