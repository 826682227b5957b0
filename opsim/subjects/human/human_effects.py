"""What becomes of people as they work: each effect hangs in, and is asked where somebody's next time is drawn.

The time of day, errors by fatigue, learning and forgetting, the pace by how full the buffers are, rest by need. Fatigue
itself stands in ``human_models``.
"""

from __future__ import annotations

from math import exp, nan
from typing import Any

from opsim.engine.floor.event_list import INF
from opsim.engine.floor.floor_state import DUTY, Floor
from opsim.engine.floor.machine import NOTHING, cast, inlined, line_of, step
from opsim.engine.floor.state import Event, Job, Station, Worker
from opsim.engine.rules import CALENDAR
from opsim.log import BREAK, REST
from opsim.subjects.human import human_models
from opsim.subjects.human.fatigue import NEUTRAL_SHARE, Circadian, ErrorsByFatigue, Schultz
from opsim.subjects.human.forgetting import LearnForgetCurve, experience_of, first_times
from opsim.subjects.human.human_models import model_of, multiplier_of, refuse_strangers, work_of
from opsim.subjects.human.human_state import (
    Effects,
    Human,
    Model,
    dose_so_far,
    level,
    memory_passes,
    memory_stops,
    memory_works,
    note_that_he_works,
    rate_of,
    stops_tiring,
    tires,
)
from opsim.subjects.human.plan import EFFECTS
from opsim.subjects.people.worker import set_free, take_off
from opsim.subjects.routes.routing import alarm, cancel

_shift: Any = inlined(Circadian.shift)


def install_clock(build: Any, effects: Any) -> None:
    """A shift at every worker, where the time of day counts."""
    if build.plan.human.circadian is not None:
        build.hang(effects.shifts, shifted_by_clock)


@step
def shifted_by_clock(floor: Floor, worker: Worker, station: Station) -> None:
    """By how much his log time shifts now."""
    effects = worker.human.effects
    effects.answer = _shift(effects.circadian, floor.start_s + floor.now)


_share_of_good: Any = inlined(ErrorsByFatigue.share_of_good)


def install_errors(build: Any, effects: Any) -> None:
    """Whoever asks finds it by the floor, where errors have to do with fatigue."""
    if build.plan.human.errors is not None:
        build.floor.errors_line = build.line(share_of_good_by)


@step
def share_of_good_by(floor: Floor, worker: Worker, station: Station) -> None:
    """Of what he begins now, in ``floor.asked_s``."""
    human = worker.human
    floor.asked_s = _share_of_good(human.effects.errors, level(floor, human))


_remembered_of: Any = inlined(LearnForgetCurve.remembered)


@step
def begins(floor: Floor, human: Human, task: int, k: int) -> float:
    """Which repetition of a task his k-th is if he begins it now: what he remembers, and one."""
    memory_passes(floor, human)
    behind = human.units[task]
    last_s = human.last_s[task]
    if last_s == last_s:  # not NaN
        behind = _remembered(human, task, behind, floor.now - last_s)
    human.asked, human.asked_task, human.asked_k, human.asked_units = 1, task, k, behind + 1.0
    human.busy = 0
    return behind + 1.0


@inlined
def _remembered(human: Human, task: int, behind: float, pause_s: float) -> float:
    effects = human.effects
    if pause_s < effects.forgetting.least_pause_s or behind <= 0.0:
        return behind
    worked_s = effects.first_s[task] * work_of(effects.learning, behind)
    return _remembered_of(effects.forgetting, behind, pause_s, worked_s)


def install_learning(build: Any, effects: Any) -> None:
    """A factor at every worker, where people learn."""
    plan, n_tasks = build.plan.human, len(build.tasks)
    if plan.learning is None:
        return
    for worker in build.workers:
        worker.human.units = build.floats(experience_of(build.plan, worker.rank) or [0.0] * n_tasks)
    if plan.forgetting is None:
        build.hang(effects.factors, learned)
        return
    effects.forgets = 1
    first_s = first_times(build.plan, plan.learning)
    effects.first_s = build.floats(first_s(task) for task in range(n_tasks))
    for worker in build.workers:
        worker.human.last_s = build.floats([nan] * n_tasks)
    build.hang(effects.factors, remembered)


@step
def learned(floor: Floor, worker: Worker, station: Station) -> None:
    """Each repetition is told how long it takes by how many were before."""
    human = worker.human
    before = human.units[floor.asked_task]
    human.effects.answer = multiplier_of(human.effects.learning, before + floor.asked_k + 1.0)


@step
def remembered(floor: Floor, worker: Worker, station: Station) -> None:
    """Each repetition is told how long it takes by what is remembered of those before."""
    human = worker.human
    n = begins(floor, human, floor.asked_task, floor.asked_k)
    human.effects.answer = multiplier_of(human.effects.learning, n)


