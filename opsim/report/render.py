"""The parts of a report in their order, and the sections of each, every one made by a module of its own.

A result as one HTML file that needs nothing else: no network, no other file, no script but its own two.

Every figure of a report as an SVG file of its own.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path

from opsim.files import whole_file, write_text
from opsim.plugins.registry import subjects_of
from opsim.report.material import Material
from opsim.report.numbers import clock
from opsim.report.page import Card, Chart, Legend, LegendEntry, Picture, Section, Svg, asset, flat, policy, template
from opsim.report.sections.summary import sentences


@dataclass(frozen=True)
class Part:
    """A part of the report: ``id`` of the page, its name among the links, its title, and what stands in it."""

    id: str
    nav: str
    title: str
    sections: Sequence[Section] = ()


@dataclass(frozen=True)
class Contents:
    """missing : (reason, which) of sections that could not be made"""

    parts: Sequence[Part]
    missing: Sequence[tuple[str, str]] = field(default=())

    @property
    def sections(self) -> list[Section]:
        """Of all parts."""
        return [section for part in self.parts for section in part.sections]


PARTS: dict[Part, tuple[str, ...]] = {
    Part("part-figures", "Figures", "Figures"): ("summary.kpi_section",),
    Part("part-scenarios", "Scenarios", "Scenarios beside each other"): (
        "scenarios.scenarios_section",
        "pareto.pareto_section",
        "variability.variance_budget_section",
    ),
    Part("part-flow", "Flow", "How the work flows"): (
        "bottleneck.bottleneck_section",
        "yamazumi.yamazumi_section",
        "summary.states_section",
        "wip.wip_section",
        "gantt.gantt_section",
        "cycle_times.cycle_times_section",
    ),
    Part("part-floor", "Floor", "On the floor"): (
        "spaghetti.spaghetti_section",
        "occupancy.occupancy_section",
        "exposure_map.exposure_map_section",
    ),
    Part("part-people", "People", "What people go through"): (
        "worker_timeline.worker_timeline_section",
        "exposure.exposure_section",
        "postures.posture_section",
        "reach.reach_section",
        "learning_fatigue.learning_and_fatigue_section",
        "variability.time_spread_section",
    ),
    Part("part-making", "How made", "How this was made"): (
        "motions.movements_section",
        "walking.walking_section",
        "motions.synthetic_times_section",
        "provenance.assumptions_section",
        "provenance.provenance_section",
        "provenance.stress_des_section",
    ),
}
"""By the part of the report they stand in: functions of opsim.report.sections, from Material to Section or None."""
FLOW = "part-flow"
"""Where the sections of subjects of somebody else stand, behind our own."""


def modules() -> list[str]:
    """Of all sections."""
    return [f"opsim.report.sections.{name.rpartition('.')[0]}" for names in PARTS.values() for name in names]


def contents_of(material: Material) -> Contents:
    """Every section that has something to say. A mistake of ours is not hidden: only what a file may cause is.

    OPSIM_TRACEBACK=1 lets what goes wrong in a section come through.
    """
    wrong: dict[str, list[str]] = {}
    found = {part: [_made(name, material, wrong) for name in names] for part, names in PARTS.items()}
    theirs = [make(material, kept) for subject, kept in subjects_of(material.plan) for make in subject.sections]
    parts = [
        Part(part.id, part.nav, part.title, [section for section in (*made, *more) if section is not None])
        for part, made in found.items()
        for more in [theirs if part.id == FLOW else []]
    ]
    return Contents(
        [part for part in parts if part.sections], [(reason, ", ".join(names)) for reason, names in wrong.items()]
    )


def _made(name: str, material: Material, wrong: dict[str, list[str]]) -> Section | None:
    """A section; where it cannot be made, its name is added to the reason in ``wrong``."""
    module, _, function = name.rpartition(".")
    made = getattr(import_module(f"opsim.report.sections.{module}"), function)
    try:
        section: Section | None = made(material)
    except (ValueError, OSError) as error:
        if os.environ.get("OPSIM_TRACEBACK"):
            raise
        wrong.setdefault(str(error), []).append(function.removesuffix("_section").replace("_", " "))
        return None
    return section


BUNDLE = "assets/plotly-cartesian.min.js"


@dataclass(frozen=True)
class Written:
    """A report that was written, and what is in it."""

    path: Path
    contents: Contents


def write_report(material: Material, path: str | Path) -> Written:
    """Write the report of one scenario variant. Raises OSError where it cannot be written."""
    path, contents = Path(path), contents_of(material)
    write_text(path, report_html(material, contents))
    return Written(path, contents)


def report_html(material: Material, contents: Contents | None = None) -> str:
    """The page as text. Names are escaped: in HTML by jinja2, in JSON by ``tojson``, in figures by ``escape``."""
    summary, contents = material.summary, contents or contents_of(material)
    bundle, script = asset(BUNDLE), asset("zoom.js") + asset("report.js")
    return template("report.html.jinja").render(
        summary=summary,
        window=[clock(summary["start"], at_s) for at_s in summary["window_s"]],
        sentences=sentences(summary),
        contents=contents,
        figures={name: figure for section in contents.sections for name, figure in section.charts.items()},
        bundle=bundle,
        script=script,
        style=asset("report.css"),
        policy=policy(bundle, script),
    )


LONGEST = 80
ROOT = re.compile(r"<svg\b(?![^>]*\bxmlns=)")


def write_figures(contents: Contents, folder: Path) -> list[Path]:
    """Write all figures and return where they are; charts have their own names, pictures the section's and a number.

    Raises OSError where they cannot be written.
    """
    paths = []
    for section in contents.sections:
        for name, svg in figures_of(section):
            paths.append(folder / f"{safe(name)}.svg")
            with whole_file(paths[-1]) as temporary:
                temporary.write_bytes(svg)
    return paths


def figures_of(section: Section) -> Iterator[tuple[str, bytes]]:
    """The name and the SVG of each figure of a section, in their order."""
    from opsim.report.plot.matplotlib_chart import chart_svg

    legend: tuple[LegendEntry, ...] = ()
    pictures: list[bytes] = []
    for block in flat(section.blocks):
        if isinstance(block, Legend):
            legend = tuple(block.entries)
        elif isinstance(block, Chart):
            yield block.id, chart_svg(block, legend)
        elif isinstance(block, Picture):
            pictures.append(block.svg)
        elif isinstance(block, Svg):
            pictures.append(_whole(block.text))
        elif isinstance(block, Card):
            pictures += [_whole(picture) for picture in block.pictures]
    yield from ((f"{section.id}-{n}", svg) for n, svg in enumerate(pictures, 1))


def safe(name: str) -> str:
    """A name of a file that leads nowhere else: letters, digits, - and _."""
    return re.sub(r"[^A-Za-z0-9_-]", "-", name)[:LONGEST] or "figure"


def _whole(text: str) -> bytes:
    """What stands in a page as a file of its own."""
    return ROOT.sub('<svg xmlns="http://www.w3.org/2000/svg"', text, count=1).encode()
