"""The parts of a report in their order, and the sections of each, every one made by a module of its own."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module

from opsim.report.material import Material
from opsim.report.section import Section


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
    Part("part-figures", "Figures", "Figures"): ("kpi_tables",),
    Part("part-scenarios", "Scenarios", "Scenarios beside each other"): ("forest", "frontier_shown", "budget"),
    Part("part-flow", "Flow", "How the work flows"): (
        *("bottleneck_picture", "yamazumi", "states_shown", "wip", "gantt", "violins"),
    ),
    Part("part-floor", "Floor", "On the floor"): ("spaghetti", "heat_map", "exposure_map"),
    Part("part-people", "People", "What people go through"): (
        *("days", "exposed", "posture", "human_curves", "time_spread"),
    ),
    Part("part-making", "How made", "How this was made"): (
        *("movements", "walked", "made_up", "assumptions", "origin", "stress_des"),
    ),
}
"""By the part of the report they stand in: modules of opsim.report with ``section(material) -> Section | None``."""


def modules() -> list[str]:
    """Of all sections."""
    return [f"opsim.report.{name}" for names in PARTS.values() for name in names]


def contents_of(material: Material) -> Contents:
    """Every section that has something to say. A mistake of ours is not hidden: only what a file may cause is.

    OPSIM_TRACEBACK=1 lets what goes wrong in a section come through.
    """
    wrong: dict[str, list[str]] = {}
    found = {part: [_made(name, material, wrong) for name in names] for part, names in PARTS.items()}
    parts = [
        Part(part.id, part.nav, part.title, [section for section in made if section is not None])
        for part, made in found.items()
    ]
    return Contents(
        [part for part in parts if part.sections], [(reason, ", ".join(names)) for reason, names in wrong.items()]
    )


def _made(name: str, material: Material, wrong: dict[str, list[str]]) -> Section | None:
    """The section of a module; where it cannot be made, the module's name is added to the reason in ``wrong``."""
    made = import_module(f"opsim.report.{name}").section
    try:
        section: Section | None = made(material)
    except (ValueError, OSError) as error:
        if os.environ.get("OPSIM_TRACEBACK"):
            raise
        wrong.setdefault(str(error), []).append(name.removesuffix("_section").replace("_", " "))
        return None
    return section
