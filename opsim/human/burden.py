"""What a task asks of a worker's joints: the mean course of their loads, from a few draws."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

if TYPE_CHECKING:
    import numpy as np

    from opsim.plan import Plan
    from opsim.plan.handling import Handling
    from opsim.plan.tools import Moment

DRAWS = 16
PARTS = 4
"""Even parts of a performance in which the load on a joint is constant."""
LOOKS = 6
"""Postures looked at in each part."""


class Burdens:
    """The burdens of the workers of a plan, each made when it is first asked for, and kept with the task's model.

    Stream: ``burden, worker, task`` of the workforce, so they are the same in all replications of the same people.
    """

    def __init__(self, plan: Plan, workforce: int):
        self._plan, self._workforce = plan, workforce
        self._courses: dict[tuple[int, int], np.ndarray | None] = {}
        self._means: dict[int, float] = {}

    def course(self, worker: int, task: int) -> np.ndarray | None:
        """(PARTS, J) mean shares of strength, 0..1, of ``torque.JOINTS``; None where no posture is known of the task.

        Nothing is asked of a joint that the postures do not show, nor of one that something else carries: hips and
        knees of who sits, shoulders and elbows of who has his arms supported.
        """
        if (worker, task) not in self._courses:
            self._courses[worker, task] = _kept(self._plan, self._workforce, worker, task)
        return self._courses[worker, task]

    def heaviness(self, worker: int, task: int) -> float:
        """The mean load of a task on all joints, as times that of all tasks of the plan; 1 where it is not known."""
        mean = self._mean(worker)
        course = self.course(worker, task)
        return 1.0 if course is None or mean <= 0 else float(course.mean()) / mean

    def _mean(self, worker: int) -> float:
        if worker not in self._means:
            found = [self.course(worker, task) for task in range(len(self._plan.tasks))]
            known = [float(course.mean()) for course in found if course is not None]
            self._means[worker] = sum(known) / len(known) if known else 0.0
        return self._means[worker]


_KEPT: WeakKeyDictionary[Any, dict[tuple, np.ndarray | None]] = WeakKeyDictionary()


def _kept(plan: Plan, workforce: int, worker: int, task: int) -> np.ndarray | None:
    """The course, which is drawn once a process for the same people and the same task."""
    person, work = plan.workers[worker], plan.tasks[task]
    try:
        kept = _KEPT.setdefault(work.model, {})
    except TypeError:  # a model that cannot be looked up: it is drawn again for each run
        kept = {}
    key = (plan.seed, workforce, person.name, person.body, plan.across_tasks, work.name, work.handling)
    if key not in kept:
        kept[key] = _drawn(plan, workforce, worker, task)
    return kept[key]


def _drawn(plan: Plan, workforce: int, worker: int, task: int) -> np.ndarray | None:
    import numpy as np

    from opsim.effects import worker_effect
    from opsim.ergonomics.joint_loads.torque import shares, torques_nm
    from opsim.one_thread import one_blas_thread
    from opsim.streams import stream

    person, work = plan.workers[worker], plan.tasks[task]
    if getattr(work.model, "by_index", False):
        return None
    with one_blas_thread():
        effect = worker_effect(
            work.model, work.name, person.name, plan.seed, workforce, person.body, plan.across_tasks
        )  # fmt: skip
        drawn: Any = work.model.sample(
            DRAWS, stream(plan.seed, workforce, "burden", person.name, work.name, 0), worker=effect
        )
        if getattr(drawn, "skeleton", None) is None:
            return None
        n_times = 2 * PARTS * LOOKS + 1
        positions_m = np.asarray(drawn.positions_m(n_times=n_times))[:, 1::2]
    load_kg = _load_kg(work.handling, drawn, (np.arange(PARTS * LOOKS) + 0.5) / (PARTS * LOOKS))
    found = shares(torques_nm(positions_m, drawn.skeleton.names, person.body, load_kg), person.body)
    course = np.nan_to_num(found).mean(axis=0).reshape(PARTS, LOOKS, -1).mean(axis=1)
    return _but_carried(course, work.handling)


def _load_kg(handling: Handling, drawn: Any, at: np.ndarray) -> np.ndarray:
    """(n, T) kilograms in the hands at shares ``at`` (T,) of each performance."""
    start, end = _shares(handling.start, drawn), _shares(handling.end, drawn)
    return (handling.load_kg or 0.0) * ((at >= start[:, None]) & (at < end[:, None]))


def _shares(moment: Moment, drawn: Any) -> np.ndarray:
    import numpy as np

    if moment.mark < 0:
        return np.full(len(drawn.duration_s), moment.share)
    return np.asarray(np.asarray(drawn.mark_s)[:, moment.mark] / drawn.duration_s)


def _but_carried(course: np.ndarray, handling: Handling) -> np.ndarray:
    from opsim.ergonomics.joint_loads.torque import JOINTS

    if handling.sitting:
        course[:, [JOINTS.index("hips"), JOINTS.index("knees")]] = 0.0
    if handling.arms_supported:
        course[:, [at for at, joint in enumerate(JOINTS) if joint.endswith(("shoulder", "elbow"))]] = 0.0
    return course
