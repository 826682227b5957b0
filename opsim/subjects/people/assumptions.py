"""What the assumption sheet says of workers: who they are, what is known of their bodies, where they stand.

Who does what: zones, floaters, priorities, qualities, shared work. Job rotation.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from opsim.engine.rules import LEAST_EXPOSED
from opsim.plan.plan import FIXED_WORKFORCE, Plan
from opsim.problems import Assumption, listed
from opsim.streams import stream
from opsim.subjects.people.plan import IN_TURN, RotationPlan, WorkerPlan, start_place
from opsim.subjects.shifts.assumptions import working_time
from opsim.subjects.tasks.plan import TaskPlan
from opsim.subjects.tasks.warnings import tasks_of, unknown_there
from opsim.task_model import keys_read

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


def assignment(plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of all of them, most weighty first."""
    yield from _whose(plan)
    yield from _priorities(plan)
    yield from _shared(plan)
    if plan.idle == "patrol" and plan.serve == "one":
        yield "allocation", "who patrols does one operation at a stop, with all its tasks, and walks on"


def qualities(plan: Plan) -> Iterator[Assumption]:
    """Of those who leave defects of their own."""
    who = [
        f"{worker.name} at {plan.stations[rank].name} {quality:.4g}"
        for worker in plan.workers
        for rank, quality in enumerate(worker.quality)
        if quality < 1
    ]
    if who:
        yield (
            "quality",
            "shares of operations that workers leave without a defect are the scenario's own, not measured: "
            f"{listed(who)}; times the station's yield, each by chance alone; of several on an operation the lowest",
        )


def _whose(plan: Plan) -> Iterator[Assumption]:
    zones = [
        f"{worker.name} ({listed(plan.stations[rank].name for rank in worker.zone)})"
        for worker in plan.workers
        if worker.zone
    ]
    if zones:
        yield (
            "allocation",
            "own stations first, others only where none of these calls and nobody whose own it is, and no floater, is "
            "free: " + listed(zones),
        )
    floaters = [worker.name for worker in plan.workers if worker.floater]
    if floaters:
        yield (
            "allocation",
            f"{listed(floaters)}: sent only where nobody is free whose own station it is, but before others leave "
            "their zones",
        )


def _priorities(plan: Plan) -> Iterator[Assumption]:
    ranked = [f"{station.name} ({station.priority})" for station in plan.stations if station.priority]
    for what in plan.priorities:
        if what == "stations" and ranked:
            yield "allocation", f"stations of a higher priority are served first, before the rule: {listed(ranked)}"
        elif what == "products" and any(product.priority for product in plan.products):
            yield "allocation", "where jobs of a higher priority call, workers go first, before the rule"


def _shared(plan: Plan) -> Iterator[Assumption]:
    for share in plan.shares:
        here, there = plan.stations[share.station].name, plan.stations[share.partner].name
        tasks = listed(plan.tasks[task].name for task in share.tasks)
        filled = "its buffer is full" if share.filled == 1 else "at least half of its buffer is taken"
        yield (
            "stations",
            f"{tasks}: done at {here} where {there} has no free server and {filled}, else at {there}; what was begun "
            "is finished where it was begun",
        )


def rotations(plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of each rotation."""
    new = ", and nobody is slower for being new at a post" if plan.human.learning is None else ""
    for rotation in plan.rotations:
        names = listed([plan.workers[worker].name for worker in rotation.workers])
        yield (
            "rotation",
            f"{rotation.name}: {names} share {len(rotation.posts)} posts, and change {_when(rotation)}, "
            f"{_who(rotation)}; what was begun is finished at the old post, a change takes no time but the walk{new}",
        )


def _when(rotation: RotationPlan) -> str:
    if rotation.every_s is not None:
        return f"every {rotation.every_s / 3600:g} h from the start of the run, work time or not"
    if rotation.after == 1:
        return "after every operation at one of the posts"
    return f"when {rotation.after} operations were done at one of the posts, by whomever"


def _who(rotation: RotationPlan) -> str:
    if rotation.rule == IN_TURN:
        return "each to the next post"
    if rotation.rule == "least_time":
        return "a post going to who was there for the shortest time so far, breaks included"
    if rotation.rule == LEAST_EXPOSED:
        return "the heaviest post going to whose body has gone through least so far"
    return f"by the rule {rotation.rule}"


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


def people(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
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


def _workforce(workforce) -> Iterator[Assumption]:
    """Of workers who are nobody in particular."""
    if workforce is None:
        return
    who = f"{workforce.prefix}1" + (f" to {workforce.prefix}{workforce.n}" if workforce.n > 1 else "")
    if workforce.source == "population":
        yield "workers", f"{who}: nobody in particular, drawn from the population of the recordings and distributions"
    if not workforce.skills:
        yield "workers", f"{who}: skills not given; everybody can work at every station, with the rating 1"


def _bodies(plan: Plan, variability: str) -> Iterator[Assumption]:
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
    effect = plan.worker_effect(plan.workers.index(worker), task, workforce=FIXED_WORKFORCE)
    return tuple(getattr(getattr(effect, "effect", effect), "said", ()))


def _recorded(plan: Plan) -> Iterator[Assumption]:
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


def _standing(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
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
