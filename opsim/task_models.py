"""What a modeller gives for a task -> its TaskModel: a model as it is, or the text "library/task"."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from opsim.libraries import library_tasks, load_library
from opsim.names import natural_key
from opsim.problems import did_you_mean, shown
from opsim.shipped import shipped_folder

SEAM = ("mean_duration_s", "draw_worker", "sample")


def task_models(tasks: Any) -> dict[str, Any]:
    """name -> TaskModel. Raises TypeError or ValueError, naming the task that is wrong and what was expected."""
    if not isinstance(tasks, Mapping):
        raise TypeError(f"tasks: expected a mapping of names to task models, found {shown(tasks)}")
    if not tasks:
        raise ValueError("tasks: expected at least one, found an empty mapping")
    return {_name(task): _model(task, given) for task, given in tasks.items()}


def library_model(text: str) -> Any:
    """The emulator of "library/task": library is the path of a file, ``.npz`` or not, or the name of a shipped one.

    Raises ValueError where there is no such library or task, with the nearest that there is.
    """
    library, slash, task = text.rpartition("/")
    if not (library and slash and task):
        raise ValueError(f"expected library/task, found {shown(text)}, such as 'public_movements/deep_squat'")
    file = _file(library)
    if task not in (known := library_tasks(file)):
        raise ValueError(f"no task {shown(task)} in {file.name}; {did_you_mean(task, known, otherwise='tasks in it')}")
    return load_library(file)[task]


def _name(task: Any) -> str:
    if not isinstance(task, str):
        raise TypeError(f"tasks: expected names as text, found {shown(task)}")
    return task


def _model(task: str, given: Any) -> Any:
    if isinstance(given, str):
        try:
            return library_model(given)
        except ValueError as error:
            raise ValueError(f"task {task}: {error}") from None
    missing = [name for name in SEAM if not callable(getattr(given, name, None))]
    if missing or isinstance(given, type):
        found = f"{shown(given)}, a {type(given).__name__} without {', '.join(missing)}" if missing else shown(given)
        raise TypeError(f"task {task}: expected a TaskModel or the text 'library/task', found {found}")
    return given


def _file(library: str) -> Path:
    shipped = shipped_folder() / "libraries"
    name = library if library.endswith(".npz") else f"{library}.npz"
    for path in (Path(library), Path(name), shipped / Path(name).name):
        if path.is_file():
            return path
    known = sorted((path.stem for path in shipped.glob("*.npz")), key=natural_key)
    raise ValueError(f"no library {shown(library)}; {did_you_mean(library, known, otherwise='shipped ones')}")
