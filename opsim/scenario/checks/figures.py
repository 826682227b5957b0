"""Figures that a study names: of a worker, station, task or product that is there."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping

from opsim.kpi.better import Asked, read_asked
from opsim.kpi.names import KPIS
from opsim.kpi.subjects import subject_of
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.positions import Node, Part, problem

SECTION_OF = {
    "worker": "workers",
    "station": "stations",
    "task": "tasks",
    "product": "products",
    "store": "stores",
    "conveyor": "conveyors",
    "line": "lines",
    "tool": "tools",
}
_COMPARED = re.compile("[<>]=?|=")
NOT_ONE = ("none", "worst")
"""Subjects that are no thing by name: nobody, and whoever has most of it."""


def figure_problems(node: Node, known: Mapping[str, Collection[str]], path: tuple[Part, ...]) -> Iterator[Problem]:
    """Of a text that names a figure, alone or with a limit behind it; what the schema refuses is passed over.

    known : names of the things of each section, in any variant
    """
    if not isinstance(node.value, str):
        return
    asked = read_asked(_COMPARED.split(node.value)[0])
    section = SECTION_OF.get(subject_of(asked.kpi), "")
    if asked.kpi not in KPIS or not section:
        return
    yield from _subject_problems(node, asked, known.get(section, ()), path)


def _subject_problems(node: Node, asked: Asked, names: Collection[str], path: tuple[Part, ...]) -> Iterator[Problem]:
    kind = subject_of(asked.kpi)
    if asked.subject and asked.subject not in (*names, *NOT_ONE):
        hint = did_you_mean(asked.subject, names, otherwise=f"known {kind}s") or f"there are no {kind}s in this file"
        yield problem(node.place, path, f"{asked.name}: no {kind} {shown(asked.subject)}", hint)
