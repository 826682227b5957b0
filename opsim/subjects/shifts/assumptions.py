"""What the sheet says of hours: of shifts, breaks, absence and overtime of people, of stations and sources."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.kpi.window import open_hours
from opsim.plan import Plan
from opsim.problems import Assumption, listed
from opsim.subjects.release.plan import SATURATED
from opsim.subjects.shifts.hours import has_hours

_BROKEN_OFF = {
    "finish": "who has to go finishes the task under way first",
    "finish_job": "who has to go finishes all tasks of his job at the station first",
    "resume": "who has to go stops at once, and goes on with the rest when he is back; the job waits for him",
    "resume_any": "who has to go stops at once; whoever is free first goes on, another one with his own next time",
    "hand_over": "who has to go works on until somebody free has come and takes over, with his own next time",
    "restart": "who has to go stops at once, what was done is lost, and anybody begins anew",
}


def working_time(plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of hours; nothing but of presence where nobody and nothing keeps hours."""
    yield from _presence(plan)
    yield from _interruptions(plan)
    yield from _people(plan)
    yield from _stations(plan)
    yield from _sources(plan)
    if has_hours(plan):
        yield (
            "hours",
            f"throughput per hour counts the {open_hours(plan):g} scheduled hours of the window: while at least "
            "one station on a route may work, as it is open and, where it needs people, enough of those who can work "
            "there are on shift (breaks included; by plan, so absence and overtime change nothing; hours of sources do "
            "not count); time in system and all that is said of jobs goes by the calendar, nights and pauses included",
        )


def _presence(plan: Plan) -> Iterator[Assumption]:
    if not plan.workers:
        return
    always = [worker.name for worker in plan.workers if worker.duties is None]
    if len(always) == len(plan.workers):
        yield "workers", "everybody is present and equally fresh all the time: no breaks, absence, learning or fatigue"
        return
    if always:
        yield "workers", f"{listed(always)}: without a shift, and so there all the time, without a break"
    absent = [f"{worker.name} {worker.absence:.3g}" for worker in plan.workers if worker.absence > 0]
    if absent:
        yield (
            "absence",
            f"share of shifts that are missed, each by chance alone and for all of it: {listed(absent)}; nobody is "
            "told before, and nobody comes instead",
        )
    else:
        yield "absence", "nobody is ever absent"
    if plan.human.fatigue is None:
        learning = "no learning and " if plan.human.learning is None else ""
        yield "workers", f"everybody who is there is equally fresh all the time: {learning}no fatigue"


def _interruptions(plan: Plan) -> Iterator[Assumption]:
    duties = [duty for worker in plan.workers for duty in worker.duties or ()]
    shifts = [plan.shifts[rank] for rank in sorted({duty.shift for duty in duties})]
    with_breaks = [plan.shifts[rank] for rank in sorted({duty.shift for duty in duties if duty.pauses})]
    for when, of, those in (
        ("at breaks and meetings", "at_break", with_breaks),
        ("at the end of a shift", "at_end", shifts),
    ):
        for rule in _BROKEN_OFF:
            names = [shift.name for shift in those if getattr(shift, of) == rule]
            if names:
                yield "interruption", f"{when} of {listed(names)}: {_BROKEN_OFF[rule]}"
    for rule in _BROKEN_OFF:
        names = [task.name for task in plan.tasks if task.interruption == rule]
        if names and shifts:
            yield "interruption", f"in {listed(names)}, whatever the shift says: {_BROKEN_OFF[rule]}"


def _people(plan: Plan) -> Iterator[Assumption]:
    duties = [duty for worker in plan.workers for duty in worker.duties or ()]
    if any(duty.pauses for duty in duties):
        yield "breaks", "a walk is finished first; who is late for a break has it later and in full, walks included"
    for rank, shift in enumerate(plan.shifts):
        if shift.overtime_s and any(duty.shift == rank for duty in duties):
            yield (
                "overtime",
                f"{shift.name}: people stay for up to {shift.overtime_s / 3600:g} h, while jobs on the floor want what "
                "too few of those on duty can do; that they may, and want to, is taken for granted",
            )
    if duties:
        yield "shifts", "people appear at their home place as a shift begins and are gone as it ends, without a way"


def _stations(plan: Plan) -> Iterator[Assumption]:
    for rule, words in (
        ("finish", "what was begun is finished, nothing else begins"),
        ("resume", "what was begun rests, and goes on when it opens"),
    ):
        names = [one.name for one in plan.stations if one.open_s is not None and one.at_close == rule]
        if names:
            yield "hours", f"{listed(names)}: closed by hours; as it closes, {words}"
    stopping = {stop.station for stop in plan.stops}
    if any(plan.stations[rank].open_s is not None for rank in stopping):
        yield "hours", "breakdowns by the clock stand still while a station is closed; repairs and maintenance go on"


def _sources(plan: Plan) -> Iterator[Assumption]:
    timed = [one.name for one in plan.sources if one.open_s is not None and not one.orders and one.kind != SATURATED]
    if timed:
        yield "hours", f"{listed(timed)}: jobs come in its hours alone, and gaps between them count these alone"
    ordered = [one.name for one in plan.sources if one.open_s is not None and one.orders]
    if ordered:
        yield "hours", f"{listed(ordered)}: orders of other hours come in as it opens next"
    asking = [one.name for one in plan.sources if one.open_s is not None and one.kind == SATURATED]
    if asking:
        yield "hours", f"{listed(asking)}: lets jobs in within its hours alone"
