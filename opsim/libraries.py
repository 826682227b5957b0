"""Motion libraries as scenarios name them: found, looked into, loaded. The only door to ``emulator`` beside the CLI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from opsim.files import NotInside, inside
from opsim.problems import did_you_mean, shown
from opsim.shipped import shipped_folder

HANDS = "hands"
"""What the middle of both wrists is called among joints."""
WRISTS = ("left_wrist", "right_wrist")


class LibraryMissing(ValueError):
    """A library that is not there or cannot be read: ``message`` and ``hint`` in plain words."""

    def __init__(self, message: str, hint: str = ""):
        super().__init__(f"{message}; {hint}" if hint else message)
        self.message, self.hint = message, hint


@dataclass(frozen=True, slots=True)
class HandTarget:
    """Where the middle of both hands is at a mark: above the floor, and before the ankles (None: as recorded)."""

    mark: str
    height_m: float
    ahead_m: float | None = None


def resolve_library(name: str, folder: Path) -> Path:
    """The library's file: in the scenario's folder, else in the shipped one. Raises LibraryMissing."""
    try:
        found = inside(name, folder, shipped_folder())
    except NotInside as error:
        raise LibraryMissing(f"cannot use {shown(name)}: {error}", "copy the library there") from None
    if found is None:
        near = [str(path.relative_to(root)) for root in (folder, shipped_folder()) for path in _libraries_below(root)]
        hint = (
            did_you_mean(name, near, otherwise="libraries found", files=True)
            or "'opsim motion fit' makes one from recordings"
        )
        raise LibraryMissing(f"no library file {shown(name)}", hint)
    return found


def library_tasks(path: Path) -> list[str]:
    """The tasks a library holds, from its header alone. Raises LibraryMissing where it is no library."""
    status = path.stat()
    return list(_tasks(path, status.st_mtime_ns, status.st_size))


def library_people(path: Path) -> dict[str, tuple[str, ...]]:
    """Names of the people each task was learned from, from the library's header alone. Raises LibraryMissing."""
    status = path.stat()
    return {task: _people(plain) for task, plain in _tasks(path, status.st_mtime_ns, status.st_size).items()}


def library_marks(path: Path) -> dict[str, tuple[str, ...]]:
    """Names of the marks of each task, in their order, from the header alone. Raises LibraryMissing."""
    status = path.stat()
    return {
        task: _listed(plain, "mark_names") for task, plain in _tasks(path, status.st_mtime_ns, status.st_size).items()
    }


def library_speeds(path: Path) -> dict[str, tuple[float, float]]:
    """The slowest and the fastest walking, in m/s, of each task that is walking, from the header alone.

    Raises LibraryMissing where the file is no library.
    """
    status = path.stat()
    found = _tasks(path, status.st_mtime_ns, status.st_size).items()
    return {task: speeds for task, plain in found if (speeds := _speeds(plain)) is not None}


def library_skeletons(path: Path) -> dict[str, tuple[tuple[str, ...], tuple[int, ...]]]:
    """Joints and parents of each task's bodies, from the header alone; a task that does not say is left out.

    Raises LibraryMissing where the file is no library.
    """
    status = path.stat()
    found = {task: _skeleton(plain) for task, plain in _tasks(path, status.st_mtime_ns, status.st_size).items()}
    return {task: skeleton for task, skeleton in found.items() if skeleton is not None}


def composite_model(task: str, parts: Sequence[tuple[str, Any, dict[str, float] | None, str]]) -> Any:
    """The TaskModel of motions one after the other: (name in marks, model, condition, key) of each.

    Parts of one key are one task: a worker has one effect in them. Raises ValueError where their skeletons differ.
    """
    from emulator.composite.task import CompositeEmulator, Part

    return CompositeEmulator(task, tuple(Part(*part) for part in parts))


def load_library(path: Path) -> Any:
    """The library itself; ``library[task]`` is a TaskModel. Read once for as long as the file does not change."""
    status = path.stat()
    return _library(path, status.st_mtime_ns, status.st_size)


