"""Models of human effects, compiled as ``subjects.human`` has them; and what Python is asked about bodies in a run.

How heavy tasks are on people, and how fast they gather dose, is looked at when it is asked for, as in the reference
engine: by draws of task models, which are Python's.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np

from opsim.engine.fast_engine.floor_state import NO_LUCK, Floor
from opsim.engine.fast_engine.human_state import Human, Model, pass_to_now, posts_by_strain
from opsim.engine.fast_engine.machine import call_out, inlined, step
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.machine.calling import handled
from opsim.engine.fast_engine.machine.expressions import METHODS
from opsim.engine.fast_engine.machine.intrinsics import call_floats
from opsim.engine.fast_engine.machine.structs import LAYOUTS
from opsim.engine.fast_engine.state import Station, Worker
from opsim.subjects.human.catalogue import catalogue
from opsim.subjects.human.fatigue import Lffrm, piece
from opsim.subjects.human.learning import Curve, DeJong, DualPhase, Hyperbolic, Plateau, StanfordB, Wright
from opsim.subjects.human.muscle_fatigue import JOINTS, PARTS, ThreeCompartment
from opsim.subjects.human.plan import EFFECTS

CURVES: tuple[Any, ...] = (Wright, Plateau, DeJong, StanfordB, Hyperbolic, DualPhase)
"""By their numbers, ``model.kind``."""
_shapes: Any = [inlined(curve.shape) for curve in CURVES]
_works: Any = [inlined(curve.work) for curve in CURVES]
_wright, _plateau, _de_jong, _stanford_b, _hyperbolic, _dual_phase = _shapes
_wright_work, _plateau_work, _de_jong_work, _stanford_b_work, _hyperbolic_work, _dual_phase_work = _works
multiplier_of: Any = inlined(Curve.multiplier)


@inlined
def _shape(self: Model, n: float) -> float:
    if self.kind == 0:
        return _wright(self, n)
    if self.kind == 1:
        return _plateau(self, n)
    if self.kind == 2:
        return _de_jong(self, n)
    if self.kind == 3:
        return _stanford_b(self, n)
    if self.kind == 4:
        return _hyperbolic(self, n)
    return _dual_phase(self, n)


METHODS["Model", "shape"] = _shape


@inlined
def work_of(model: Model, n: float) -> float:
    """What n repetitions take, in times of the first."""
    if model.kind == 0:
        return _wright_work(model, n)
    if model.kind == 1:
        return _plateau_work(model, n)
    if model.kind == 2:
        return _de_jong_work(model, n)
    if model.kind == 3:
        return _stanford_b_work(model, n)
    if model.kind == 4:
        return _hyperbolic_work(model, n)
    return _dual_phase_work(model, n)


_rested: Any = inlined(Lffrm.rested)


METHODS["Model", "rested"] = _rested
"""What ``Curve.multiplier`` and ``Lffrm.passed`` call of themselves."""


def refuse_strangers(plan: Any) -> None:
    """NotImplementedError names models of which no formula is compiled here."""
    known = {one.cls for one in catalogue()}
    classes = [type(model) for model in (getattr(plan, effect) for effect in EFFECTS) if model is not None]
    names = [f"the human effect {cls.__module__}.{cls.__qualname__}" for cls in classes if cls not in known]
    if names:
        raise NotImplementedError(", ".join(names))


def model_of(build: Any, model: Any) -> Any:
    """Its parameters where compiled methods find them."""
    made = build.arena.new("Model")
    made.kind = CURVES.index(type(model)) if type(model) in CURVES else 0
    for one in fields(model):
        if one.name in LAYOUTS["Model"].fields:
            setattr(made, one.name, getattr(model, one.name))
    return made


UNKNOWN = -1
"""The address of a course that nobody has asked for yet."""


class Bodies:
    """Of a floor that is set up. What was asked stays known until a replication has other people, or an answer fails.

    heaviness, rates, courses : (workers, tasks), NaN or UNKNOWN where nobody has asked; the engine reads them in place
    """

    def __init__(self, build: Any):
        self.plan, self.floor = build.plan, build.floor
        shape = len(build.plan.workers), len(build.plan.tasks)
        self.heaviness, self.rates = np.full(shape, np.nan), np.full(shape, np.nan)
        self.courses = np.full(shape, UNKNOWN, dtype=np.int64)
        self._kept: list[np.ndarray] = []
        self._orders: dict[int, list[int]] = {}
        self._workforce: int | None = None
        self._numbers: Any = None
        self._callbacks: list[Any] = []
        self._spoilt = False

    def begin(self, numbers: Any) -> None:
        """A replication begins; ``numbers`` : those of it, which are told where something fails."""
        self._numbers = numbers
        if self._spoilt or numbers.draws.workforce != self._workforce:
            self._spoilt, self._workforce = False, numbers.draws.workforce
            self._forget()

    def _forget(self) -> None:
        from opsim.subjects.human.muscle_fatigue import Burdens

        self.heaviness[:] = self.rates[:] = np.nan
        self.courses[:] = UNKNOWN
        self._kept.clear()
        self._orders.clear()
        self._burdens = Burdens(self.plan, self._workforce or 0)

    def heaviness_of(self, worker: int) -> int:
        """The address of a worker's row."""
        return int(self.heaviness[worker].ctypes.data)

    def rates_of(self, worker: int) -> int:
        """The address of a worker's row."""
        return int(self.rates[worker].ctypes.data)

    def courses_of(self, worker: int) -> int:
        """The address of a worker's row."""
        return int(self.courses[worker].ctypes.data)

    def asks(self, answer: Callable[[int, int], None]) -> int:
        """The address of a function of two numbers that the engine can call."""

        def asked(one: int, other: int) -> int:
            try:
                handled(answer, one, other)
            except BaseException as error:  # NOTE: nothing may be raised through compiled code
                self._spoilt = True  # what the engine goes on with until it ends is no answer
                self._numbers.failed, self.floor.error = error, NO_LUCK
            return 0

        self._callbacks.append(MORE(asked))
        return int(ctypes.cast(self._callbacks[-1], ctypes.c_void_p).value or 0)

    def answer_heaviness(self, worker: int, task: int) -> None:
        """How heavy a task is for a worker, beside the others."""
        self.heaviness[worker, task] = 1.0
        self.heaviness[worker, task] = self._burdens.heaviness(worker, task)

    def answer_course(self, worker: int, task: int) -> None:
        """The loads on a worker's joints in a task, as his muscles feel them."""
        self.courses[worker, task] = 0
        felt = self.plan.human.fatigue.felt(self._burdens.course(worker, task))
        if felt is not None:
            self._kept.append(np.ascontiguousarray(felt, dtype=np.float64))
            self.courses[worker, task] = self._kept[-1].ctypes.data

    def answer_rate(self, worker: int, task: int) -> None:
        """How fast a worker gathers dose at a task."""
        self.rates[worker, task] = 0.0
        self.rates[worker, task] = self._rates().per_s(worker, task)

    def answer_order(self, rotation: int, address: int) -> None:
        """The posts of a rotation, the heaviest first, where the engine wants them."""
        posts = self.plan.rotations[rotation].posts
        into: Any = (ctypes.c_int64 * len(posts)).from_address(address)
        into[:] = range(len(posts))
        if rotation not in self._orders:
            self._orders[rotation] = self._heaviest_first(rotation)
        into[:] = self._orders[rotation]

    def _heaviest_first(self, rotation: int) -> list[int]:
        plan = self.plan.rotations[rotation]
        return posts_by_strain(self.plan, self._rates(), plan.posts, plan.workers)

    def _rates(self) -> Any:
        from opsim.ergonomics.shift.worst import dose_rates_of

        return dose_rates_of(self.plan, self._workforce or 0)


