"""How fast muscles tire and recover, by region of the body; and how long they were seen to hold on.

3CC-r: muscle rests, works or is fatigued, joint by joint, by how much of its strength is asked of it.

What a task asks of a worker's joints: the mean course of their loads, from a few draws.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import log1p
from typing import TYPE_CHECKING, Any, ClassVar
from weakref import WeakKeyDictionary

from opsim.subjects.human.catalogue import Checked, parameter

if TYPE_CHECKING:
    import numpy as np

    from opsim.plan import Plan
    from opsim.subjects.exposure.plan import Handling
    from opsim.subjects.tools.plan import Moment

TRACKING_PER_S = 10.0
"""How fast resting muscle is taken into work and let go, 1/s: the papers' L, which they call arbitrary."""


@dataclass(frozen=True, slots=True)
class Muscle:
    """The muscles about a joint. tires_per_s, recovers_per_s : F and R of the three-compartment model, 1/s

    at_rest : r, how many times faster they recover where nothing is asked of them
    """

    tires_per_s: float
    recovers_per_s: float
    at_rest: float = 15.0


MUSCLES: dict[str, Muscle] = {
    "shoulder": Muscle(0.01820, 0.00168),
    "elbow": Muscle(0.00912, 0.00094),
    "grip": Muscle(0.00980, 0.00064, 30.0),
    "trunk": Muscle(0.00755, 0.00075),
    "knee": Muscle(0.01500, 0.00149),
    "ankle": Muscle(0.00589, 0.00058),
    "general": Muscle(0.00970, 0.00091),
}
"""F and R: Frey-Law, Looft & Heitsman 2012, J. Biomech. 45, 1803-1808, table 1 ("general" is all joints pooled, and
stands for the hip, which was not measured). r: Looft, Herkert & Frey-Law 2018, J. Biomech. 77, 16-25: 15 for ankle,
knee and elbow, 30 for the grip; shoulder, trunk and "general" were not measured and take 15: an assumption."""
ENDURANCE: dict[str, tuple[float, float]] = {
    "shoulder": (14.86, -1.83),
    "elbow": (17.98, -2.21),
    "grip": (33.55, -1.61),
    "trunk": (22.69, -2.27),
    "knee": (19.38, -1.88),
    "ankle": (34.71, -2.06),
    "general": (21.92, -1.98),
}
"""(b0 in seconds, b1): Frey Law & Avin 2010, Ergonomics 53, 109-129, table 2, power models of 194 publications."""


def endurance_seen_s(region: str, share: float) -> float:
    """Seconds for which a share of strength, above 0 to 1, was held on average: b0 * share ** b1 (Frey Law & Avin)."""
    b0, b1 = ENDURANCE[region]
    return b0 * share**b1


JOINTS: dict[str, str] = {
    "left_shoulder": "shoulder",
    "right_shoulder": "shoulder",
    "left_elbow": "elbow",
    "right_elbow": "elbow",
    "back": "trunk",
    "hips": "general",
    "knees": "knee",
}
"""The joints whose muscles are followed, in the order of every array of them, and whose rates each takes."""
LONGEST_S = 1e6


class Compartments:
    """shares : (J, 5) of each joint's muscles at work and fatigued, then their rates; worst : the most fatigued

    Written to as time passes, a run long: copying it would cost a tenth of a run.
    """

    __slots__ = ("shares", "worst")

    def __init__(self, shares: np.ndarray, worst: float = 0.0):
        self.shares, self.worst = shares, worst


