"""Made walking with contact: from standing, several steps at one speed, to standing, by drawn bodies.

``python -m emulator.synthetic.walking -o walking.npz`` fits the library of walking that is shipped.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from emulator.recordings.take import Recording, Take
from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import Body, joints_m
from emulator.synthetic.gait import Style, WalkPlan, draw_plan, draw_style, walk_pose
from emulator.synthetic.tasks import LICENCE, SOURCE, draw_bodies, write_library

if TYPE_CHECKING:
    from emulator.model.library import MotionLibrary

RATE_HZ = 60.0
SLOWEST_M_PER_S, FASTEST_M_PER_S = 0.6, 1.8
COMMAND = "python -m emulator.synthetic.walking"
STYLE_CV = 0.05
"""Between people, of the step at a given speed; half of the 10 % of the walk ratio."""


@dataclass(frozen=True, eq=False)
class WalkTruth:
    """What was put into made walks: a plan a take, and (W,) log step length of each worker over the usual one."""

    plans: tuple[WalkPlan, ...]
    worker_index: np.ndarray
    style: np.ndarray


def make_walks(
    n_workers: int = 8,
    n_takes: int = 5,
    *,
    seed: int = 0,
    rng: np.random.Generator | None = None,
    n_steps: Sequence[int] = (7, 8, 9, 10),
    speeds_m_per_s: tuple[float, float] = (SLOWEST_M_PER_S, FASTEST_M_PER_S),
    bodies: Sequence[Body] | None = None,
) -> tuple[Recording, WalkTruth]:
    """``n_takes`` walks by each worker, at speeds from slow to fast, and the truth about them.

    n_steps : numbers of full steps a take may have; a closing one follows
    Contact is exact: a bearing foot turns about its ankle, then about its toe, and that point does not move.
    Raises ValueError for no workers or takes, or speeds that are not positive and in order.
    """
    low, high = speeds_m_per_s
    if min(n_workers, n_takes) < 1 or not 0 < low <= high:
        raise ValueError(
            f"found {n_workers} workers, {n_takes} takes, speeds {low:g} to {high:g} m/s; expected one or more of each "
            "and speeds from slow to fast"
        )
    rng = np.random.default_rng(seed) if rng is None else rng
    drawn = draw_bodies(n_workers, rng)
    bodies = drawn if bodies is None else bodies
    log_step = STYLE_CV * rng.standard_normal(n_workers)
    takes, plans, owners = [], [], []
    for worker in range(n_workers):
        style = draw_style(rng)
        for k in range(n_takes):
            speed = low + (high - low) * (k + rng.random()) / n_takes
            count = int(rng.choice(n_steps))
            plan = draw_plan(bodies[worker], speed, count, int(rng.integers(2)), log_step[worker], rng)
            takes.append(_take(plan, style, rng, f"w{worker + 1}", f"r{k + 1}"))
            plans.append(plan)
            owners.append(worker)
    recording = Recording(tuple(takes), SOURCE, LICENCE)
    return recording, WalkTruth(tuple(plans), np.array(owners), log_step)


def walking_library(seed: int = 0, n_workers: int = 12, n_takes: int = 5, command: str = COMMAND) -> MotionLibrary:
    """The library of made walking: one task, ``walk``."""
    from emulator.cyclic.model import CyclicEmulator
    from emulator.model.library import MotionLibrary

    recording, _ = make_walks(n_workers, n_takes, seed=seed)
    model = CyclicEmulator.fit(recording, task="walk", command=command, seed=seed)
    return MotionLibrary.of(model, command=command, notes=(SOURCE,))


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the library of walking and say what was fitted."""
    write_library(COMMAND, main.__doc__, walking_library, arguments)


def _take(plan: WalkPlan, style: Style, rng: np.random.Generator, worker: str, trial: str) -> Take:
    time_s = np.arange(round(plan.end_s * RATE_HZ) + 1) / RATE_HZ
    pose, contact = walk_pose(plan, style, time_s, rng)
    skeleton = standard_skeleton()
    return Take(
        skeleton.names,
        skeleton.parents,
        joints_m(pose, plan.body),
        RATE_HZ,
        worker=worker,
        trial=trial,
        covariates={"cov_height_m": plan.body.stature_m, "cov_speed_m_per_s": plan.speed_m_per_s},
        contact=contact,
    )


if __name__ == "__main__":
    main()
