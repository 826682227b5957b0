"""What two figures of several variants say together: which to look at, and which are beaten.

Two figures of every variant against each other, as SVG that stands in a page: intervals on both axes, the front.

Two figures of all variants against each other, in the report of one of them: it is marked.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from typing import Any

from opsim.kpi.catalogue import MORE, AskedFigure, read_asked
from opsim.kpi.parts import part_name
from opsim.report.material import Material, Same
from opsim.report.numbers import is_number, kpi_name, listing, scale_of
from opsim.report.page import Block, Section, Svg, Words
from opsim.report.plot.plotly import ACCENT, GRID, INK, MUTED
from opsim.report.plot.svg_chart import Box, Place, places, shortened, ticks
from opsim.study.compare import NotComparable, scheduled_hours
from opsim.study.pareto import Frontier, frontier_of

MOST_SAID, MOST_NAMED = 6, 10


def frontier_sentences(frontier: Frontier) -> list[str]:
    """Sentences, the most important first. frontier : of ``opsim.study.pareto``"""
    return [
        _front([point.variant for point in frontier.points if point.on_front]),
        *_beaten(frontier),
        *_behind(frontier),
        *_absent(frontier),
        *_unknown(frontier),
        *_hours(frontier),
    ]


def _front(names: Sequence[str]) -> str:
    if not names:
        return "No variant has both figures: there is no frontier."
    if len(names) == 1:
        return f"By the means {names[0]} is the best in both figures: there is nothing to weigh up."
    return (
        f"By the means no variant beats {_some(names)}: who chooses among them gains in one figure and pays in "
        "the other."
    )


def _some(names: Sequence[str]) -> str:
    """All where they are few; else the first, and how many more."""
    more = len(names) - MOST_NAMED
    return listing(list(names) if more <= 0 else [*names[:MOST_NAMED], f"{more:,} more"])


def _beaten(frontier: Frontier) -> Iterator[str]:
    beaten = [point for point in frontier.points if point.clearly_behind]
    if beaten:
        yield (
            f"Clearly beaten: {_said(beaten, 'clearly_behind')}. That is, worse in both figures, or in one with the "
            f"other the same, in {frontier.n} pairs of replications (95 %, all comparisons together, Holm 1979)."
        )


def _behind(frontier: Frontier) -> Iterator[str]:
    unclear = [point for point in frontier.points if point.behind and not point.clearly_behind]
    if unclear:
        pairs = "one pair" if frontier.n == 1 else f"{frontier.n} pairs"
        yield (
            f"Behind by the means only: {_said(unclear, 'behind')}. In {pairs} of replications this is not told from "
            "chance in both figures."
        )


def _said(points: Sequence[Any], by: str) -> str:
    """``a by b and c; d by b``; by : which field of a point names those before it"""
    said = "; ".join(f"{point.variant} by {_some(getattr(point, by))}" for point in points[:MOST_SAID])
    return f"{said}; and {len(points) - MOST_SAID} more" if len(points) > MOST_SAID else said


def _absent(frontier: Frontier) -> Iterator[str]:
    """Variants without a figure, as where the effect behind it is off."""
    by_figures: dict[tuple[str, ...], list[str]] = {}
    for variant, figures in frontier.absent:
        by_figures.setdefault(figures, []).append(variant)
    for figures, variants in by_figures.items():
        yield f"Not shown, as there is no {' and no '.join(figures)} there: {listing(variants)}."


def _unknown(frontier: Frontier) -> Iterator[str]:
    absent = dict(frontier.absent)
    unknown = [p.variant for p in frontier.points if (p.x.n == 0 or p.y.n == 0) and p.variant not in absent]
    if unknown:
        yield f"Not shown, as a figure was observed in no replication: {listing(unknown)}."


def _hours(frontier: Frontier) -> Iterator[str]:
    if frontier.other_hours:
        yield (
            "The variants are open for different hours, and a figure is per scheduled hour: nothing is called clear "
            "here; look at throughput_per_calendar_h."
        )


WIDE, TALL, LEFT, RIGHT, TOP, FOOT = 560, 430, 62, 22, 18, 60
KEY_ROW = 22
BESIDE_TITLE, DIGIT = 32.0, 8.9
"""Room for the name of the upright axis and for a digit of its numbers: long numbers move the picture to the right."""
FRONT, BEHIND, BEATEN = "front", "behind", "beaten"
KINDS = {
    FRONT: "no other variant beats it",
    BEHIND: "behind another by its means, not clearly",
    BEATEN: "clearly beaten",
}
COLOURS = {FRONT: (ACCENT, ACCENT), BEHIND: (ACCENT, "#ffffff"), BEATEN: (MUTED, "#ffffff")}
"""Edge and fill of a dot; bars have the colour of the edge."""


MOST_MARKS_NAMED, FEW_NAMED = 40, 12
"""Variants that all have a name and bars in the picture; of more, so many of the front have."""


@dataclass(frozen=True, slots=True)
class Axis:
    """From ``low`` to ``high`` in units for people, which are ``factor`` times SI and called ``word``; so in the
    picture: from ``begin`` to ``end``."""

    low: float
    high: float
    factor: float
    word: str
    begin: float
    end: float

    def at(self, value: float) -> float:
        """Where a value in SI stands."""
        return self.of_people(value * self.factor)

    def of_people(self, value: float) -> float:
        """Where a value in units for people stands."""
        return self.begin + (value - self.low) / (self.high - self.low) * (self.end - self.begin)

    @property
    def ticks(self) -> list[tuple[float, str]]:
        """Places and words of round numbers."""
        steps = ticks(self.low, self.high)
        apart = steps[1] - steps[0] if len(steps) > 1 else 1.0
        places = max(0, -math.floor(math.log10(apart) + 1e-9))
        return [(self.of_people(step), f"{step:,.{places}f}".replace("-", "\N{MINUS SIGN}")) for step in steps]


@dataclass(frozen=True, slots=True)
class Mark:
    """A variant in the picture: its name and kind, its centre and the ends of its bars (nan where it has none)."""

    name: str
    kind: str
    x: float
    y: float
    across: tuple[float, float]
    down: tuple[float, float]


def frontier_section(frontier: Frontier, hours: bool = False) -> dict[str, Any]:
    """What a page shows: ``title``, ``sentences``, ``picture`` (SVG text) and ``legend`` of (edge, fill, words).

    frontier : of ``opsim.study.pareto``; hours : whether the floor keeps hours
    """
    seen = {kind_of(point) for point in _known(frontier)}
    return {
        "title": f"{axis_name(frontier.y, hours)} against {axis_name(frontier.x, hours)}",
        "sentences": frontier_sentences(frontier),
        "picture": frontier_svg(frontier, hours),
        "legend": [(*COLOURS[kind], KINDS[kind]) for kind in COLOURS if kind in seen],
    }


def frontier_svg(frontier: Frontier, hours: bool = False, here: str = "", least_px: int = 0) -> str:
    """The picture of a Frontier; variants of which a mean is not known are left out.

    here : the variant to mark, with a legend in the picture; "" for none; least_px : no narrower than this
    """
    points = _known(frontier)
    y = _axis([point.y for point in points], frontier.y[3], TALL - FOOT, TOP)
    left = max(LEFT, BESIDE_TITLE + DIGIT * max((len(words) for _, words in y.ticks), default=0))
    x = _axis([point.x for point in points], frontier.x[3], left, WIDE - RIGHT)
    marks = [_mark(point, x, y) for point in points]
    named = _with_names(marks)
    key = list(_key(marks, here)) if here else []
    drawn = [
        *_grid(x, y),
        _front_line(marks, frontier.better_x),
        *(part for mark in named for part in _bars(mark)),
        *(_ring(mark.x, mark.y) for mark in marks if mark.name == here),
        *(_dot(mark) for mark in marks),
        *(_name(mark, *place) for mark, place in zip(named, _places(named))),
        *_titles(frontier, x, y, hours),
        *key,
    ]
    said = escape("; ".join(f"{mark.name}: {KINDS[mark.kind]}" for mark in marks))
    least = f"min-width:{least_px}px;" if least_px else ""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {TALL + KEY_ROW * len(key)}" role="img" '
        f'font-size="14" style="width:100%;{least}max-width:{WIDE + 100}px" aria-label="{said}">{"".join(drawn)}</svg>'
    )


def _key(marks: Sequence[Mark], here: str) -> Iterator[str]:
    """What the dots and the ring mean, a row each below the picture."""
    seen = {mark.kind for mark in marks}
    rows: list[tuple[str, str]] = [(kind, words) for kind, words in KINDS.items() if kind in seen]
    if any(mark.name == here for mark in marks):
        rows.append(("", f"{shortened(here)}, this report"))
    for row, (kind, words) in enumerate(rows):
        x, y = LEFT + 12.0, TALL + KEY_ROW * row + 4.0
        dot = _dot(Mark("", kind, x, y, (x, x), (y, y))) if kind else _ring(x, y)
        yield f"<g>{dot}{_text(words, x + 18, y + 5, INK, 'start')}</g>"


def _ring(x: float, y: float) -> str:
    """Around the dot of the variant that a report is of."""
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="10.5" fill="none" stroke="{INK}" stroke-width="1.8"/>'


def kind_of(point: Any) -> str:
    """FRONT, BEHIND or BEATEN."""
    return FRONT if point.on_front else BEATEN if point.clearly_behind else BEHIND


def axis_name(key: Sequence[str], hours: bool = False) -> str:
    """A figure in words, with its subject and part."""
    kpi, subject, part, _ = key
    return " · ".join(filter(None, (kpi_name(kpi, hours), subject, part_name(kpi, part))))


def _known(frontier: Frontier) -> list[Any]:
    return [point for point in frontier.points if is_number(point.x.mean) and is_number(point.y.mean)]


def _axis(intervals: Sequence[Any], unit: str, begin: float, end: float) -> Axis:
    """Holds all intervals, with a margin."""
    factor, word = scale_of(unit, max((abs(one.mean) for one in intervals), default=None))
    ends = [at * factor for one in intervals for at in (one.mean, one.low, one.high) if is_number(at)]
    low, high = min(ends, default=0.0), max(ends, default=1.0)
    margin = 0.09 * (high - low) or 0.05 * abs(high) or 1.0
    return Axis(low - margin, high + margin, factor, word, begin, end)


def _mark(point: Any, x: Axis, y: Axis) -> Mark:
    across, down = (x.at(point.x.low), x.at(point.x.high)), (y.at(point.y.high), y.at(point.y.low))
    return Mark(point.variant, kind_of(point), x.at(point.x.mean), y.at(point.y.mean), across, down)


def _grid(x: Axis, y: Axis) -> Iterator[str]:
    foot = TALL - FOOT
    for at, words in x.ticks:
        yield f'<path d="M{at:.1f} {TOP}V{foot}" stroke="{GRID}"/>' + _text(words, at, foot + 18, MUTED, "middle")
    for at, words in y.ticks:
        yield f'<path d="M{x.begin:g} {at:.1f}H{WIDE - RIGHT}" stroke="{GRID}"/>'
        yield _text(words, x.begin - 8, at + 4.5, MUTED, "end")


def _front_line(marks: Sequence[Mark], better_x: str) -> str:
    """Steps from one variant of the front to the next: what lies on their worse side is beaten by one of them."""
    front = sorted((mark.x, mark.y) for mark in marks if mark.kind == FRONT)
    worst_first = front if better_x == MORE else front[::-1]
    if len(front) < 2:
        return ""
    path = "M{:.1f} {:.1f}".format(*worst_first[0])
    path += "".join(f"V{y:.1f}H{x:.1f}" for x, y in worst_first[1:])
    return f'<path d="{path}" fill="none" stroke="{ACCENT}" stroke-width="1.6" stroke-dasharray="5 4"/>'


def _bars(mark: Mark) -> Iterator[str]:
    style = f'stroke="{COLOURS[mark.kind][0]}" stroke-width="2"'
    if all(map(math.isfinite, mark.across)):
        yield f'<path d="M{mark.across[0]:.1f} {mark.y:.1f}H{mark.across[1]:.1f}" {style}/>'
    if all(map(math.isfinite, mark.down)):
        yield f'<path d="M{mark.x:.1f} {mark.down[0]:.1f}V{mark.down[1]:.1f}" {style}/>'


def _dot(mark: Mark) -> str:
    edge, fill = COLOURS[mark.kind]
    return f'<circle cx="{mark.x:.1f}" cy="{mark.y:.1f}" r="5.5" stroke-width="2" fill="{fill}" stroke="{edge}"/>'


def _with_names(marks: Sequence[Mark]) -> list[Mark]:
    """Those with bars and a name: all where they are few, else some of the front, evenly from one end to the other."""
    if len(marks) <= MOST_MARKS_NAMED:
        return list(marks)
    front = sorted((mark for mark in marks if mark.kind == FRONT), key=lambda mark: (mark.x, mark.name))
    return front[:: -(-len(front) // FEW_NAMED)] if front else []


def _places(marks: Sequence[Mark]) -> list[Place]:
    taken = [box for mark in marks for box in _boxes(mark)]
    return places([(mark.x, mark.y) for mark in marks], [shortened(mark.name) for mark in marks], taken, WIDE)


def _boxes(mark: Mark) -> Iterator[Box]:
    """What a name must not hide: the dot and its bars."""
    yield mark.x - 7, mark.y - 7, mark.x + 7, mark.y + 7
    if all(map(math.isfinite, mark.across)):
        yield mark.across[0], mark.y - 2, mark.across[1], mark.y + 2
    if all(map(math.isfinite, mark.down)):
        yield mark.x - 2, mark.down[0], mark.x + 2, mark.down[1]


def _name(mark: Mark, x: float, y: float, anchor: str) -> str:
    return _text(shortened(mark.name), x, y, INK, anchor, ' font-weight="600"' if mark.kind == FRONT else "")


def _titles(frontier: Frontier, x: Axis, y: Axis, hours: bool) -> Iterator[str]:
    across, up = (
        f"{_with_unit(axis_name(key, hours), axis.word)} ({better} is better)"
        for key, axis, better in ((frontier.x, x, frontier.better_x), (frontier.y, y, frontier.better_y))
    )
    yield _text(across, (x.begin + WIDE - RIGHT) / 2, TALL - 14, INK, "middle")
    yield f'<g transform="translate(15 {TALL / 2:.0f}) rotate(-90)">{_text(up, 0, 0, INK, "middle")}</g>'


def _with_unit(name: str, word: str) -> str:
    """The unit behind the name, where the name does not say it."""
    return name if not word or name.endswith(word.removeprefix("per ")) else f"{name}, {word}"


def _text(words: str, x: float, y: float, colour: str, anchor: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}"{more}>{escape(words)}</text>'


OUTPUT = ("throughput_per_h", "throughput_per_calendar_h")
"""Where variants keep the same hours, and where not."""
STRAIN = ("rula_from_5_min_per_h", "reba_from_8_min_per_h", "owas_from_3_min_per_h", "trunk_beyond_60_min_per_h")
"""What stands against output where the scenario names no two figures: the first that is known."""
LEAST_PX = 480
NOT_ASKED = (
    "The scenario asks for no two figures, so output stands against exposure here; 'frontier: [FIGURE, FIGURE]' in the "
    "scenario says which it should be."
)


def pareto_section(material: Material) -> Section | None:
    """None for a run of one variant, and where nothing is asked for and nothing would be told."""
    siblings, here = material.siblings, material.summary["variant"]
    if len(siblings) < 2:
        return None
    texts = tuple(material.summary.get("frontier") or ())
    asked = tuple(read_asked(text) for text in texts) if len(texts) == 2 else usual_pair(siblings)
    if not asked:
        return None
    found = _found(Same(siblings), *asked)
    if isinstance(found, str):
        return Section("frontier", "Two figures against each other", [Words(f"Not drawn: {found}.")]) if texts else None
    known = [point for point in found.points if is_number(point.x.mean) and is_number(point.y.mean)]
    if len(known) < 2 or (not texts and _says_nothing(found)):
        return None
    hours = bool(scheduled_hours(siblings))
    title = f"{axis_name(found.y, hours)} against {axis_name(found.x, hours)}"
    said = frontier_sentences(found)
    blocks: list[Block] = [
        *map(Words, said),
        Svg(frontier_svg(found, hours, here, LEAST_PX), " ".join(said), wide=True),
        Words("Lines are 95 % intervals of the means." + ("" if texts else f" {NOT_ASKED}"), muted=True),
    ]
    return Section("frontier", title, blocks, "Frontier")


def usual_pair(siblings: Mapping[str, Any]) -> tuple[AskedFigure, AskedFigure] | tuple[()]:
    """Output and exposure, where all variants have both; nothing where they have not."""
    have = [{row["kpi"] for row in result.summary["kpis"] if not row["subject"]} for result in siblings.values()]
    known = set.intersection(*have)
    hours = set(scheduled_hours(siblings).values())
    output = OUTPUT[1] if len(hours) > 1 else OUTPUT[0]
    strain = next((kpi for kpi in STRAIN if kpi in known), None)
    return (read_asked(output), read_asked(strain)) if strain and output in known else ()


def _says_nothing(found: Frontier) -> bool:
    """Whether one of the figures is the same everywhere."""
    return any(len({getattr(point, side).mean for point in found.points}) < 2 for side in "xy")


@lru_cache(maxsize=1)
def _found(same: Same, x: AskedFigure, y: AskedFigure) -> Frontier | str:
    """The frontier, or why there is none."""
    try:
        return frontier_of(same.of, x, y)
    except NotComparable as why:
        return str(why).rstrip(".")