def bodies_of(build: Any) -> Bodies:
    """The one of a floor."""
    for one in build.answers:
        if isinstance(one, Bodies):
            return one
    build.answers.append(Bodies(build))
    return build.answers[-1]


N_JOINTS, N_NUMBERS = len(JOINTS), 5


def kept_muscles(build: Any, shares: Any) -> int:
    """The address of (J, 5) numbers, as each replication begins with them."""
    assert shares.shape == (N_JOINTS, N_NUMBERS)
    return int(build.floats(shares.ravel()))


_piece = inlined(piece)
_muscles_shift: Any = inlined(ThreeCompartment.shift)


def install_muscles(build: Any, effects: Any) -> None:
    """Fresh muscles for every worker."""
    from opsim.ergonomics.kernels import muscles

    effects.pass_line, effects.rest_line = build.line(muscles_pass_on), build.line(muscles_have_to_rest)
    build.hang(effects.shifts, slowed_by_muscles)
    bodies = bodies_of(build)
    effects.ask_burden = bodies.asks(bodies.answer_course)
    effects.call_passed, effects.call_rest_to_s = (one.address for one in muscles.for_c())
    effects.spare = kept_muscles(build, build.plan.human.fatigue.fresh().shares * 0.0)
    for worker in build.workers:
        worker.human.shares = kept_muscles(build, build.plan.human.fatigue.fresh().shares)
        worker.human.courses = bodies.courses_of(worker.rank)


