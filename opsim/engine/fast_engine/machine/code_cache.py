"""Machine code on disk: a folder for each stamp of the sources, in it a file for each set of steps compiled together.

A file is written beside and then moved to its name, so that a reader finds it whole or not at all, and two processes
may write the same one.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache
from hashlib import blake2b
from os.path import relpath
from pathlib import Path
from typing import Any
from uuid import uuid4

import llvmlite
import llvmlite.binding as llvm

from opsim.engine.fast_engine.lowering import SUBJECTS, written

ENGINE = Path(__file__).parents[1]
OPSIM = ENGINE.parents[1]
COMPILED_TOO = (ENGINE.parent, OPSIM / "plan", SUBJECTS / "human", OPSIM / "ergonomics" / "kernels")
"""With all that the subjects' rules and plans say."""
SINGLE = tuple(OPSIM / f"{name}.py" for name in ("clock", "layout", "log", "streams", "threads"))
"""Whose functions are compiled into steps as they are written, or whose constants are, such as kinds of rows."""
SEEN_FROM_PYTHON = ("arena.py", "calling.py", "code_cache.py", "__init__.py")
"""Nothing of these is compiled, nor says how."""


def sources() -> list[Path]:
    """The files that count."""
    found = {path for folder in COMPILED_TOO for path in folder.rglob("*.py")}
    found |= {*written().values(), *SUBJECTS.glob("*/plan.py")}
    here = {ENGINE / "machine" / name for name in SEEN_FROM_PYTHON}
    return sorted(path for path in (*found, *SINGLE) if path not in here)


@cache
def source_of(path: str) -> bytes:
    """What stands in a file when it is first asked for: what is compiled is what was imported. Raises OSError."""
    return Path(path).read_bytes()


def stamp_of(path: str) -> str:
    """Of what stands in a file; nothing where it cannot be read.

    NOTE: times would be quicker, but an image or an archive may give two versions of a file the same time, and one
    version two times.
    """
    try:
        return blake2b(source_of(path), digest_size=8).hexdigest()
    except OSError:
        return ""


def _stamp() -> str:
    """Of names and contents of the sources."""
    told = [f"{relpath(path, OPSIM)} {stamp_of(str(path))}" for path in sources()]
    return blake2b("\n".join(told).encode(), digest_size=8).hexdigest()


STAMP = _stamp()


FORMAT = b"opsim steps 2\n"
PREFIX, SUFFIX = "steps-", ".steps"
MOST_FOLDERS = 6
"""Of stamps. Those not used for longest are removed when another one is begun; whoever needs them compiles anew."""
_DIGEST = 16


@dataclass(frozen=True)
class Code:
    """steps : by the lines of those in it, the stamps of their files; calls : lines of others, by the table

    failures : what it may raise, by numbers: the name of the class, and what it says; machine_code : an object file
    """

    steps: dict[int, str]
    calls: tuple[int, ...]
    failures: dict[int, tuple[str, str]]
    machine_code: bytes

    @property
    def name(self) -> str:
        """Of its file: the same for the same steps, also where one of their files has changed."""
        return blake2b(repr(sorted(self.steps)).encode(), digest_size=8).hexdigest()

    def packed(self) -> bytes:
        """As it is kept."""
        said = {name: value for name, value in asdict(self).items() if name != "machine_code"}
        told = json.dumps(said).encode() + b"\n" + self.machine_code
        return FORMAT + blake2b(told, digest_size=_DIGEST).digest() + told

    @staticmethod
    def unpacked(data: bytes) -> Code | None:
        """None: it is not whole, or something else."""
        begin = len(FORMAT) + _DIGEST
        told = data[begin:]
        if data[:begin] != FORMAT + blake2b(told, digest_size=_DIGEST).digest():
            return None
        head, _, machine_code = told.partition(b"\n")
        said = json.loads(head)
        failures = {int(number): (name, words) for number, (name, words) in said["failures"].items()}
        steps = {int(line): stamp for line, stamp in said["steps"].items()}
        return Code(steps, tuple(said["calls"]), failures, machine_code)


def place() -> Path | None:
    """Where numba keeps what it compiles of this package; None: nothing can be written there, nor anywhere else."""
    from numba.core.caching import FunctionCache

    try:
        return Path(FunctionCache(place).cache_path)
    except RuntimeError:
        return None


@cache
def folder() -> Path | None:
    """Where the machine code of these sources is, or will be, by this Python and LLVM for this processor."""
    found = place()
    return None if found is None else found / (PREFIX + _key())


def _key() -> str:
    """Of all that machine code depends on, and what numba compiles for draws of numbers."""
    import numba

    processor = llvm.get_process_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    versions = sys.implementation.cache_tag, sys.version, numba.__version__, llvmlite.__version__
    return blake2b(repr((STAMP, versions, processor)).encode(), digest_size=8).hexdigest()


@cache
def shipped() -> Path | None:
    """Beside the sources, where an image was made that holds machine code: who runs it may read there, and not write.

    None: there is none, or it is ``folder`` itself, or ``NUMBA_CACHE_DIR`` says where to look.
    """
    from numba.core import config

    known: Any = config
    found = Path(__file__).parent / "__pycache__" / (PREFIX + _key())
    return found if not known.CACHE_DIR and found != folder() and found.is_dir() else None


def kept() -> list[Code]:
    """All that is there to read, be it shipped; what is not whole is as none."""
    found = []
    for where in (folder(), shipped()):
        if where is not None:
            with suppress(OSError):
                found += [Code.unpacked(one.read_bytes()) for one in sorted(where.glob("*" + SUFFIX))]
    return [one for one in found if one is not None]


def keep(code: Code) -> bool:
    """Keep machine code for later; whether that was possible."""
    where = folder()
    if where is None:
        return False
    path = where / (code.name + SUFFIX)
    beside = path.with_name(f"{path.name}.{uuid4().hex[:12]}")
    try:
        if not where.is_dir():
            where.mkdir(parents=True, exist_ok=True)
            forget_old(where)
        beside.write_bytes(code.packed())
        os.replace(beside, path)
    except OSError:  # a full disk, say: the next process compiles anew
        return False
    finally:  # nothing is left of it, where somebody interrupts this either
        with suppress(OSError):
            beside.unlink()
    return True


def mark(name: str) -> None:
    """Note that something else of these sources is compiled, and kept elsewhere."""
    if (where := folder()) is not None:
        with suppress(OSError):
            where.mkdir(parents=True, exist_ok=True)
            (where / f"{name}.done").touch()


def is_marked(name: str) -> bool:
    """Whether that was noted."""
    where = folder()
    return where is not None and (where / f"{name}.done").is_file()


def used() -> None:
    """Say that the folder is in use, so that others are forgotten first."""
    if (where := folder()) is not None:
        with suppress(OSError):
            os.utime(where)


def forget_old(current: Path) -> None:
    """Remove the folders of stamps that were not used for longest, all but ``MOST_FOLDERS``."""

    def used_at(one: Path) -> float:
        with suppress(OSError):
            return one.stat().st_mtime
        return 0.0

    others = [one for one in current.parent.glob(PREFIX + "*") if one != current]
    for one in sorted(others, key=used_at)[: max(0, len(others) + 1 - MOST_FOLDERS)]:
        shutil.rmtree(one, ignore_errors=True)
