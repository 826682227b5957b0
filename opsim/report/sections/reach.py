"""Where hands go: bodies at the mark against the shelf, with time and exposure, the lowest height first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.angles import trunk_flexion_rad, upper_arm_angles
from opsim.ergonomics.measures import has_body
from opsim.ergonomics.redraw import luck_of
from opsim.libraries import HandTarget
from opsim.problems import natural_key
from opsim.report.material import Material
from opsim.report.numbers import digits
from opsim.report.page import Block, Grid, Panels, Section, Svg, Words
from opsim.report.plot.posture import posture_svg, room_of
from opsim.report.sections.exposure_summary import bars_by
from opsim.subjects.tasks.from_scenario import hand_targets
from opsim.subjects.tasks.plan import performed_tasks, task_said

DEGREE = "\N{DEGREE SIGN}"
N_SEEN = 16
"""Performances of a worker whose postures at the mark are averaged."""
MOST_PICTURES = 12
PICTURE_PX = 230
SAID = (
    "Bodies at the moment when the hands are where the scenario says: the shortest and the tallest of those who did "
    "the task in the first replication, each in a performance of about average length. The board is the height that "
    "was asked for. Times and angles are means of performances of the same worker."
)


@dataclass(frozen=True, eq=False)
class Posture:
    """One worker at one height.

    level : as the scenario names it; seconds : mean time of the task
    trunk_deg, arm_deg : mean flexion of the trunk, and mean elevation of the higher upper arm, at the mark
    joints_m : (J, 3) of a typical performance at the mark, of ``skeleton``
    """

    task: str
    target: HandTarget
    level: str
    worker: str
    stature_m: float | None
    seconds: float
    trunk_deg: float
    arm_deg: float
    joints_m: np.ndarray
    skeleton: Any


def reach_section(material: Material) -> Section | None:
    """None where no task says where its hands go, or no rows are kept."""
    found = postures_of(material) if material.log is not None else []
    if not found:
        return None
    blocks: list[Block] = [Words(SAID), Panels([_picture(one, found) for one in found[:MOST_PICTURES]], PICTURE_PX)]
    if len(found) > MOST_PICTURES:
        blocks.append(Words(f"Of {len(found)} pictures the first {MOST_PICTURES}; the table has them all.", muted=True))
    return Section("reach", "Where hands go", [*blocks, _table(found, material)], "Reach")


def postures_of(material: Material) -> list[Posture]:
    """Of each task with targets, mark and worker, the lowest height first."""
    scenario, plan = material.loaded.scenario, material.plan
    found, performed = [], performed_tasks(scenario)
    for number, task in enumerate(plan.tasks):
        said: Any = performed.get(task.name)
        hands = getattr(said, "hands", {})
        for target in hand_targets(said, scenario.layout) if hands else ():
            level = hands[target.mark]
            named = "" if isinstance(level, float) else ".".join(level)
            made = [_posture(material, number, rank, target, named) for rank in _shown(material, number)]
            found += [one for one in made if one is not None]
    return sorted(found, key=lambda one: (one.target.height_m, natural_key(one.task)))


def _shown(material: Material, task: int) -> list[int]:
    """The shortest and the tallest of those who did a task, by rank; one where nobody knows how tall they are."""
    log, workers = material.log, material.plan.workers
    did = sorted({int(rank) for rank in log["worker"][log["task"] == task] if rank >= 0})
    known = sorted((rank for rank in did if workers[rank].body.height_m is not None), key=lambda r: _tall(workers[r]))
    return list(dict.fromkeys([known[0], known[-1]])) if known else did[:1]


def _tall(worker: Any) -> float:
    return float(worker.body.height_m)


def _posture(material: Material, task: int, rank: int, target: HandTarget, level: str) -> Posture | None:
    """None where the task's times come without bodies in this run."""
    plan = material.plan
    name, person = plan.tasks[task].name, plan.workers[rank]
    block = luck_of(plan, rank, material.log.replication).performance(name, 0).block
    if not has_body(block):
        return None
    seconds = np.asarray(block.duration_s)
    mark = list(plan.tasks[task].model.mark_names).index(target.mark)
    some = block[:N_SEEN]
    joints_m = some.positions_m(some.mark_s[:, [mark]])[:, 0]
    typical = int(np.argmin(np.abs(seconds[:N_SEEN] - np.median(seconds))))
    names = some.skeleton.names
    arms = np.degrees(upper_arm_angles(joints_m, names).elevation_rad).max(axis=-1)
    trunk_deg = float(np.degrees(trunk_flexion_rad(joints_m, names)).mean())
    body = joints_m[typical], some.skeleton
    mean_s = float(seconds.mean())
    return Posture(name, target, level, person.name, person.body.height_m, mean_s, trunk_deg, float(arms.mean()), *body)


def _picture(one: Posture, among: Sequence[Posture]) -> Svg:
    alike = [other.joints_m for other in among if other.skeleton.names == one.skeleton.names]
    height = f"{one.target.height_m:.2f} m"
    said = f"{one.worker} at {one.task}, hands at {height}, trunk flexed {one.trunk_deg:.0f}{DEGREE}"
    picture = posture_svg(
        one.joints_m,
        one.skeleton,
        board_m=one.target.height_m,
        view="side",
        room=room_of(alike, one.skeleton, "side"),
        width_px=PICTURE_PX,
        label=said,
    )
    tall = "" if one.stature_m is None else f", {one.stature_m:.2f} m tall"
    return Svg(picture, said, f"{height}: {task_said(one.task)}", f"{one.worker}{tall}")


def _table(found: Sequence[Posture], material: Material) -> Grid:
    """Time and angles a height and worker; where exposure by task was asked for, that of the task too."""
    bars = {bar.subject: bar for bar in bars_by(material.summary["kpis"], "exposure_by_task")}
    columns = ["Hands at", "Task, mark", "Worker", "Time, s", f"Trunk flexed, {DEGREE}", f"Upper arm, {DEGREE}"]
    rows = []
    for one in found:
        at = f"{one.target.height_m:.2f} m" + (f", {one.level}" if one.level else "")
        words = [at, f"{task_said(one.task)}, {one.target.mark}", one.worker]
        row = [*words, f"{one.seconds:.2f}", f"{one.trunk_deg:.0f}", f"{one.arm_deg:.0f}"]
        if bars:
            row.append(digits(bars[one.task].five, 0.1) if one.task in bars else "")
        rows.append(row)
    return Grid([*columns, *(["RULA 5 or more, min/h"] if bars else [])], rows, "By height", words=3)
