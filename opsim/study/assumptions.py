"""What a run assumes, topic by topic, and what somebody should know before believing it.

The lines of each subject stand with it; here is their order, and what no subject owns.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from opsim.ergonomics.trunk import has_trunk
from opsim.ergonomics.walking import LOOKED_AT
from opsim.kpi.deadlock import Locked
from opsim.kpi.material_supply import NOBODY, TO_FILL
from opsim.libraries import HandTarget
from opsim.plan import Plan
from opsim.plugins.registry import subjects_of
from opsim.problems import Assumption, listed
from opsim.scenario.schema import Emulated, Motions
from opsim.streams import stream
from opsim.study.replication import Replicated
from opsim.subjects.breakdowns.checks import stopped
from opsim.subjects.breakdowns.plan import repairs_said
from opsim.subjects.exposure.assumptions import ergonomics, strain
from opsim.subjects.human.assumptions import human, walking
from opsim.subjects.lines.warnings import crews, lines
from opsim.subjects.material.checks import assumed_assembly
from opsim.subjects.people.assumptions import asked_for_pace, assignment, people, qualities
from opsim.subjects.quality.checks import assumed_quality
from opsim.subjects.release.checks import released
from opsim.subjects.sequencing.checks import assumed_queues, assumed_setups
from opsim.subjects.sequencing.plan import setup_tasks
from opsim.subjects.stations.checks import assumed_batches, assumed_buffers
from opsim.subjects.stations.plan import STATION
from opsim.subjects.tasks.from_scenario import emulators_of, hand_targets
from opsim.subjects.tasks.plan import performed_tasks
from opsim.subjects.tasks.warnings import stretched, unread
from opsim.subjects.tools.checks import assumed_tools
from opsim.subjects.transport.checks import by_themselves, vehicles
from opsim.task_model import behind, fit_report

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


def station_model(plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of all of them, most weighty first."""
    yield from _absent(plan)
    for part in (
        assumed_setups,
        assumed_queues,
        assumed_buffers,
        assumed_assembly,
        assumed_batches,
        assumed_quality,
        assumed_tools,
    ):
        yield from part(plan)


def _absent(plan: Plan) -> Iterator[Assumption]:
    """What goes wrong on a real floor and not on this one."""
    inspected = [one for one in plan.quality if one.inspects]
    reworks = any(one.back for one in inspected)
    missing = [] if plan.setups else ["set-ups"]
    missing += [] if plan.stops else ["breakdowns"]
    missing += [] if plan.quality else ["scrap"]
    if reworks:
        rework = ""
    elif any(len(ways) > 1 for product in plan.products for ways in product.onward):
        rework = ", and rework only as the routing says" if missing else ""
    else:
        rework = " or rework" if missing else "no rework"
    named = " or ".join(missing) if len(missing) < 3 else "set-ups, breakdowns or scrap"
    if named or rework:
        yield "stations", (f"no {named}{rework}" if named else rework)


_IDLE = {
    "stay": "stay where they are",
    "home": "walk home, and can be called again when they are there",
    "patrol": "walk round their stations and serve only where they stand",
}


