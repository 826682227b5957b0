"""What the schema cannot see: names that lead nowhere, work nobody can do, lines without end. One file a subject."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path

from opsim.problems import MOST_FOUND, Problem, nearest
from opsim.scenario.checks.lookup import reference_problems
from opsim.scenario.checks.names import (
    addition_problems,
    file_problems,
    material_problems,
    plugin_problems,
    point_problems,
)
from opsim.scenario.schema import Scenario
from opsim.scenario.tree import Node, child, entries
from opsim.subjects.breakdowns.checks import failure_problems
from opsim.subjects.exposure.checks import ergonomic_problems
from opsim.subjects.human.checks import human_problems
from opsim.subjects.lines.checks import line_problems, line_way_problems, sharing_problems
from opsim.subjects.lines.crew_checks import crew_problems
from opsim.subjects.material.checks import assembly_problems, card_problems, card_stock_problems, store_problems
from opsim.subjects.people.checks import (
    assignment_problems,
    patrol_problems,
    person_problems,
    rotation_problems,
    staffing_problems,
    team_problems,
)
from opsim.subjects.quality.checks import quality_problems
from opsim.subjects.release.checks import saturated_problems, source_problems
from opsim.subjects.routes.checks import routing_problems
from opsim.subjects.sequencing.checks import sequence_problems
from opsim.subjects.shifts.checks import shift_problems
from opsim.subjects.stations.checks import batch_problems
from opsim.subjects.tasks.checks import motion_problems, walking_emulator_problems
from opsim.subjects.tasks.hand_checks import hand_problems
from opsim.subjects.tools.checks import tool_problems
from opsim.subjects.transport.checks import carrying_problems, conveyor_problems, transporter_problems, walking_problems

WORD_OF = {
    "layout": "place",
    "libraries": "library",
    "shifts": "shift",
    "tasks": "task",
    "tools": "tool",
    "stations": "station",
    "stores": "station",
    "conveyors": "station",
    "products": "product",
    "workers": "worker",
}
"""What a thing of a section is called in messages; a step of a route is a station, whatever it is."""


def check_problems(tree: Node, base: Node, folder: Path) -> Iterator[Problem]:
    """The problems of a variant, without those that only follow from a section that cannot be read."""
    words = {WORD_OF[section] for section in chain(_unreadable(tree), _unreadable(base))}
    follows = re.compile(rf"\bno (?:{'|'.join(sorted(words))})\b") if words else None
    return (one for one in _problems(tree, base, folder) if follows is None or not follows.search(one.message))


def _unreadable(tree: Node) -> Iterator[str]:
    """Sections that are no block, or that are not there while an unknown key reads like them."""
    unknown = islice((key for key in entries(tree) if key not in Scenario.model_fields), MOST_FOUND)
    mistyped = {nearest(key, Scenario.model_fields) for key in unknown}
    for section in WORD_OF:
        node = child(tree, section)
        if section in mistyped if node is None else not isinstance(node.value, dict):
            yield section


def _problems(tree: Node, base: Node, folder: Path) -> Iterator[Problem]:
    """What every check finds, one by one; parts that the schema refuses are passed over.

    tree : the variant's tree, ``like`` resolved; base : the file's tree before any override.
    """
    return chain(
        reference_problems(tree),
        shift_problems(tree),
        staffing_problems(tree),
        patrol_problems(tree),
        assignment_problems(tree),
        sharing_problems(tree),
        routing_problems(tree),
        walking_problems(tree),
        point_problems(tree),
        store_problems(tree),
        assembly_problems(tree),
        batch_problems(tree),
        conveyor_problems(tree),
        transporter_problems(tree),
        carrying_problems(tree),
        material_problems(tree),
        source_problems(tree, folder),
        card_problems(tree),
        card_stock_problems(tree),
        saturated_problems(tree),
        failure_problems(tree),
        crew_problems(tree),
        line_problems(tree),
        line_way_problems(tree),
        sequence_problems(tree),
        quality_problems(tree),
        tool_problems(tree, folder),
        team_problems(tree),
        rotation_problems(tree),
        ergonomic_problems(tree, base, folder),
        hand_problems(tree, folder),
        human_problems(tree),
        addition_problems(tree, base),
        file_problems(tree, folder),
        motion_problems(tree, folder),
        person_problems(tree, folder),
        plugin_problems(tree),
        walking_emulator_problems(tree, folder),
    )
