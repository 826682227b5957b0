"""What the schema cannot see: names that lead nowhere, work nobody can do, lines without end. One file a subject."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from pathlib import Path

from opsim.problems import Problem
from opsim.scenario.checks.additions import addition_problems
from opsim.scenario.checks.assembly import assembly_problems
from opsim.scenario.checks.assignment import assignment_problems
from opsim.scenario.checks.batches import batch_problems
from opsim.scenario.checks.card_stock import card_stock_problems
from opsim.scenario.checks.cards import card_problems
from opsim.scenario.checks.carrying import carrying_problems
from opsim.scenario.checks.conveyors import conveyor_problems
from opsim.scenario.checks.crews import crew_problems
from opsim.scenario.checks.ergonomics import ergonomic_problems
from opsim.scenario.checks.failures import failure_problems
from opsim.scenario.checks.files import file_problems
from opsim.scenario.checks.human import human_problems
from opsim.scenario.checks.line_ways import line_way_problems
from opsim.scenario.checks.lines import line_problems
from opsim.scenario.checks.material import material_problems
from opsim.scenario.checks.motions import motion_problems
from opsim.scenario.checks.people import person_problems
from opsim.scenario.checks.plugins import plugin_problems
from opsim.scenario.checks.points import point_problems
from opsim.scenario.checks.quality import quality_problems
from opsim.scenario.checks.references import reference_problems
from opsim.scenario.checks.rotations import rotation_problems
from opsim.scenario.checks.routing import routing_problems
from opsim.scenario.checks.saturated import saturated_problems
from opsim.scenario.checks.sequence import sequence_problems
from opsim.scenario.checks.shifts import shift_problems
from opsim.scenario.checks.sources import source_problems
from opsim.scenario.checks.staffing import patrol_problems, staffing_problems
from opsim.scenario.checks.stores import store_problems
from opsim.scenario.checks.teams import team_problems
from opsim.scenario.checks.tools import tool_problems
from opsim.scenario.checks.transporters import transporter_problems
from opsim.scenario.checks.walking import walking_problems
from opsim.scenario.checks.walking_emulator import walking_emulator_problems
from opsim.scenario.checks.work_sharing import sharing_problems
from opsim.scenario.positions import Node


def check_problems(tree: Node, base: Node, folder: Path) -> Iterator[Problem]:
    """The problems of a variant, found one by one; parts that the schema refuses are passed over.

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
        human_problems(tree),
        addition_problems(tree, base),
        file_problems(tree, folder),
        motion_problems(tree, folder),
        person_problems(tree, folder),
        plugin_problems(tree),
        walking_emulator_problems(tree, folder),
    )