_pace_shift: Any = inlined(Schultz.shift)
_share: Any = inlined(Schultz.share)


def install_pace(build: Any, effects: Any) -> None:
    """A shift at every worker, where pace depends on the state of the line."""
    if build.plan.human.state_pace is None:
        return
    fed = {
        rank
        for product in build.plan.products
        for ways in product.onward
        for _, then in ways
        if then >= 0
        for rank in product.route[then].stations
    }
    effects.fed = build.ints(rank in fed for rank in range(len(build.stations)))
    build.hang(effects.shifts, shifted_by_pace)


@step
def shifted_by_pace(floor: Floor, worker: Worker, station: Station) -> None:
    """By how much his log time shifts now. NOTE: who helps somebody else is asked before he has the job."""
    effects = worker.human.effects
    effects.answer = 0.0
    if worker.job:
        model = effects.state_pace
        effects.answer = _pace_shift(model, _before(effects, model, station), _behind(model, worker.job))


@inlined
def _before(effects: Effects, model: Model, station: Station) -> float:
    """How full the buffer before a station is; all that wait to come in fill it too."""
    if not effects.fed[station.rank]:
        return NEUTRAL_SHARE
    waiting = len(station.queue)
    for i in range(station.n_wanted_by):
        waiting += len(station.wanted_by[i].claims)
    return _share(model, waiting, _room(station))


@inlined
def _behind(model: Model, job: Job) -> float:
    """How full the emptiest of the buffers is that the job may go to next."""
    way = job.plan.steps[job.step].way
    emptiest = INF
    for i in range(way.n):
        if way.to[i] >= 0:
            gate = job.plan.steps[way.to[i]].gate
            for j in range(gate.n_stations):
                filled = _filled(model, gate.stations[j])
                if filled < emptiest:
                    emptiest = filled
    return emptiest if emptiest < INF else NEUTRAL_SHARE


@inlined
def _filled(model: Model, station: Station) -> float:
    room = _room(station)
    if room <= 0:
        return 1.0 if station.n_inside >= station.capacity else 0.0
    return _share(model, max(0, station.n_inside - station.servers), room)


@inlined
def _room(station: Station) -> float:
    """Places of a station that are not on its servers."""
    return INF if station.capacity == INF else station.capacity - station.servers


FIRST = -2000
"""Before rotations, and whoever else sends anybody."""
_as_human = cast(Human)


def install_rest(build: Any, effects: Any) -> None:
    """Rests, where people take them; asked before those who send anybody."""
    plan = build.plan.human
    if plan.rest is None or plan.fatigue is None:
        return
    effects.rests = 1
    build.hang(build.floor.dispatchers, look, effects, FIRST)
    build.hang(build.floor.dispatchers, look, effects)  # again: who is seen to stay on may be too tired


@step
def look(floor: Floor, effects: Effects) -> bool:
    """Who has to go rests no more; who has come free tired rests. True where something changed."""
    changed = False
    if effects.n_resting:
        for rank in range(floor.n_workers):
            worker = floor.workers[rank]
            if worker.human.resting and worker.limited[DUTY]:
                cancel(worker.human.resting)
                _over(floor, worker)
                note_that_he_works(floor, worker.human)  # and may be too tired still when he is back
                changed = True
    at = 0
    while at < len(effects.worked):
        worker = effects.worked[at]
        if worker.in_free and not worker.limited[DUTY]:
            worker.human.has_worked = 0
            del effects.worked[at]
            if _look_at(floor, worker):
                changed = True
        else:
            at += 1
    return changed


@step
def over(floor: Floor, event: Event) -> None:
    """He is rested."""
    human: Human = _as_human(event.subject)
    if human.resting is event:
        _over(floor, human.worker)


@step
def _look_at(floor: Floor, worker: Worker) -> bool:
    human = worker.human
    effects = human.effects
    if level(floor, human) <= effects.rest.above:
        return False
    effects.rest_line(floor, human)
    take_off(floor, worker, BREAK, REST)
    rank = floor.n_stations + floor.n_sources + worker.rank
    human.resting = alarm(floor, effects.answer, CALENDAR, rank, 3, _line_of_over, human)
    effects.n_resting += 1
    return True


@step
def _over(floor: Floor, worker: Worker) -> None:
    worker.human.resting = NOTHING
    worker.human.effects.n_resting -= 1
    set_free(floor, worker)


_line_of_over = line_of(over)
INSTALL = (
    *(install_clock, install_pace, human_models.install_fatigue, install_rest, install_learning),
    install_errors,
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
