"""The assumption sheet: what was not measured, what was left at its default, what is read and not used yet."""

from collections.abc import Iterator
from dataclasses import dataclass

from opsim.names import listed
from opsim.plan import Plan
from opsim.provenance import behind, fit_report
from opsim.study.assumed.ergonomics import ergonomics
from opsim.study.assumed.flow import flow
from opsim.study.assumed.human import human
from opsim.study.assumed.people import asked_for_pace, people
from opsim.study.assumed.strain import strain
from opsim.study.assumed.walking import walking
from opsim.tasks.motions import emulators_of


@dataclass(frozen=True, slots=True)
class Asked:
    """What a run was given beside its scenario file, None where nothing; ``why`` it has so many replications."""

    seed: int | None = None
    replications: int | None = None
    why: str = ""


NOTHING_ASKED = Asked()
Assumption = tuple[str, str]
"""(topic, what is assumed)"""


def assumptions_of(loaded, plan: Plan, asked: Asked = NOTHING_ASKED) -> list[Assumption]:
    """Every assumption of a run that its reader should know, most weighty first."""
    lines = [line for part in PARTS for line in part(loaded, plan)]
    return [*lines, *_run(loaded, asked)]


_SWITCHED = {
    "within_only": "every worker has the same mean time for a task, and his own spread about it",
    "between_only": "a worker takes the same time whenever he does a task: his own mean",
    "none": "a task takes the same time whoever does it: its mean",
    "shuffled": "times are as they were drawn, each with the body of another performance of the same worker: posture "
    "and time of a performance know nothing of each other",
}


def _switched(loaded, plan: Plan) -> Iterator[Assumption]:
    variability = loaded.scenario.run.variability
    if variability != "full":
        paced = variability in ("within_only", "none") and asked_for_pace(plan)
        pace = f"; {listed(paced)}: divided by the pace asked for in tasks that read it" if paced else ""
        yield "variability", f"{variability}: {_SWITCHED[variability]}{pace}; arrivals and ways are drawn as ever"


def _times(loaded, plan: Plan) -> Iterator[Assumption]:
    tasks = loaded.scenario.tasks
    named = [task for task in plan.tasks if task.name in tasks]
    made_up = [task.name for task in named if hasattr(tasks[task.name], "dist") or hasattr(tasks[task.name], "fixed_s")]
    if made_up:
        yield "task times", f"{listed(made_up)}: from the scenario, not from recordings; no posture is known for them"
    for task in named:
        if hasattr(tasks[task.name], "emulator"):
            report = fit_report(task.model)
            yield (
                "task times",
                f"{task.name}: people here move and take their time as in {tasks[task.name].emulator} "
                f"({behind(report.source, report.n_sequences, report.n_workers)})",
            )
    for task in named:
        if hasattr(tasks[task.name], "motions"):
            report, emulators = fit_report(task.model), listed(emulators_of(tasks[task.name], loaded))
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


def _window(loaded, plan: Plan) -> Iterator[Assumption]:
    if plan.warm_up_s == 0:
        yield "window", "no warm-up: figures include the time in which the empty floor fills"


def _run(loaded, asked: Asked) -> Iterator[Assumption]:
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
