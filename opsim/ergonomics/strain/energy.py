"""What shifts cost in energy: postures, lifts and lowers, holding, walking, by Garg, Chaffin & Herrin 1978.

Not seen is work of the arms without a load, which widens the figure (none to light work of both arms), and so does
going down and coming up without a load (not at all to the body's part of the paper's lowering and lifting). Not in it
are tools, pushing and pulling, and loads that nobody told. Who walks has empty hands, but for a job of a product that
is carried, if its mass is told; who walks within a task walks at his own speed. Whose sex is not said has the range of
both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.joint_loads.strength import MASS_KG
from opsim.ergonomics.shift.stretch import Frames
from opsim.ergonomics.strain.bends import BENT_DEG, SQUAT_DEG, Bends, bending_kcal, bends_of, joined
from opsim.ergonomics.strain.garg import (
    ARM_WORK_KCAL_PER_MIN,
    POSTURES,
    holding_kcal_per_min,
    moved_kcal,
    walking_kcal_per_min,
)
from opsim.ergonomics.strain.lifts import Lifted, Lifts, loads_kg
from opsim.ergonomics.strain.stepping import stepping
from opsim.plan import Plan

SEXES = {"m": (1.0, 1.0), "f": (0.0, 0.0)}
"""The paper's number of a sex, at least and at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Energy:
    """Of W workers: (W, 2) kcal at least and at most of the time they were there and in no break, (W,) minutes of it;
    (W,) kcal and minutes of breaks, taken as sitting."""

    work_kcal: np.ndarray
    work_min: np.ndarray
    break_kcal: np.ndarray
    break_min: np.ndarray

    @property
    def kcal_per_min(self) -> np.ndarray:
        """(W, 2) over all the time they were there; nan for who never was."""
        return (self.work_kcal + self.break_kcal[:, None]) / _or_nan(self.work_min + self.break_min)[:, None]

    @property
    def work_kcal_per_min(self) -> np.ndarray:
        """(W, 2) breaks aside."""
        return self.work_kcal / _or_nan(self.work_min)[:, None]


class Spent:
    """A fold over workers' days: seconds bent and seated, kilograms held, ways within tasks, free arms, lifts, bends.

    bent_s, sitting_s, free_s : (W,) seconds; free_s of standing work without a load
    kg_s     : (W, 2) seconds of standing with a load in the hands, times its kilograms, at least and at most: no body
        and no share of its time says when hands are full at a mark
    walked_s : (W, tasks, 2) seconds of walking within a task, without and with its load
    """

    def __init__(self, plan: Plan):
        n, n_tasks = len(plan.workers), len(plan.tasks)
        self._loads_kg = np.r_[loads_kg(plan), 0.0, 0.0]
        self._sits = np.array([*(task.handling.sitting is True for task in plan.tasks), False, False])
        self._by_share = np.array([*(task.handling.by_share for task in plan.tasks), True, True])
        self._lifted, self._bends = Lifted(plan), list[Bends]()
        self.bent_s, self.sitting_s, self.free_s = (np.zeros(n) for _ in range(3))
        self.kg_s = np.zeros((n, 2))
        self.walked_s = np.zeros((n, n_tasks, 2))

    def add(self, frames: Frames, scores: Any = None) -> None:
        """The next stretch."""
        rank, seconds, sits = frames.worker, frames.seconds, self._sits[frames.task]
        bent = frames.measures[:, AT["trunk_flexion"]] >= BENT_DEG
        held_kg = np.where(frames.carrying, self._loads_kg[frames.task], 0.0)
        surely = self._by_share[frames.task] | frames.known
        self.bent_s[rank] += seconds[bent & ~sits].sum()
        self.sitting_s[rank] += seconds[sits].sum()
        works = frames.task >= 0
        walks = works & ~sits & stepping(frames.measures, frames.start_s, seconds)
        np.add.at(self.walked_s[rank], (frames.task[walks], (held_kg[walks] > 0).astype(int)), seconds[walks])
        self.kg_s[rank] += [seconds[some] @ held_kg[some] for some in (~walks & surely, ~walks)]
        self.free_s[rank] += seconds[((held_kg <= 0) | ~surely) & works & ~walks].sum()
        self._bends.append(bends_of(frames, held_kg > 0, works & ~sits & ~walks))
        self._lifted.add(frames)

    def lifts(self) -> Lifts:
        """All lifts and lowers."""
        return self._lifted.lifts()

    def bends(self) -> Bends:
        """All ways down and up."""
        return joined(self._bends)


