"""MotionLibrary: the emulators of several tasks in one file, with where they come from."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np

from emulator.archive import LibraryError, read_archive, read_header, write_archive

__all__ = ["LibraryError", "MotionLibrary", "file_sha256", "read_header"]


@dataclass(frozen=True, eq=False)
class MotionLibrary(Mapping[str, Any]):
    """Emulators (of repetitions or cyclic) by task name, in order of insertion; ``command`` says what made them.

    ``library["deep_squat"]``; an unknown task raises LibraryError with the nearest name.
    """

    emulators: Mapping[str, Any]
    command: str = ""
    notes: tuple[str, ...] = field(default=())

    @classmethod
    def of(cls, *emulators: Any, command: str = "", notes: tuple[str, ...] = ()) -> MotionLibrary:
        """A library of these emulators. Raises LibraryError where two have one task name."""
        library = cls({}, command, notes)
        for emulator in emulators:
            library = library.add(emulator)
        return library

    def add(self, emulator: Any) -> MotionLibrary:
        """The library with one task more."""
        if emulator.task in self.emulators:
            raise LibraryError(f"task {emulator.task!r} is in the library already")
        return MotionLibrary({**self.emulators, emulator.task: emulator}, self.command, self.notes)

    def merge(self, other: MotionLibrary) -> MotionLibrary:
        """Both libraries' tasks; the commands are kept one after the other."""
        merged = self
        for emulator in other.values():
            merged = merged.add(emulator)
        command = "; ".join(c for c in (self.command, other.command) if c)
        return MotionLibrary(merged.emulators, command, self.notes + other.notes)

    def __getitem__(self, task: str) -> Any:
        if task not in self.emulators:
            near = get_close_matches(str(task), self.emulators, n=1)
            raise LibraryError(
                f"no task {task!r} in the library; "
                + (f"did you mean {near[0]!r}?" if near else f"known: {', '.join(self.emulators)}")
            )
        return self.emulators[task]

    def __contains__(self, task: object) -> bool:
        return task in self.emulators

    def __iter__(self) -> Iterator[str]:
        return iter(self.emulators)

    def __len__(self) -> int:
        return len(self.emulators)

    @property
    def tasks(self) -> tuple[str, ...]:
        return tuple(self.emulators)

    def only(self) -> Any:
        """The emulator of a library that has one task. Raises LibraryError if it has several or none."""
        if len(self) != 1:
            raise LibraryError(f"the library has {len(self)} tasks ({', '.join(self)}); name one")
        return next(iter(self.values()))

    def _repr_html_(self) -> str:
        from emulator.notebook import library_html

        return library_html(self)

    def save(self, path: str | Path) -> None:
        """Write one .npz; the same library gives the same bytes."""
        from emulator.model.serialise import pack

        arrays: dict[str, np.ndarray] = {}
        tasks = {}
        for task, emulator in self.emulators.items():
            tasks[task], parts = pack(emulator)
            arrays |= {f"{task}/{name}": array for name, array in parts.items()}
        header = {"command": self.command, "notes": list(self.notes), "tasks": tasks}
        write_archive(Path(path), header | {"shapes": {name: array.shape for name, array in arrays.items()}}, arrays)

    @staticmethod
    def load(path: str | Path) -> MotionLibrary:
        """Read a library. Raises LibraryError for a foreign, broken or hostile file; nothing in it is ever executed."""
        from emulator.model.serialise import unpack

        header, arrays = read_archive(Path(path))
        try:
            _check_shapes(Path(path), header.get("shapes", {}), arrays)
            emulators = {task: unpack(task, plain, arrays) for task, plain in header["tasks"].items()}
            return MotionLibrary(emulators, str(header["command"]), tuple(str(n) for n in header["notes"]))
        except LibraryError:
            raise
        except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError) as why:
            raise LibraryError(f"{path}: the library is incomplete or inconsistent ({why})") from None


def file_sha256(path: str | Path) -> str:
    """Hash of a file's bytes, for manifests."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def _check_shapes(path: Path, shapes: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> None:
    """Refuse arrays of another shape than the header says; libraries of before say none."""
    wrong = [
        f"{path}: array {name}: found {'none' if name not in arrays else arrays[name].shape}, expected {tuple(shape)}"
        for name, shape in shapes.items()
        if name not in arrays or arrays[name].shape != tuple(shape)
    ]
    if wrong:
        more = [f"{path}: and {len(wrong) - 10} more"] if len(wrong) > 10 else []
        raise LibraryError("\n".join([*wrong[:10], *more]))
