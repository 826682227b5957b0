"""What the sheet says of hours: of shifts, breaks, absence and overtime of people, of stations and sources.

What the assumption sheet says of workers: who they are, what is known of their bodies, where they stand.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from opsim.kpi.window import open_hours
from opsim.plan import Plan
from opsim.plan.hours import has_hours
from opsim.plan.model_warnings import tasks_of, unknown_there
from opsim.plan.sources import SATURATED
from opsim.plan.tasks import TaskPlan
from opsim.plan.workers import WorkerPlan, start_place
from opsim.problems import listed
from opsim.streams import stream
from opsim.study.assumptions.assignment import rotations
from opsim.task_model import keys_read
from opsim.worker_effects import worker_effect

if TYPE_CHECKING:
    from opsim.scenario.read import Loaded

_BROKEN_OFF = {
    "finish": "who has to go finishes the task under way first",
    "finish_job": "who has to go finishes all tasks of his job at the station first",
    "resume": "who has to go stops at once, and goes on with the rest when he is back; the job waits for him",
    "resume_any": "who has to go stops at once; whoever is free first goes on, another one with his own next time",
    "hand_over": "who has to go works on until somebody free has come and takes over, with his own next time",
    "restart": "who has to go stops at once, what was done is lost, and anybody begins anew",
}


def working_time(plan: Plan) -> Iterator[Line]:
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


def _presence(plan: Plan) -> Iterator[Line]:
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


def _interruptions(plan: Plan) -> Iterator[Line]:
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


def _people(plan: Plan) -> Iterator[Line]:
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


def _stations(plan: Plan) -> Iterator[Line]:
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


def _sources(plan: Plan) -> Iterator[Line]:
    timed = [one.name for one in plan.sources if one.open_s is not None and not one.orders and one.kind != SATURATED]
    if timed:
        yield "hours", f"{listed(timed)}: jobs come in its hours alone, and gaps between them count these alone"
    ordered = [one.name for one in plan.sources if one.open_s is not None and one.orders]
    if ordered:
        yield "hours", f"{listed(ordered)}: orders of other hours come in as it opens next"
    asking = [one.name for one in plan.sources if one.open_s is not None and one.kind == SATURATED]
    if asking:
        yield "hours", f"{listed(asking)}: lets jobs in within its hours alone"


Line = tuple[str, str]


_OWN_PACE = ("full", "between_only", "shuffled")
"""Under these, workers differ in pace."""
_WORDS = {"height_m": "height", "mass_kg": "mass", "age_years": "age", "sex": "sex", "pace": "pace"}
_HOW = {"height_m": "bones are scaled to it", "pace": "moving times of the typical person are divided by it"}
_PACE_OF_PERSONS = "moving times of the typical person, or of the recorded one who is named, are divided by it"
_PACE_OF_ALL = "the mean of everybody's times is divided by it"
_EXPLAINED = "pace and posture change as the recordings explain them by it"

_ACROSS = {
    "as_recorded": "a worker's own pace in tasks of the same recorded people goes together as theirs did; in other "
    "tasks he may be quick in one and slow in the next",
    "same_pace": "a worker who is slow in one task is as slow in all, among his like and in moving time; pauses of an "
    "emulated task follow only as far as recorded: not measured",
}


def people(loaded: Loaded, plan: Plan) -> Iterator[tuple[str, str]]:
    """Lines of (topic, what is assumed)."""
    if not plan.workers:
        yield "workers", "none: every task is automatic"
        yield from working_time(plan)
        return
    yield from _workforce(loaded.scenario.workforce)
    yield from _bodies(plan, loaded.scenario.run.variability)
    yield from _recorded(plan)
    levels = loaded.scenario.skill_levels
    if levels:
        given = listed(f"{name} {_skill_said(skill)}" for name, skill in levels.items())
        yield "skills", f"the ratings of the skill levels are the scenario's own, not measured: {given}"
    yield from _standing(loaded, plan)
    yield from rotations(plan)
    yield from working_time(plan)
    if loaded.scenario.run.variability in _OWN_PACE and any(_differ(task) for task in plan.tasks):
        drawn = {
            "fixed": "the same people work in every replication: a worker's own pace is drawn once for the study",
            "redrawn": "other people work in each replication: every worker's own pace is drawn anew",
        }
        yield "workers", drawn[plan.staffing]
        yield "workers", _ACROSS[plan.across_tasks]


def _skill_said(skill) -> str:
    """A rating alone, or with the share of good work."""
    return f"{skill.pace:g} (good work {skill.quality:g})" if hasattr(skill, "quality") else f"{skill:g}"


def asked_for_pace(plan: Plan) -> list[str]:
    """The workers for whose pace there is a task that reads it."""
    paced = [worker for worker in plan.workers if worker.body.pace is not None]
    return [w.name for w in paced if any("pace" in keys_read(task.model) for task in tasks_of(plan, w))]


def _workforce(workforce) -> Iterator[tuple[str, str]]:
    """Of workers who are nobody in particular."""
    if workforce is None:
        return
    who = f"{workforce.prefix}1" + (f" to {workforce.prefix}{workforce.n}" if workforce.n > 1 else "")
    if workforce.source == "population":
        yield "workers", f"{who}: nobody in particular, drawn from the population of the recordings and distributions"
    if not workforce.skills:
        yield "workers", f"{who}: skills not given; everybody can work at every station, with the rating 1"


def _bodies(plan: Plan, variability: str) -> Iterator[tuple[str, str]]:
    """What is known of bodies, and which tasks make use of it."""
    how = _HOW | _how_paced(plan, variability)
    said = {
        (worker.name, task.name): _said(plan, worker, task)
        for worker in plan.workers
        if worker.body.said
        for task in tasks_of(plan, worker)
    }
    useless = []
    for key, word in _WORDS.items():
        who = [worker for worker in plan.workers if key in worker.body.said]
        tasks = {w.name: {task.name: key in keys_read(task.model) for task in tasks_of(plan, w)} for w in who}
        users = [name for name, used in tasks.items() if any(used.values())]
        others = [name for name in tasks if name not in users]
        if users:
            using = _use(how.get(key, _EXPLAINED), [tasks[name] for name in users])
            yield "bodies", f"{word} of {listed(users)}: {using}{_beside(key, said)}"
        if others:
            useless.append(f"{word} of {listed(others)}" if users else word)
    if useless:
        yield "bodies", f"{listed(useless)}: kept with the worker; no task there changes pace or posture with it"
    clamped = [
        f"{worker} in {task}: {line}" for (worker, task), lines in said.items() for line in lines if "(clamped)" in line
    ]
    if clamped:
        nearest = "what these explain is as with the nearest of them"
        yield "bodies", f"unlike the bodies that were recorded; {nearest}: {listed(clamped)}"


def _how_paced(plan: Plan, variability: str) -> dict[str, str]:
    """What a pace does where it is not only the typical person's."""
    if variability not in _OWN_PACE:
        return {"pace": _PACE_OF_ALL}
    both = any({"pace", "person"} <= set(worker.body.said) for worker in plan.workers)
    return {"pace": _PACE_OF_PERSONS} if both else {}


