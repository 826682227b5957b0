"""Machine code of steps on disk: a folder for each stamp of the sources, in it one small file for each step.

numba's own files take 10 ms each to read, as they hold more than machine code, and know of changes of no file but the
one that a function stands in: a step that reads a field of a struct, or calls another step, must be compiled anew when
that one changes. So a stamp of all sources stands in every type, and these files hold machine code alone, linked all at
once by a linker of the engine's own. A file is written beside and then moved to its name, so that a reader finds it
whole or not at all, and two processes may write the same one.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
import warnings
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from hashlib import blake2b
from os.path import relpath
from pathlib import Path
from typing import Any
from uuid import uuid4

import llvmlite.binding as llvm


class SlowCompiling(UserWarning):
    """The engine compiles in a slower way, or cannot keep what it has compiled."""


_SAID = set[str]()


def say(name: str, what: str, error: BaseException) -> None:
    """NOTE: once for each kind of error, not for each function: where numba is another one, all of them fail alike."""
    if type(error).__name__ + what not in _SAID:
        _SAID.add(type(error).__name__ + what)
        first = next(iter(str(error).splitlines()), "")
        warnings.warn(f"{name}: {what} ({type(error).__name__}: {first})", SlowCompiling, stacklevel=3)


ENGINE = Path(__file__).parents[1]
OPSIM = ENGINE.parents[1]
COMPILED_TOO = (ENGINE.parent, OPSIM / "human", OPSIM / "plan", OPSIM / "ergonomics" / "kernels")
SINGLE = tuple(OPSIM / f"{name}.py" for name in ("clock", "layout", "log", "streams", "threads"))
"""Whose functions are compiled into steps as they are written, or whose constants are, such as kinds of rows."""
SEEN_FROM_PYTHON = ("arena.py", "calling.py", "code_cache.py", "table.py", "__init__.py")
"""Nothing of these is compiled."""


def sources() -> list[Path]:
    """The files that count."""
    found = [path for folder in COMPILED_TOO for path in folder.rglob("*.py")]
    here = {ENGINE / "machine" / name for name in SEEN_FROM_PYTHON}
    return sorted(path for path in (*found, *SINGLE) if path not in here)


@cache
def stamp_of(path: str) -> str:
    """Of what stands in a file when it is first asked for; nothing where it cannot be read.

    NOTE: times would be quicker, but an image or an archive may give two versions of a file the same time, and one
    version two times.
    """
    try:
        return blake2b(Path(path).read_bytes(), digest_size=16).hexdigest()
    except OSError:
        return ""


def _stamp() -> str:
    """Of names and contents of the sources."""
    told = [f"{relpath(path, OPSIM)} {stamp_of(str(path))}" for path in sources()]
    return blake2b("\n".join(told).encode(), digest_size=8).hexdigest()


STAMP = _stamp()


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


RUNTIME = "NRT_"


@cache
def _linker() -> Any:
    """NOTE: what it has linked lives as long as the process, as the table leads to it."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_triple(llvm.get_process_triple()).create_target_machine(jit=True)
    return llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)


def can_link(code: Code) -> bool:
    """Whether all is there that it calls. NOTE: LLVM would end the process where something is not."""
    if any(name.startswith(RUNTIME) for name in code.needs):
        _know_runtime()
    return all(llvm.address_of_symbol(name) for name in code.needs)


@cache
def _know_runtime() -> None:
    """Have numba's runtime known by its names, which code with arrays in it calls."""
    from numba.core.registry import cpu_target
    from numba.core.runtime import rtsys

    rtsys.initialize(cpu_target.target_context)


def link(codes: Iterable[Code]) -> list[int]:
    """Addresses of their functions."""
    wanted, linker = list(codes), _linker()
    for code in wanted:
        linker.add_object_file(llvm.ObjectFileRef.from_data(code.machine_code))
    linker.finalize_object()
    return [int(linker.get_function_address(code.name)) for code in wanted]
