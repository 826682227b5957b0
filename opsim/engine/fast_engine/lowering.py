"""Modules of this package that are rules of the floor: found where they are written, with those names for this one's.

They are written in ``opsim.engine.floor`` and in the folders of subjects (``opsim/subjects/people/rotations.py``): what
names the floor there is a rule of it, and known here by its own name alone. They are kept beside what Python has
compiled, as long as neither the rule nor this file changes.
"""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.util
import marshal
import re
import sys
from contextlib import suppress
from functools import cache
from os import getpid, replace
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

WRITTEN, COMPILED = "opsim.engine.floor", "opsim.engine.fast_engine"
HERE = Path(__file__).parent
FLOOR = HERE.parent / "floor"
SUBJECTS = HERE.parents[1] / "subjects"
_OF_A_SUBJECT = re.compile(r"opsim\.subjects\.\w+(?:\.(\w+)| (?=import))")


def know_all() -> None:
    """Have all steps known by their lines: also those of rules that a block comes to only where a plan asks for it."""
    for name in (*rules(), *(path.stem for path in HERE.glob("[!_]*.py"))):
        importlib.import_module(f"{COMPILED}.{name}")


def rules() -> list[str]:
    """Names of all modules of rules, within the package."""
    return sorted(name for name in written() if name != "machine" and not (HERE / f"{name}.py").exists())


@cache
def written() -> dict[str, Path]:
    """Where each rule is written, by its name."""
    of_subjects = [path for path in SUBJECTS.glob("*/[!_]*.py") if WRITTEN in path.read_text(encoding="utf-8")]
    return {path.stem: path for path in (*FLOOR.glob("[!_]*.py"), *of_subjects)}


class Lowering(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Asked after Python's own finders: what this package has a file of is that file."""

    def find_spec(self, name: str, path: Any, target: Any = None) -> Any:
        """Where a module is."""
        if name.startswith(COMPILED + "."):
            file = written().get(name.removeprefix(COMPILED + "."))
            if file is not None:
                return importlib.util.spec_from_file_location(name, file, loader=self)
        return None

    def create_module(self, spec: Any) -> ModuleType | None:
        """An ordinary one."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """What stands in it, lowered."""
        exec(_code(Path(str(module.__file__))), module.__dict__)


def _code(path: Path) -> CodeType:
    """From disk where it is that of today's source, of this pass and this Python."""
    kept = Path(importlib.util.cache_from_source(str(HERE / path.name)))
    times = [of.stat() for of in (path, Path(str(__file__)))]
    key = importlib.util.MAGIC_NUMBER + repr([(one.st_mtime_ns, one.st_size) for one in times] + [str(path)]).encode()
    with suppress(OSError, ValueError, EOFError, TypeError):
        data = kept.read_bytes()
        if data.startswith(key):
            found: CodeType = marshal.loads(data[len(key) :])
            return found
    made = compile(_lowered(path.read_text(encoding="utf-8")), str(path), "exec")
    if not sys.dont_write_bytecode:
        with suppress(OSError):
            _write(kept, key + marshal.dumps(made))
    return made


def _lowered(text: str) -> str:
    """The rules that a rule imports are those of this package; what else it takes from subjects stays theirs."""

    def here(found: re.Match[str]) -> str:
        if found[1] is None:
            return f"{COMPILED} "  # whole modules, which are rules
        return f"{COMPILED}.{found[1]}" if found[1] in written() else found[0]

    return _OF_A_SUBJECT.sub(here, text.replace(WRITTEN, COMPILED))


def _write(kept: Path, data: bytes) -> None:
    """Under another name first, as several processes may do so at once."""
    kept.parent.mkdir(parents=True, exist_ok=True)
    part = kept.with_name(f"{kept.name}.{getpid()}")
    part.write_bytes(data)
    replace(part, kept)


# NOTE: done as this is imported, first of all in this package: the modules after it are found that way.
sys.meta_path.append(Lowering())