def _use(how: str, tasks: list[dict[str, bool]]) -> str:
    """How a number is used, in which of the workers' tasks it is and in which it is not."""
    using, leaving = (
        listed(dict.fromkeys(name for own in tasks for name, used in own.items() if used is wanted))
        for wanted in (True, False)
    )
    return f"{how} in {using}" + (f", not in {leaving}" if leaving else "")


def _beside(key: str, said: dict[tuple[str, str], tuple[str, ...]]) -> str:
    """Where the recordings explain by a number, too, that is used whatever they explain."""
    there = dict.fromkeys(
        task
        for (_, task), lines in said.items()
        for line in lines
        if line.startswith(f"{key}: asked") and line.endswith(("(as asked)", "(clamped)"))
    )
    return f"; {_EXPLAINED} in {listed(there)}" if key in _HOW and there else ""


def _said(plan: Plan, worker: WorkerPlan, task: TaskPlan) -> tuple[str, ...]:
    """What an emulator says of the body that it was asked for."""
    effect = worker_effect(task.model, task.stream_name, worker.name, plan.seed, 0, worker.body)
    return tuple(getattr(getattr(effect, "effect", effect), "said", ()))


def _recorded(plan: Plan) -> Iterator[tuple[str, str]]:
    known = [worker for worker in plan.workers if worker.body.person is not None]
    if known:
        who = listed(f"{worker.name} as {worker.body.person}" for worker in known)
        lacking = listed(dict.fromkeys(name for worker in known for name in unknown_there(plan, worker)))
        elsewhere = f"; not everybody in {lacking}, where some move as people drawn from the population"
        yield (
            "workers",
            f"move as people who were recorded, in emulated tasks and in every replication: {who}"
            f"{elsewhere if lacking else ''}",
        )


def _standing(loaded: Loaded, plan: Plan) -> Iterator[tuple[str, str]]:
    workers = loaded.scenario.workers
    walkers = [worker.name for worker in plan.workers if _walks(plan, worker)]
    default_walk = [name for name in walkers if f"workers.{name}.walk" not in loaded.given]
    if default_walk:
        yield (
            "walking",
            f"{listed(default_walk)}: walking speed not given, {workers[default_walk[0]].walk_m_per_s:g} m/s assumed",
        )
    homeless = [
        f"{name} at {start_place(workers[name], loaded.scenario)}" for name in walkers if workers[name].home is None
    ]
    if homeless:
        yield "walking", f"at t = 0 stand {listed(homeless)} (first of their stations by name)"


def _walks(plan: Plan, worker: WorkerPlan) -> bool:
    stations = {rank for rank, rating in enumerate(worker.rating) if rating}
    if any(line.moves and stations.intersection(line.stations) for line in plan.lines):
        return True
    return len({worker.place} | {plan.stations[rank].place for rank in stations}) > 1


def _differ(task: TaskPlan) -> bool:
    return task.model.draw_worker(stream(0, 0, "effect", "anybody", task.name, 0)) is not None