def flow(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed), most weighty first."""
    yield from _transport(plan)
    yield from station_model(plan)
    yield from stopped(plan)
    if len(plan.workers) > sum(len(crew.workers) for crew in plan.crews):
        rule, blocked = plan.rule.replace("_", " "), plan.when_blocked
        chosen = "chosen" if "allocation.rule" in loaded.given else "default"
        yield "allocation", f"free workers go by {rule} ({chosen}); with a blocked job a worker is {blocked}"
        yield "allocation", f"idle workers {_IDLE[plan.idle]}"
        yield from assignment(plan)
        yield from qualities(plan)
    yield from crews(loaded, plan)
    yield from lines(plan)
    paced = {rank for line in plan.lines for rank in line.stations}
    stations = [one for rank, one in enumerate(plan.stations) if one.kind == STATION and rank not in paced]
    unlimited = [station.name for station in stations if station.buffer == float("inf")]
    if unlimited:
        yield "buffers", f"unlimited in front of {listed(unlimited)}"
    yield from released(plan)


def _transport(plan: Plan) -> Iterator[Assumption]:
    carried = [product.name for product in plan.products if product.carried]
    if carried:
        yield (
            "transport",
            f"whoever did the last task at a station carries {listed(carried)} to the next at walking speed, "
            "unhampered by the load, and waits with it while that is full; after an automatic task it passes without "
            "time",
        )
    yield from _limits(plan)
    yield from vehicles(plan)
    if len(carried) < len(plan.products) and by_themselves(plan):
        others = carried or plan.transporters or plan.conveyors
        yield "transport", f"{'other jobs' if others else 'jobs'} pass between stations without time"


def _limits(plan: Plan) -> Iterator[Assumption]:
    """What is carried at once, where workers or products say something about it."""
    carried = [product for product in plan.products if product.carried]
    limited = [worker.name for worker in plan.workers if worker.most_load_kg is not None]
    weighed = [product.name for product in carried if product.mass_kg is not None]
    if limited and weighed:
        yield (
            "transport",
            f"{listed(limited)}: as many walks as the load limit asks for, with whole pieces of {listed(weighed)}",
        )
    unweighed = [product.name for product in carried if product.mass_kg is None]
    if limited and unweighed:
        yield "transport", f"{listed(unweighed)}: no mass is given, and anybody carries all of a job at once"
    unlimited = [worker.name for worker in plan.workers if worker.most_load_kg is None]
    if weighed and unlimited:
        yield "transport", f"{listed(unlimited)}: no load limit is given; they carry all of a job at once"


@dataclass(frozen=True, slots=True)
class Asked:
    """What a run was given beside its scenario file, None where nothing; ``why`` it has so many replications."""

    seed: int | None = None
    replications: int | None = None
    why: str = ""


NOTHING_ASKED = Asked()


def assumptions_of(loaded: Loaded, plan: Plan, asked: Asked = NOTHING_ASKED) -> list[Assumption]:
    """Every assumption of a run that its reader should know, most weighty first."""
    lines = [line for part in PARTS for line in part(loaded, plan)]
    lines += [line for subject, part in subjects_of(plan) for line in subject.assumptions(plan, part)]
    return [*lines, *_run(loaded, asked)]


_SWITCHED = {
    "within_only": "every worker has the same mean time for a task, and his own spread about it",
    "between_only": "a worker takes the same time whenever he does a task: his own mean",
    "none": "a task takes the same time whoever does it: its mean",
    "shuffled": "times are as they were drawn, each with the body of another performance of the same worker: posture "
    "and time of a performance know nothing of each other",
}


def _switched(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
    variability = loaded.scenario.run.variability
    if variability != "full":
        paced = variability in ("within_only", "none") and asked_for_pace(plan)
        pace = f"; {listed(paced)}: divided by the pace asked for in tasks that read it" if paced else ""
        yield "variability", f"{variability}: {_SWITCHED[variability]}{pace}; arrivals and ways are drawn as ever"


def _times(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
    tasks = loaded.scenario.tasks
    named = [task for task in plan.tasks if task.name in tasks]
    made_up = [task.name for task in named if hasattr(tasks[task.name], "dist") or hasattr(tasks[task.name], "fixed_s")]
    if made_up:
        yield "task times", f"{listed(made_up)}: from the scenario, not from recordings; no posture is known for them"
    for task in named:
        said = tasks[task.name]
        if isinstance(said, Emulated):
            report = fit_report(task.model)
            yield (
                "task times",
                f"{task.name}: people here move and take their time as in {said.emulator} "
                f"({behind(report.source, report.n_sequences, report.n_workers)})",
            )
    yield from _hands(loaded, plan)
    for task in named:
        said = tasks[task.name]
        if isinstance(said, Motions):
            report, emulators = fit_report(task.model), listed(emulators_of(said, loaded))
            yield (
                "task times",
                f"{task.name}: its motions follow one another without a pause, each a draw of its own, as in "
                f"{emulators} ({behind(report.source, report.n_sequences, report.n_workers)}); in the tenths of a "
                "second about a join bodies are led from one posture to the next, as nobody was recorded",
            )
    repeated = [f"{task.name} ({task.repeat} times)" for task in plan.tasks if task.repeat > 1]
    if repeated:
        yield (
            "task times",
            f"{listed(repeated)}: one performance follows the other without a pause, each a draw of its own",
        )
    loads = [name for name, task in tasks.items() if task.load_kg is not None]
    if loads:
        yield "loads", f"{listed(loads)}: the load is kept with the task; it does not change pace or posture"


def _hands(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
    """Tasks whose hands go where the scenario says."""
    tasks = performed_tasks(loaded.scenario)
    tasks = {name: task for name, task in tasks.items() if isinstance(task, Emulated) and task.hands}
    for name, task in tasks.items():
        at = [_at(one, task.hands[one.mark]) for one in hand_targets(task, loaded.scenario.layout)]
        yield (
            "reach",
            f"{name}: the middle of both hands is where the scenario says (at {listed(at)}); body and time follow, as "
            "far as they went together with it in the recordings",
        )
    yield from (("reach", sentence) for sentence in stretched(plan))


def _at(target: HandTarget, said: float | tuple[str, str]) -> str:
    level = "" if isinstance(said, float) else f" {'.'.join(said)},"
    return f"{target.mark}{level} {target.height_m:g} m"


def _window(loaded: Loaded, plan: Plan) -> Iterator[Assumption]:
    if plan.warm_up_s == 0:
        yield "window", "no warm-up: figures include the time in which the empty floor fills"


def _run(loaded: Loaded, asked: Asked) -> Iterator[Assumption]:
    """Where the seed and the number of replications come from, where the file does not say them."""
    run = loaded.scenario.run
    if asked.why:
        yield "run", f"replications: {asked.replications}, as many as needed: {asked.why}"
    for name, own, used in (
        ("seed", run.seed, asked.seed),
        ("replications", run.replications, asked.replications),
    )[: 1 if asked.why else 2]:
        in_file = f"run.{name}" in loaded.given
        if used is None and not in_file:
            yield "run", f"{name}: {own}, the default, as neither the file nor the call says"
        elif used is not None and not (in_file and used == own):
            instead = f"instead of the file's {own}" if in_file else "the file says nothing"
            yield "run", f"{name}: {used}, given with the call; {instead}"


PARTS = (_switched, _times, people, human, ergonomics, strain, walking, flow, _window)


def warnings_of(done: Sequence[Replicated], plan: Plan) -> list[str]:
    """Every warning in a sentence."""
    return [*_locked(done), *unread(plan)]


def _locked(done: Sequence[Replicated]) -> Iterator[str]:
    """Floors that stood still because jobs waited for each other in a circle, with what each of them waited for."""
    stuck = [(one.locked.since_s, one.replication, one.locked) for one in done if one.locked is not None]
    if not stuck:
        return
    since_s, replication, ring = min(stuck, key=lambda one: one[:2])
    people = f"; needed there, and held by blocked jobs: {', '.join(ring.workers)}" if ring.workers else ""
    others = f" ({ring.n_jobs} jobs in all, at {listed(list(ring.stations))})" if ring.n_jobs > len(ring.circle) else ""
    yield (
        f"the floor locked itself in {len(stuck)} of {len(done)} replications and stood still from then on; first in "
        f"replication {replication} at {since_s:.0f} s: {', '.join(ring.circle)}{others}{people}. "
        f"{_remedy(ring)}"
    )


def _remedy(ring: Locked) -> str:
    told = " ".join(ring.circle)
    if NOBODY in told:
        return _TAKE
    if TO_FILL in told:
        return _FILL
    return _REMEDY if ring.workers else _MORE


_TAKE = "A card that comes back before the store ('to'), or a product that takes from it ('parts') helps"
_FILL = "'most_wait' lets a batch begin that is not full; more room or cards, or a smaller 'size' helps too"
_MORE = "More of what they wait for helps: room ('buffer: unlimited'), tools, cards or stock"
_REMEDY = "More room, 'buffer: unlimited' or 'when_blocked: free' helps"


def task_sources(loaded: Loaded, plan: Plan) -> list[dict]:
    """A row a task, in natural order: its model in words, and for an emulated one the recordings behind it."""
    unnamed = {**setup_tasks(loaded.scenario), **repairs_said(loaded.scenario)}
    return [
        _source(loaded, plan, task.name, task.model)
        if task.name in loaded.scenario.tasks
        else _unnamed(plan, rank, unnamed[task.name])
        for rank, task in enumerate(plan.tasks)
        if task.of is None
    ]


def _unnamed(plan: Plan, rank: int, said) -> dict:
    """A task that the scenario says at its station: a set-up, a repair, a maintenance, one of somebody else's."""
    task = plan.tasks[rank]
    theirs = [station for station, other in plan.more_setups if other == rank]
    stops = [one.station for one in plan.stops if one.task == rank]
    setups = [one.station for one in plan.setups if any(rank in row for row in one.task)]
    where = ", ".join(plan.stations[at].name for at in (*stops, *setups, *theirs))
    row: dict = {"task": task.name, "station": where}
    row |= {"emulated": False, "repeat": 1, "automatic": task.automatic, "mean_s": task.model.mean_duration_s()}
    return row | {"model": f"fixed, {said:g} s" if isinstance(said, float) else said.words}


