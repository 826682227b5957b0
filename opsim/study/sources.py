"""Where the times of each task come from."""

from opsim.plan import Plan
from opsim.provenance import fit_report


def task_sources(loaded, plan: Plan) -> list[dict]:
    """A row a task, in natural order: its model in words, and for an emulated one the recordings behind it."""
    return [_source(loaded, plan, task.name, task.model) for task in plan.tasks]


def _source(loaded, plan: Plan, name: str, model) -> dict:
    task = loaded.scenario.tasks[name]
    stations = [station.name for station in plan.stations if name in loaded.scenario.stations[station.name].tasks]
    row = {"task": name, "station": ", ".join(stations), "emulated": hasattr(task, "emulator")}
    row |= {"repeat": task.repeat, "automatic": task.automatic, "mean_s": model.mean_duration_s()}
    if not row["emulated"]:
        return row | {"model": task.words}
    report = fit_report(model)
    return row | {
        "model": f"emulator {task.emulator}",
        "library": loaded.scenario.libraries[task.library],
        "library_task": task.library_task,
        "source": report.source,
        "licence": report.licence,
        "n_sequences": report.n_sequences,
        "n_workers": report.n_workers,
    }
