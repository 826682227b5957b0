"""Two figures of all variants against each other, in the report of one of them: it is marked."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from opsim.kpi.better import Asked, read_asked
from opsim.report.frontier import axis_name, frontier_svg
from opsim.report.frontier_words import frontier_sentences
from opsim.report.material import Material
from opsim.report.same import Same
from opsim.report.section import Block, Section, Svg, Words
from opsim.report.words import is_number
from opsim.study.compare import NotComparable, scheduled_hours
from opsim.study.frontier import Frontier, frontier_of

OUTPUT = ("throughput_per_h", "throughput_per_calendar_h")
"""Where variants keep the same hours, and where not."""
STRAIN = ("rula_from_5_min_per_h", "reba_from_8_min_per_h", "owas_from_3_min_per_h", "trunk_beyond_60_min_per_h")
"""What stands against output where the scenario names no two figures: the first that is known."""
LEAST_PX = 480
NOT_ASKED = (
    "The scenario asks for no two figures, so output stands against exposure here; 'frontier: [FIGURE, FIGURE]' in the "
    "scenario says which it should be."
)


def section(material: Material) -> Section | None:
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


def usual_pair(siblings: Mapping[str, Any]) -> tuple[Asked, Asked] | tuple[()]:
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
def _found(same: Same, x: Asked, y: Asked) -> Frontier | str:
    """The frontier, or why there is none."""
    try:
        return frontier_of(same.of, x, y)
    except NotComparable as why:
        return str(why).rstrip(".")