def _source(loaded: Loaded, plan: Plan, name: str, model) -> dict:
    task = loaded.scenario.tasks[name]
    points = [station.name for station in plan.stations if station.name in loaded.scenario.stations]
    stations = [point for point in points if name in loaded.scenario.stations[point].tasks]
    behind = _of_emulator(loaded, task) or _of_motions(loaded, task)
    row = {"task": name, "station": ", ".join(stations), "emulated": bool(behind)}
    row |= {"repeat": task.repeat, "automatic": task.automatic, "mean_s": model.mean_duration_s()}
    if not behind:
        return row | {"model": task.words}
    report = fit_report(model)
    return row | {
        **behind,
        "source": report.source,
        "licence": report.licence,
        "n_sequences": report.n_sequences,
        "n_workers": report.n_workers,
    }


def _of_emulator(loaded: Loaded, task) -> dict:
    """Which task of which library one emulator is; nothing for other tasks."""
    if not hasattr(task, "emulator"):
        return {}
    library = loaded.scenario.libraries[task.library]
    return {"model": f"emulator {task.emulator}", "library": library, "library_task": task.library_task}


def _of_motions(loaded: Loaded, task) -> dict:
    """Which emulators of which libraries the motions of a task are; nothing for other tasks."""
    if not hasattr(task, "motions"):
        return {}
    names = dict.fromkeys(emulator.partition("/")[0] for emulator in emulators_of(task, loaded))
    files = ", ".join(loaded.scenario.libraries[name] for name in names)
    return {"model": task.words, "library": files, "library_task": task.words.removeprefix("motions: ")}


