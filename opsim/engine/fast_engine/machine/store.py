"""Machine code of steps on disk: a folder for each stamp of the sources, in it one small file for each step.

numba's own files take 10 ms each to read, as they hold more than machine code. These hold that alone, and are linked
all at once. A file is written beside and then moved to its name, so that a reader finds it whole or not at all, and
two processes may write the same one.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import Any
from uuid import uuid4

from opsim.engine.fast_engine.machine.stamp import STAMP, stamp_of

FORMAT = b"opsim step 1\n"
PREFIX = "steps-"
MOST_FOLDERS = 6
"""Of stamps. Those not used for longest are removed when another one is begun; whoever needs them compiles anew."""
_DIGEST = 16


@dataclass(frozen=True)
class Code:
    """name : of the function in it; needs : of those elsewhere that it calls; machine_code : an object file"""

    name: str
    needs: tuple[str, ...]
    machine_code: bytes

    def packed(self) -> bytes:
        told = json.dumps({"name": self.name, "needs": self.needs}).encode() + b"\n" + self.machine_code
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
        return Code(said["name"], tuple(said["needs"]), machine_code)


def place() -> Path | None:
    """Where numba keeps what it compiles of this package; None: nothing can be written there, nor anywhere else."""
    from numba.core.caching import FunctionCache

    try:
        return Path(FunctionCache(place).cache_path)
    except RuntimeError:
        return None


@cache
def folder() -> Path | None:
    """Where the machine code of these sources is, or will be, by this Python and numba for this processor."""
    found = place()
    return None if found is None else found / (PREFIX + _key())


def _key() -> str:
    """Of all that machine code depends on besides the file of its step."""
    import llvmlite
    import numba
    from numba.core import config
    from numba.core.registry import cpu_target

    processor = cpu_target.target_context.codegen().magic_tuple()
    versions = (sys.implementation.cache_tag, sys.version, numba.__version__, llvmlite.__version__)
    known: Any = config
    settings = (str(known.OPT), known.ENABLE_AVX)
    return blake2b(repr((STAMP, versions, processor, settings)).encode(), digest_size=8).hexdigest()


@cache
def shipped() -> Path | None:
    """Beside the sources, where an image was made that holds machine code: who runs it may read there, and not write.

    None: there is none, or it is ``folder`` itself, or ``NUMBA_CACHE_DIR`` says where to look.
    """
    from numba.core import config

    known: Any = config
    found = Path(__file__).parent / "__pycache__" / (PREFIX + _key())
    return found if not known.CACHE_DIR and found != folder() and found.is_dir() else None


def path_of(function: Callable, line: int) -> Path | None:
    """The file of a step: another one when the file changes in which the step is written."""
    where = folder() or shipped()
    if where is None:
        return None
    stamp = stamp_of(function.__code__.co_filename)
    told = f"{function.__module__}.{function.__qualname__} {function.__code__.co_firstlineno} {stamp}"
    return where / f"{line:05d}-{blake2b(told.encode(), digest_size=6).hexdigest()}.step"


def _places(path: Path | None) -> list[Path]:
    """Where it may be: where it would be written, then where it was shipped."""
    if path is None:
        return []
    other = shipped()
    return [path] if other is None or other == path.parent else [path, other / path.name]


def read(path: Path | None) -> Code | None:
    """What is kept there, or was shipped; None: nothing, or nothing of use."""
    for one in _places(path):
        with suppress(OSError):
            if (found := Code.unpacked(one.read_bytes())) is not None:
                return found
    return None


def is_kept(path: Path | None) -> bool:
    """Whether there is something to read."""
    return any(one.is_file() for one in _places(path))


def keep(path: Path | None, code: Code) -> bool:
    """Keep machine code for later; whether that was possible."""
    if path is None or path.parent == shipped():
        return False
    beside = path.with_name(f"{path.name}.{uuid4().hex[:12]}")
    try:
        if not path.parent.is_dir():
            path.parent.mkdir(parents=True, exist_ok=True)
            forget_old(path.parent)
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
    where = folder()
    return where is not None and (where / f"{name}.done").is_file()


def used(path: Path | None) -> None:
    """Say that a folder is in use, so that others are forgotten first."""
    if path is not None:
        with suppress(OSError):
            os.utime(path.parent)


def forget_old(current: Path) -> None:
    """Remove the folders of stamps that were not used for longest, all but ``MOST_FOLDERS``."""

    def used_at(one: Path) -> float:
        with suppress(OSError):
            return one.stat().st_mtime
        return 0.0

    others = [one for one in current.parent.glob(PREFIX + "*") if one != current]
    for one in sorted(others, key=used_at)[: max(0, len(others) + 1 - MOST_FOLDERS)]:
        shutil.rmtree(one, ignore_errors=True)


__all__ = [
    *("MOST_FOLDERS", "PREFIX", "Code", "folder", "forget_old", "is_kept", "is_marked", "keep", "mark", "path_of"),
    *("place", "read", "shipped", "used"),
]