@dataclass(frozen=True, slots=True)
class ThreeCompartment(Checked):
    """The three-compartment controller with faster recovery at rest, in closed form between changes of the load.

    Source of the equations: Xia & Frey Law 2008, J. Biomech. 41, 3046-3052, as printed in the appendix of Frey-Law,
    Looft & Heitsman 2012; faster recovery at rest (a load of 0): Looft, Herkert & Frey-Law 2018. Rates:
    this module. That the joint that is worst off slows the whole person, by slows at full fatigue and in proportion
    of log time before, is an assumption: the papers say how much force is left, not how fast people work.
    """

    does: ClassVar[str] = "muscles tire by the load on each joint; the most tired joint slows the person"
    source: ClassVar[str] = (
        "Xia, T. & Frey Law, L. A. (2008). J. Biomech. 41, 3046-3052; Frey-Law, L. A., Looft, J. M. & Heitsman, J. "
        "(2012). J. Biomech. 45, 1803-1808; Looft, J. M., Herkert, N. & Frey-Law, L. (2018). J. Biomech. 77, 16-25"
    )
    slows: float = parameter(
        0.2, "how much longer work takes where a joint's muscles are wholly fatigued", unit="share", neutral=0.0,
        at_least=0.0, at_most=10.0,
    )  # fmt: skip

    rests_below: float = parameter(
        0.05, "load under which muscles recover as at rest", unit="share", at_least=0.0, at_most=1.0
    )

    needs_burden: ClassVar[bool] = True

    def fresh(self) -> Compartments:
        """A rested person."""
        import numpy as np

        rates = ((m.tires_per_s, m.recovers_per_s, m.at_rest) for m in (MUSCLES[name] for name in JOINTS.values()))
        return Compartments(np.array([(0.0, 0.0, *of_joint) for of_joint in rates]))

    def felt(self, course: np.ndarray | None) -> np.ndarray | None:
        """A course of loads (P, J) as muscles take it: what is below ``rests_below`` is nothing; at 0 it is left alone.

        An assumption: the papers' rests are of no load at all, and no arm ever hangs quite without one.
        """
        import numpy as np

        return None if course is None else np.where(course < self.rests_below, 0.0, course)

    def passed(
        self, state: Compartments, course: np.ndarray | None, first: float, last: float, work_s: float, rest_s: float
    ) -> Compartments:
        """The same state after a piece of work, from share ``first`` to ``last`` of a performance, of some seconds, and
        a rest then.

        course : (P, J) loads on the joints, 0..1 of their strength, in even parts of the whole performance; None:
                 nothing is asked of any
        """
        if course is None:
            return self.rested(state, work_s + rest_s)
        state.worst = _kernel().spend(state.shares, course, first, last, work_s, rest_s)
        return state

    def rested(self, state: Compartments, seconds: float) -> Compartments:
        """The same state after a rest of some seconds."""
        state.worst = _kernel().rest(state.shares, seconds)
        return state

    def level(self, state: Compartments) -> float:
        """The fatigued share of the joint that is worst off."""
        return state.worst

    def by_joint(self, state: Compartments) -> dict[str, float]:
        """The fatigued share of each joint."""
        return dict(zip(JOINTS, state.shares[:, 1].tolist()))

    def shift(self, level: float) -> float:
        """Of log time: work takes exp(shift) times as long."""
        return log1p(self.slows) * level

    def rest_to_s(self, state: Compartments, level: float) -> float:
        """Seconds of rest after which no joint is above a level, above 0; to 1 ms, from above."""
        return float(_kernel().rest_to_s(state.shares, state.shares.copy(), level))


def endurance_s(region: str, share: float) -> float:
    """Seconds for which fresh muscles hold a share of strength, below 1: until none that rests is left to help.

    inf where they hold it for ever: below 1 / (1 + F / R).
    """
    from opsim.ergonomics.kernels.muscles import exhausted_s

    muscle = MUSCLES[region]
    found = float(exhausted_s(share, muscle.tires_per_s, muscle.recovers_per_s, LONGEST_S))
    return found if found >= 0 else float("inf")


@cache
def _kernel() -> Any:
    """The compiled loops, which nobody loads who does not need them."""
    from opsim.ergonomics.kernels import muscles

    return muscles


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

    from opsim.ergonomics.joint_loads import shares, torques_nm
    from opsim.streams import stream
    from opsim.threads import one_blas_thread

    person, work = plan.workers[worker], plan.tasks[task]
    if getattr(work.model, "by_index", False):
        return None
    with one_blas_thread():
        effect = plan.worker_effect(worker, work, workforce=workforce)
        drawn: Any = work.model.sample(
            DRAWS, stream(plan.seed, workforce, "burden", person.name, work.stream_name, 0), worker=effect
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
    from opsim.ergonomics.joint_loads import JOINTS

    if handling.sitting:
        course[:, [JOINTS.index("hips"), JOINTS.index("knees")]] = 0.0
    if handling.arms_supported:
        course[:, [at for at, joint in enumerate(JOINTS) if joint.endswith(("shoulder", "elbow"))]] = 0.0
    return course
