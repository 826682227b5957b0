"""Muscles that tire joint by joint: the loops of ``opsim.ergonomics.kernels.compartments``, compiled into steps."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine.bodies import UNKNOWN, bodies_of
from opsim.engine.fast_engine.machine import call_out, inlined, step
from opsim.engine.fast_engine.parts.humans import Human
from opsim.engine.fast_engine.parts.muscles import course_at, kept_muscles, muscles_at
from opsim.engine.fast_engine.parts.state import Floor, Station, Worker
from opsim.engine.fast_engine.parts.tiring import pass_to_now
from opsim.ergonomics.kernels.compartments import rest, rest_to_s, spend
from opsim.human.three_compartment import ThreeCompartment
from opsim.human.tired import piece

_piece = inlined(piece)
_shift: Any = inlined(ThreeCompartment.shift)


def install(build: Any, effects: Any) -> None:
    """Fresh muscles for every worker."""
    effects.pass_line, effects.rest_line = build.line(pass_on), build.line(has_to_rest)
    build.hang(effects.shifts, slowed)
    bodies = bodies_of(build)
    effects.ask_burden = bodies.asks(bodies.answer_course)
    effects.spare = kept_muscles(build, build.plan.human.fatigue.fresh().shares * 0.0)
    for worker in build.workers:
        worker.human.shares = kept_muscles(build, build.plan.human.fatigue.fresh().shares)
        worker.human.courses = bodies.courses_of(worker.rank)


@step
def slowed(floor: Floor, worker: Worker, station: Station) -> None:
    """By how much his log time shifts now."""
    human = worker.human
    pass_to_now(floor, human)
    human.effects.answer = _shift(human.effects.fatigue, human.tired)


@step
def pass_on(floor: Floor, human: Human) -> None:
    """Time goes on for his muscles until now, which is later than when it did last."""
    at_s, muscles = human.at_s, muscles_at(human.shares)
    human.at_s = floor.now
    task = human.task
    if task < 0:
        human.tired = rest(muscles, floor.now - at_s)
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
        human.tired = rest(muscles, work_s + rest_s)
    else:
        human.tired = spend(muscles, course_at(course), first, last, work_s, rest_s)


@step
def has_to_rest(floor: Floor, human: Human) -> None:
    """For how many seconds, until none of his joints is too tired."""
    effects = human.effects
    effects.answer = rest_to_s(muscles_at(human.shares), muscles_at(effects.spare), effects.rest.until)
