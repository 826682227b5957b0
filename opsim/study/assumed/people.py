"""What the assumption sheet says of workers: who they are, what is known of their bodies, where they stand."""

from collections.abc import Iterator

from opsim.bodies import keys_read
from opsim.effects import worker_effect
from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.tasks import TaskPlan
from opsim.plan.unread import tasks_of, unknown_there
from opsim.plan.worker import WorkerPlan, start_place
from opsim.streams import stream
from opsim.study.assumed.rotations import rotations
from opsim.study.assumed.working_time import working_time

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


def people(loaded, plan: Plan) -> Iterator[tuple[str, str]]:
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
    effect = worker_effect(task.model, task.name, worker.name, plan.seed, 0, worker.body)
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


def _standing(loaded, plan: Plan) -> Iterator[tuple[str, str]]:
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
