"""Strips for the emulated tasks of a scenario."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from opsim.report.strips import draw_strips

SAMPLES = 2
MANY = 20
"""Figures in a row where a task is several motions."""


def scenario_strips(
    loaded: Any, tasks: Sequence[Mapping[str, Any]], drawn: dict[tuple[str, str], bytes] | None = None
) -> dict[str, bytes]:
    """SVG bytes by task name, of the rows of ``summary["tasks"]`` that are emulated.

    loaded : the variant that was read (its folder is where its libraries are)
    drawn  : pictures drawn so far, by (library, task of the library); added to, so that variants share them
    """
    drawn = {} if drawn is None else drawn
    strips = {}
    for task in tasks:
        if task.get("emulated"):
            key = (task["library"], task["library_task"])
            if key not in drawn:
                drawn[key] = _strip(loaded, task)
            strips[task["task"]] = drawn[key]
    return strips


def _strip(loaded: Any, task: Mapping[str, Any]) -> bytes:
    from opsim.libraries import load_library, resolve_library
    from opsim.tasks.motions import motions_model

    said = loaded.scenario.tasks[task["task"]]
    if hasattr(said, "motions"):
        return draw_strips(motions_model(said, loaded), n_samples=SAMPLES, n_figures=MANY)
    model = load_library(resolve_library(task["library"], loaded.folder))[task["library_task"]]
    return draw_strips(model, n_samples=SAMPLES)