@step
def slowed_by_muscles(floor: Floor, worker: Worker, station: Station) -> None:
    """By how much his log time shifts now."""
    human = worker.human
    pass_to_now(floor, human)
    human.effects.answer = _muscles_shift(human.effects.fatigue, human.tired)


@step
def muscles_pass_on(floor: Floor, human: Human) -> None:
    """Time goes on for his muscles until now, which is later than when it did last."""
    at_s, call = human.at_s, human.effects.call_passed
    human.at_s = floor.now
    task = human.task
    if task < 0:
        human.tired = call_floats(call, human.shares, 0, N_JOINTS, 0, 0.0, 0.0, 0.0, floor.now - at_s)
        return
    first, last, work_s, rest_s = _piece(at_s, floor.now, human.begun_s, human.until_s, human.done)
    if floor.now >= human.until_s:
        human.task = -1
    if human.courses[task] == UNKNOWN:
        call_out(human.effects.ask_burden, human.worker.rank, task)
        if human.courses[task] == UNKNOWN:
            raise RuntimeError("nobody said how heavy a task is")
    course = human.courses[task]
    if not course:
        human.tired = call_floats(call, human.shares, 0, N_JOINTS, 0, 0.0, 0.0, 0.0, work_s + rest_s)
    else:
        human.tired = call_floats(call, human.shares, course, N_JOINTS, PARTS, first, last, work_s, rest_s)


@step
def muscles_have_to_rest(floor: Floor, human: Human) -> None:
    """For how many seconds, until none of his joints is too tired."""
    effects = human.effects
    until = effects.rest.until
    effects.answer = call_floats(effects.call_rest_to_s, human.shares, effects.spare, N_JOINTS, until)


_shift: Any = inlined(Lffrm.shift)
_passed: Any = inlined(Lffrm.passed)
_rest_to_s: Any = inlined(Lffrm.rest_to_s)


def install_fatigue(build: Any, effects: Any) -> None:
    """A state at every worker, where people tire."""
    model = build.plan.human.fatigue
    if model is None:
        return
    if isinstance(model, ThreeCompartment):
        install_muscles(build, effects)
        return
    effects.pass_line, effects.rest_line = build.line(pass_on), build.line(has_to_rest)
    build.hang(effects.shifts, slowed)
    bodies = bodies_of(build) if model.needs_burden else None
    even = build.floats([1.0] * len(build.tasks)) if bodies is None else 0
    for worker in build.workers:
        worker.human.heaviness = even if bodies is None else bodies.heaviness_of(worker.rank)
    if bodies is not None:
        effects.ask_burden = bodies.asks(bodies.answer_heaviness)


@step
def slowed(floor: Floor, worker: Worker, station: Station) -> None:
    """By how much his log time shifts now."""
    human = worker.human
    pass_to_now(floor, human)
    human.effects.answer = _shift(human.effects.fatigue, human.tired)


@step
def pass_on(floor: Floor, human: Human) -> None:
    """Time goes on for him until now, which is later than when it did last."""
    model, at_s = human.effects.fatigue, human.at_s
    human.at_s = floor.now
    task = human.task
    if task < 0:
        human.tired = _rested(model, human.tired, floor.now - at_s)
        return
    first, last, work_s, rest_s = _piece(at_s, floor.now, human.begun_s, human.until_s, human.done)
    if floor.now >= human.until_s:
        human.task = -1
    if human.heaviness[task] != human.heaviness[task]:  # NaN: nobody has asked yet
        call_out(human.effects.ask_burden, human.worker.rank, task)
    human.tired = _passed(model, human.tired, human.heaviness[task], first, last, work_s, rest_s)


@step
def has_to_rest(floor: Floor, human: Human) -> None:
    """For how many seconds, until he is rested enough."""
    effects = human.effects
    effects.answer = _rest_to_s(effects.fatigue, human.tired, effects.rest.until)
