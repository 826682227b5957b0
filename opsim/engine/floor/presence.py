"""Calendars of people as the engine has them: all that changes in them, in order of time."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import Handle
from opsim.engine.floor.parts.moments import moments
from opsim.engine.rules.duty import INTERRUPTION_RULES
from opsim.plan.calendar import Duty, Pause


def presence_of(build: Any, worker: Handle) -> Handle:
    """Of a worker who has shifts."""
    made = build.arena.new("Presence")
    made.worker, worker.presence = worker, made
    duties = build.plan.workers[worker.rank].duties
    known = {id(duty): _duty(build, duty) for duty in duties}
    found = []
    for at_s, what, duty, other in moments(duties):
        moment = build.arena.new("Moment")
        moment.at_s, moment.what, moment.duty = at_s, what, known[id(duty)]
        if isinstance(other, Pause):
            moment.pause = _pause(build, other)
        elif other is not None:
            moment.follows = known[id(other)]
        found.append(moment)
    made.n_moments, made.moments = len(found), build.arena.array("Moment", found)
    return made


def _duty(build: Any, duty: Duty) -> Handle:
    shift, made = build.plan.shifts[duty.shift], build.arena.new("Duty")
    made.end_s, made.number, made.overtime_s = duty.end_s, duty.number, shift.overtime_s
    made.at_break, made.at_end = INTERRUPTION_RULES[shift.at_break], INTERRUPTION_RULES[shift.at_end]
    return made


def _pause(build: Any, pause: Pause) -> Handle:
    made = build.arena.new("Pause")
    made.start_s, made.end_s, made.meeting, made.place = pause.start_s, pause.end_s, pause.meeting, pause.place
    return made
