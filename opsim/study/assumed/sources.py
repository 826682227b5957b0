"""Where the times of each task come from."""

from opsim.plan import Plan
from opsim.plan.failures import repairs_said
from opsim.plan.setup import setup_tasks
from opsim.provenance import fit_report
from opsim.tasks.motions import emulators_of


def task_sources(loaded, plan: Plan) -> list[dict]:
    """A row a task, in natural order: its model in words, and for an emulated one the recordings behind it."""
    unnamed = {**setup_tasks(loaded.scenario), **repairs_said(loaded.scenario)}
    return [
        _source(loaded, plan, task.name, task.model)
        if task.name in loaded.scenario.tasks
        else _unnamed(plan, rank, unnamed[task.name])
        for rank, task in enumerate(plan.tasks)
    ]


def _unnamed(plan: Plan, rank: int, said) -> dict:
    """A task that the scenario says at its station: a set-up, a repair, a maintenance."""
    task = plan.tasks[rank]
    stops = [one.station for one in plan.stops if one.task == rank]
    setups = [one.station for one in plan.setups if any(rank in row for row in one.task)]
    row: dict = {"task": task.name, "station": ", ".join(plan.stations[at].name for at in (*stops, *setups))}
    row |= {"emulated": False, "repeat": 1, "automatic": task.automatic, "mean_s": task.model.mean_duration_s()}
    return row | {"model": f"fixed, {said:g} s" if isinstance(said, float) else said.words}


def _source(loaded, plan: Plan, name: str, model) -> dict:
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


def _of_emulator(loaded, task) -> dict:
    """Which task of which library one emulator is; nothing for other tasks."""
    if not hasattr(task, "emulator"):
        return {}
    library = loaded.scenario.libraries[task.library]
    return {"model": f"emulator {task.emulator}", "library": library, "library_task": task.library_task}


def _of_motions(loaded, task) -> dict:
    """Which emulators of which libraries the motions of a task are; nothing for other tasks."""
    if not hasattr(task, "motions"):
        return {}
    names = dict.fromkeys(emulator.partition("/")[0] for emulator in emulators_of(task, loaded))
    files = ", ".join(loaded.scenario.libraries[name] for name in names)
    return {"model": task.words, "library": files, "library_task": task.words.removeprefix("motions: ")}
