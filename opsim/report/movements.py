"""The movements behind the times of emulated tasks, as strips of figures, with what they were learned from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.provenance import behind
from opsim.report.material import Material
from opsim.report.person import LEFT, RIGHT
from opsim.report.section import Legend, Picture, Section, Words
from opsim.report.words import listing, quantity

SAMPLES = 2
MANY = 20
"""Figures in a row where a task is several motions."""
SAID = (
    "These tasks take their time from a motion emulator: posture, pace and duration come from one draw. Above, the "
    "mean performance (of several motions in a row a typical one); below, single draws. Figures stand at their real "
    "time."
)
LIMBS = Legend([(LEFT, "left limbs"), (RIGHT, "right limbs")])
Task = Mapping[str, Any]


def section(material: Material) -> Section | None:
    """The emulated tasks, those of one model together with one strip."""
    groups = groups_of(material.summary.get("tasks", []))
    pictures = [_picture(tasks, _strip(material, key, tasks[0])) for key, tasks in groups.items()]
    if not pictures:
        return None
    return Section("movements", "Movements behind the times", [Words(SAID), LIMBS, *pictures], "Movements")


def groups_of(tasks: Sequence[Task]) -> dict[tuple[str, str], list[Task]]:
    """The emulated tasks by (library, task of the library)."""
    groups: dict[tuple[str, str], list[Task]] = {}
    for task in tasks:
        if task.get("emulated"):
            groups.setdefault((task.get("library", ""), task.get("library_task", task["model"])), []).append(task)
    return groups


def origin_of(what: str, source: Mapping[str, Any]) -> str:
    """What stands behind an emulator: recordings of how many people, whose, under which licence, in which file."""
    recorded = behind(source["source"], source["n_sequences"], source["n_workers"])
    licence = f" · Licence: {source['licence']}" if source.get("licence") else ""
    return f"{what}: {recorded}. {source['source']}{licence} · {source['library']}"


def _picture(tasks: Sequence[Task], strip: bytes) -> Picture:
    first = tasks[0]
    shown_as = first["library_task"] or first["model"]
    said = f"Stick figures of {shown_as} along real time: the mean performance above single draws"
    caption = origin_of(f"mean {quantity(first['mean_s'], 's')}", first)
    return Picture(strip, said, listing([task["task"] for task in tasks]), f"as {shown_as}", caption)


def _strip(material: Material, key: tuple[str, str], task: Task) -> bytes:
    """Drawn once for all variants of a run."""
    if key not in material.pictures:
        material.pictures[key] = _drawn(material.loaded, task)
    return material.pictures[key]


def _drawn(loaded: Any, task: Task) -> bytes:
    from opsim.libraries import load_library, resolve_library
    from opsim.report.strips import draw_strips
    from opsim.tasks.motions import motions_model

    said = loaded.scenario.tasks[task["task"]]
    if hasattr(said, "motions"):
        return draw_strips(motions_model(said, loaded), n_samples=SAMPLES, n_figures=MANY)
    model = load_library(resolve_library(task["library"], loaded.folder))[task["library_task"]]
    return draw_strips(model, n_samples=SAMPLES)