def posture_assumptions(plan: Plan) -> Iterator[Assumption]:
    """(topic, what is assumed) of every figure that was made from postures."""
    in_shifts = any(worker.duties is not None for worker in plan.workers)
    present = " in which a worker is there, breaks included" if in_shifts else ": everybody is present all of it"
    yield (
        "postures",
        "trunk flexion is the angle of the line from pelvis to neck against the vertical, forward as the hips face; "
        f"minutes at an angle are measured minutes of work in an hour of the window{present}",
    )
    unknown = [task.name for task in plan.tasks if not task.automatic and not _has_body(task)]
    if unknown:
        yield (
            "postures",
            f"{', '.join(unknown)}: no posture is known; the time counts as not measured, neither upright nor bent, so "
            "that minutes at an angle are too few by what would have been seen there",
        )
    waits = "walking and waiting are" if plan.walking is None else "waiting is"
    yield "postures", f"{waits} not measured; how people move from one task into the next is not known"
    if plan.walking is not None:
        yield (
            "postures",
            "figures of the trunk are of work, and have the parts 'walking' and 'together' (work and walking) besides; "
            f"of a worker who walks more than {LOOKED_AT} times in a replication, {LOOKED_AT} walks are looked at and "
            "stand for all",
        )


def _has_body(task) -> bool:
    return has_trunk(task.model.sample(1, stream(0, 0, "duration", task.name, "anybody", 0)))
