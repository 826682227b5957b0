"""Bars that lie in rows, each from one value to another, told apart by colour, by pattern and by the words in them.

Stacks drawn: bars of tasks in a row each, with what is beside the work, whiskers below, and what takt leaves.

Yamazumi: the work of a job stacked station by station, and of people, against takt.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from opsim.report.material import Material
from opsim.report.page import Block, Bullets, Chart, Section
from opsim.report.plot.plotly import FONT, INK, label, layout_of
from opsim.report.sections.yamazumi_stacks import (
    LINE,
    PACE,
    SETTING_UP,
    TAKT,
    WALKING,
    Stack,
    in_s,
    person_sentences,
    station_sentences,
    station_stacks,
    worker_stacks,
)

THICK = 0.74
"""Of a row."""
PALE = "#ffffff"
CLOCK = "<br>until %{x|%a %H:%M:%S}"
PATTERN = {".": {"size": 7, "solidity": 0.2}}


@dataclass(frozen=True, slots=True)
class Look:
    """words : for a legend, any text; ink : of the words within; pattern : of plotly's, "" for none."""

    words: str
    colour: str
    ink: str = "#ffffff"
    pattern: str = ""

    @property
    def swatch(self) -> tuple[str, str]:
        """(CSS background, words) of a legend."""
        return SWATCHES.get(self.pattern, "{0}").format(self.colour), self.words


SWATCHES = {
    "/": "repeating-linear-gradient(135deg, {0} 0 3px, #ffffff 3px 5px)",
    "\\": "repeating-linear-gradient(45deg, {0} 0 3px, #ffffff 3px 5px)",
    "x": "repeating-linear-gradient(45deg, {0} 0 3px, transparent 3px 5px), "
    "repeating-linear-gradient(135deg, {0} 0 3px, #ffffff 3px 5px)",
    ".": "radial-gradient(#ffffff 28%, {0} 36%) 0 0 / 5px 5px",
}


@dataclass(frozen=True, slots=True)
class Bar:
    """row : its middle, rows are 1 apart; start, length : in the axis' unit; text : within, where there is room;
    said : what pointing at it tells, behind the words of its look. Text and said may be anything: escaped here."""

    look: Look
    row: float
    start: float
    length: float
    text: str = ""
    said: str = ""
    thick: float = THICK


def bar_traces(bars: Iterable[Bar], *, clock: bool = False) -> list[dict[str, Any]]:
    """One trace a look and thickness: as few as can be, since each costs a page more than many bars.

    clock : whether the axis is a clock, and pointing at a bar tells when it ends
    """
    groups: dict[tuple[Look, float], list[Bar]] = {}
    for bar in bars:
        groups.setdefault((bar.look, bar.thick), []).append(bar)
    return [_trace(look, thick, of, CLOCK if clock else "") for (look, thick), of in groups.items()]


def in_hover(name: str) -> str:
    """A name within a template of what pointing tells: no markup, and nothing that plotly would fill in."""
    return label(name).replace("%{", "%&#123;")


def fitting() -> dict[str, Any]:
    """What a layout gets so that words stand in a bar only where they fit, and never smaller than can be read."""
    return {"barmode": "overlay", "uniformtext": {"minsize": 11, "mode": "hide"}}


def _trace(look: Look, thick: float, bars: Sequence[Bar], more: str) -> dict[str, Any]:
    pattern = {
        "shape": look.pattern,
        "fillmode": "overlay",
        "fgcolor": PALE,
        **PATTERN.get(look.pattern, {"size": 6, "solidity": 0.35}),
    }
    trace = {
        "type": "bar",
        "orientation": "h",
        "name": escape(look.words, quote=False),
        "base": [_short(bar.start) for bar in bars],
        "x": [_short(bar.length) for bar in bars],
        "y": [_short(bar.row) for bar in bars],
        "width": thick,
        "marker": {
            "color": look.colour,
            "line": {"color": PALE, "width": 0.5},
            **({"pattern": pattern} if look.pattern else {}),
        },
        "customdata": [escape(bar.said, quote=False) for bar in bars],
        "hovertemplate": f"{in_hover(look.words)}<br>%{{customdata}}{more}<extra></extra>",
    }
    if any(bar.text for bar in bars):
        trace |= {
            "text": [escape(bar.text, quote=False) for bar in bars],
            "textposition": "inside",
            "insidetextanchor": "middle",
            "textangle": 0,
            "insidetextfont": {"color": look.ink, "size": 12},
        }
    return trace


def _short(value: float) -> float:
    """As few digits as a screen can show."""
    value = round(float(value), 4)
    return int(value) if value == int(value) else value


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
BELOW, BAR_WIDTH = 0.41, 0.6
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
            bars.append(Bar(look, row, start, seconds, name, f"{stack.name}: {in_s(seconds)}", BAR_WIDTH))
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


MOST_ROWS = 30
HOW = (
    "Seconds of one visit of a job, over the station's servers (and over the jobs of a batch): the means of all "
    "replications, divided among tasks as in the first one. The whisker below a bar is P10 to P90 of the work of "
    "single visits, and goes on where it ends at the edge; set-up and walking are not in it."
)


def yamazumi_section(material: Material) -> Section | None:
    """Bars of stations and of people; None where there is no other station to compare with."""
    stacks = station_stacks(material) if material.plan.stations else []
    if len(stacks) < 2:
        return None
    shown = _most(stacks)
    more = (
        [f"{len(stacks) - len(shown)} more stations, with less work, are not drawn."]
        if len(shown) < len(stacks)
        else []
    )
    people = _people(material)
    blocks: list[Block] = [Bullets([*station_sentences(material, stacks), *more, *person_sentences(people)])]
    looks = looks_of(task for stack in shown for task in stack.tasks)
    chart = Chart(
        "yamazumi-stations", stack_figure(shown, looks), said_of(shown), "By station", legend_of(shown, looks), note=HOW
    )
    blocks.append(chart)
    blocks += _of_people(people)
    return Section("yamazumi", "Work against takt (Yamazumi)", blocks, "Yamazumi")


def _people(material: Material) -> list[Stack]:
    """Bars of workers, where who works where is not one and the same."""
    if material.log is None or len(material.plan.workers) < 2:
        return []
    stacks = worker_stacks(material.log, material.plan)
    tied = all(len(stack.tasks) == 1 and not stack.beside for stack in stacks)
    return [] if tied or len(stacks) < 2 else stacks


def _of_people(stacks: Sequence[Stack]) -> list[Block]:
    if not stacks:
        return []
    shown = _most(stacks)
    looks = looks_of(station for stack in shown for station in stack.tasks)
    note = "Seconds for each job that is finished while he is on duty, first replication."
    return [
        Chart(
            "yamazumi-people",
            stack_figure(shown, looks),
            said_of(shown),
            "By worker",
            legend_of(shown, looks),
            note=note,
        )
    ]


def _most(stacks: Sequence[Stack]) -> list[Stack]:
    """All in their order; of many those with most."""
    kept = sorted(stacks, key=lambda stack: -stack.total_s)[:MOST_ROWS]
    return [stack for stack in stacks if stack in kept]