def energy(
    spent: Spent,
    there_s: np.ndarray,
    break_s: np.ndarray,
    walk_s: np.ndarray,
    plan: Plan,
    carried_s: Sequence[tuple[int, float, float]] = (),
) -> Energy:
    """The energy of each of W workers, from what his body did and how long, (W,) each, he was there, in a break, and
    walking.

    carried_s : (worker, kilograms, seconds) of the walks among these on which he carries something
    """
    mass = np.array([MASS_KG if one.body.mass_kg is None else one.body.mass_kg for one in plan.workers], float)
    speed = np.array([one.walk_m_per_s for one in plan.workers], float)
    work_s = np.maximum(there_s - break_s, 0.0)
    standing_s = np.maximum(work_s - spent.bent_s - spent.sitting_s, 0.0)
    times_s = {"standing": standing_s, "bent": spent.bent_s, "sitting": spent.sitting_s}
    posture = mass * sum(POSTURES[name] * seconds / 60.0 for name, seconds in times_s.items())
    moving = walking_kcal_per_min(mass, speed) * (walk_s + spent.walked_s[:, :, 0].sum(axis=1)) / 60.0
    loaded = walking_kcal_per_min(mass[:, None], speed[:, None], loads_kg(plan)) * spent.walked_s[:, :, 1] / 60.0
    moving = moving + loaded.sum(axis=1)
    for rank, kg, seconds in carried_s:
        with_it, empty = (walking_kcal_per_min(mass[rank], speed[rank], load) for load in (kg, 0.0))
        moving[rank] += (with_it - empty) * seconds / 60.0
    arms = ARM_WORK_KCAL_PER_MIN["light"] * spent.free_s / 60.0
    kcal = (posture + moving)[:, None] + lifting_kcal(spent.lifts(), plan) + holding_kcal_per_min(spent.kg_s) / 60.0
    kcal[:, 1] += arms + _bending_kcal(spent.bends(), plan)
    return Energy(kcal, work_s / 60.0, mass * POSTURES["sitting"] * break_s / 60.0, break_s / 60.0)


def lifting_kcal(lifts: Lifts, plan: Plan) -> np.ndarray:
    """(W, 2) net kcal of each worker's lifts and lowers, at least and at most over what his sex may be."""
    load_kg, found = loads_kg(plan)[lifts.task], np.zeros((len(plan.workers), 2))
    lower = np.take_along_axis(lifts.knee_deg, lifts.height_m.argmin(axis=1)[:, None], axis=1)[:, 0]
    for rank, worker in enumerate(plan.workers):
        own = lifts.worker == rank
        mass = MASS_KG if worker.body.mass_kg is None else worker.body.mass_kg
        squat, sexes = lower[own] >= SQUAT_DEG, SEXES.get(worker.body.sex or "", (0.0, 1.0))
        taken_m, let_go_m = lifts.height_m[own].T
        by_sex = [moved_kcal(mass, load_kg[own], taken_m, let_go_m, sex, squat) for sex in sexes]
        found[rank] = np.minimum(*by_sex).sum(), np.maximum(*by_sex).sum()
    return found


def _bending_kcal(bends: Bends, plan: Plan) -> np.ndarray:
    """(W,) at most, over what each one's sex may be."""
    masses = [MASS_KG if one.body.mass_kg is None else one.body.mass_kg for one in plan.workers]
    sexes = [SEXES.get(one.body.sex or "", (0.0, 1.0)) for one in plan.workers]
    return np.array(
        [
            max(bending_kcal(bends, rank, mass, sex) for sex in either)
            for rank, (mass, either) in enumerate(zip(masses, sexes))
        ]
    )


def _or_nan(minutes: np.ndarray) -> np.ndarray:
    return np.where(minutes > 0, minutes, np.nan)
