"""What becomes of people as they work: each effect hangs in, and is asked where somebody's next time is drawn."""

from __future__ import annotations

from math import exp
from typing import Any

from opsim.engine.floor import (
    human_clock,
    human_errors,
    human_fatigue,
    human_learning,
    human_pace,
    human_rest,
)
from opsim.engine.floor.machine import step
from opsim.engine.floor.parts.doses import dose_so_far, rate_of
from opsim.engine.floor.parts.memories import memory_stops, memory_works
from opsim.engine.floor.parts.models import model_of, refuse_strangers
from opsim.engine.floor.parts.state import Floor, Station, Worker
from opsim.engine.floor.parts.tiring import note_that_he_works, stops_tiring, tires
from opsim.plan.human import EFFECTS

INSTALL = (
    *(human_clock.install, human_pace.install, human_fatigue.install, human_rest.install, human_learning.install),
    human_errors.install,
)
"""Each looks whether its effect is on, in the order in which effects add up."""


@step
def drawn(floor: Floor, worker: Worker, station: Station) -> None:
    """His own next time as it is now, ``floor.asked_s``; neutral effects leave its bits alone."""
    effects = worker.human.effects
    drawn_s, shift = floor.asked_s, 0.0
    for hook in effects.shifts:
        hook.line(floor, worker, station)
        shift += effects.answer
    for told in effects.factors:
        told.line(floor, worker, station)
        drawn_s *= effects.answer
    worker.pace_shift = shift if effects.on_posture else 0.0
    floor.asked_s = drawn_s * exp(shift)


@step
def works(floor: Floor, worker: Worker) -> None:
    """He works on his k-th of a task from now, some of which is done, until then if nothing comes between."""
    human = worker.human
    effects = human.effects
    task, until_s = floor.asked_task, floor.asked_until_s
    if effects.pass_line:
        tires(floor, human, task, until_s, floor.asked_done)
    if effects.forgets:
        memory_works(floor, human, task, floor.asked_k, until_s)
    if effects.rests:
        note_that_he_works(floor, human)
    if worker.dose:
        dose = worker.dose
        dose.before = dose_so_far(floor, worker)
        dose.per_s = rate_of(floor, worker, task)
        dose.since_s, dose.until_s = floor.now, until_s


@step
def stops(floor: Floor, worker: Worker) -> None:
    """What he worked on is broken off, or waits for something."""
    human = worker.human
    if human.effects.pass_line:
        stops_tiring(floor, human)
    if human.effects.forgets:
        memory_stops(floor, human)
    if worker.dose:
        dose = worker.dose
        dose.before = dose_so_far(floor, worker)
        dose.since_s = dose.until_s = floor.now


def install(build: Any) -> None:
    """A human side for every worker, where any effect is on."""
    plan = build.plan.human
    if not plan.any:
        return
    refuse_strangers(plan)
    effects = hang(build)
    effects.on_posture = plan.acts_on == "posture"
    for effect in EFFECTS:
        if getattr(plan, effect) is not None:
            setattr(effects, effect, model_of(build, getattr(plan, effect)))
    for install_effect in INSTALL:
        install_effect(build, effects)


def hang(build: Any) -> Any:
    """A human side for every worker, without any effect."""
    floor, effects = build.floor, build.arena.new("Effects")
    for worker in build.workers:
        worker.human = build.arena.new("Human")
        worker.human.worker, worker.human.effects, worker.human.task = worker, effects, -1
    floor.has_humans, floor.drawn_line = 1, build.line(drawn)
    floor.works_line, floor.stops_line = build.line(works), build.line(stops)
    return effects