def library_model(path: Path, task: str, hands: tuple[HandTarget, ...] = ()) -> Any:
    """The TaskModel of a task of a library, its hands at their targets where there are some.

    It is worked out once for a file, a task and its targets. Raises ValueError for targets that cannot be.
    """
    status = path.stat()
    return _reaching(path, status.st_mtime_ns, status.st_size, task, hands) if hands else load_library(path)[task]


FINE, STRETCHED, REFUSED = "fine", "stretched", "refused"
"""How a target lies to what was recorded."""


def recorded_reach(path: Path, task: str, hand: HandTarget) -> tuple[str, str]:
    """How a target lies to what was recorded (FINE, STRETCHED or REFUSED), and the known range in a sentence.

    Raises ValueError for a mark that is not there, and for motion that hands cannot lead.
    """
    status = path.stat()
    return _recorded_reach(path, status.st_mtime_ns, status.st_size, task, hand)


@lru_cache(maxsize=256)
def _recorded_reach(path: Path, _changed: int, _size: int, task: str, hand: HandTarget) -> tuple[str, str]:
    from emulator import Target

    model = load_library(path)[task]
    if not hasattr(model, "reach"):
        raise ValueError(f"{task} is motion of cycles, which hands do not lead")
    asked = Target(HANDS, hand.mark, height_m=hand.height_m, ahead_m=hand.ahead_m)
    found = model.reach(HANDS, hand.mark).verdict(asked)
    return found.word, found.sentence


@lru_cache(maxsize=64)
def _reaching(path: Path, _changed: int, _size: int, task: str, hands: tuple[HandTarget, ...]) -> Any:
    from emulator import Target

    targets = [Target(HANDS, one.mark, height_m=one.height_m, ahead_m=one.ahead_m) for one in hands]
    return load_library(path)[task].given(targets)


@lru_cache(maxsize=8)
def _library(path: Path, _changed: int, _size: int) -> Any:
    from emulator.model.library import MotionLibrary

    return MotionLibrary.load(path)


@lru_cache(maxsize=64)
def _tasks(path: Path, _changed: int, _size: int) -> dict[str, Any]:
    """What the header says of each task."""
    from emulator.model.library import read_header

    try:
        tasks = read_header(path)["tasks"]
    except (OSError, ValueError) as error:
        raise LibraryMissing(str(error).removeprefix(f"{path.parent}/")) from None
    except (KeyError, TypeError):
        tasks = None
    if not isinstance(tasks, dict):
        raise LibraryMissing(f"{path.name}: a motion library without a list of tasks")
    return tasks


def _people(plain: Any) -> tuple[str, ...]:
    return _listed(plain, "workers")


def _listed(plain: Any, key: str) -> tuple[str, ...]:
    """The names that a task's header lists under a key."""
    named = plain.get(key) if isinstance(plain, dict) else None
    return tuple(str(name) for name in named) if isinstance(named, list) else ()


def _speeds(plain: Any) -> tuple[float, float] | None:
    """The speeds of a task that is walking: of cyclic motion whose cycles are steps."""
    if not isinstance(plain, dict) or plain.get("kind") != "cyclic":
        return None
    pace = plain.get("pace")
    if not isinstance(pace, dict) or pace.get("steps") is not True:
        return None
    return walked_m_per_s()


def walked_m_per_s() -> tuple[float, float]:
    """The slowest and the fastest that people of any walking emulator walk."""
    from emulator.cyclic.pace import FASTEST_M_PER_S, SLOWEST_M_PER_S

    return SLOWEST_M_PER_S, FASTEST_M_PER_S


def _skeleton(plain: Any) -> tuple[tuple[str, ...], tuple[int, ...]] | None:
    said = plain.get("skeleton") if isinstance(plain, dict) else None
    names, parents = (said.get(key) if isinstance(said, dict) else None for key in ("names", "parents"))
    if not isinstance(names, list) or not isinstance(parents, list):
        return None
    return tuple(map(str, names)), tuple(map(int, parents))


def _libraries_below(folder: Path) -> list[Path]:
    return sorted([*folder.glob("*.npz"), *folder.glob("libraries/*.npz")])
