"""The table of addresses: all steps are compiled together, or found on disk, when a floor needs them first.

Machine code is one object file for each stamp of the sources, Python, llvmlite and processor. It is written beside and
then moved to its name, so that a reader finds it whole or not at all, and two processes may write the same one.
"""

from __future__ import annotations

import ctypes
import json
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from pathlib import Path
from threading import RLock
from typing import Any
from uuid import uuid4

import llvmlite
import llvmlite.binding as llvm
import numpy as np

from opsim.engine.fast_engine.machine.steps import LINES, STEPS, step_of

ENGINE = Path(__file__).parents[1]
OPSIM = ENGINE.parents[1]
COMPILED_TOO = (ENGINE.parent, OPSIM / "human", OPSIM / "plan", OPSIM / "ergonomics" / "kernels")
SINGLE = tuple(OPSIM / f"{name}.py" for name in ("clock", "layout", "log", "streams", "threads"))
"""Whose functions are compiled into steps as they are written, or whose constants are, such as kinds of rows."""
TABLE = np.zeros(LINES, dtype=np.int64)
MOST_KEPT = 6
"""Object files. Those not used for longest are removed when another one is written."""
LEVEL = int(os.environ.get("TRIAL_LEVEL", "2"))
THRESHOLD = int(os.environ.get("TRIAL_THRESHOLD", "225"))
_LOCK = RLock()
FAILURES: list[tuple[str, str]] = []
"""Exceptions that compiled code raises, by their numbers: the name of the class, and what it says."""
ENTRY = """
define i64 @enter(ptr %function, ptr %answer, ptr %floor, i64 %given) {
 %both = call {i64, i64} %function(ptr %floor, i64 %given)
 %found = extractvalue {i64, i64} %both, 0
 store i64 %found, ptr %answer
 %state = extractvalue {i64, i64} %both, 1
 ret i64 %state
}
!0 = !{!"branch_weights", i32 1, i32 2000}
"""


def complete(told: Callable[[int, int], None] | None = None) -> None:
    """Have every step in the table; ``told(done, total)`` where they have to be compiled."""
    with _LOCK:
        if FAILURES:
            return
        from opsim.engine.fast_engine import lowering

        lowering.know_all()
        lines = sorted(STEPS)
        if (found := _read()) is None:
            if told is not None:
                told(0, len(lines))
            found = compiled(lines)
            _keep(*found)
            if told is not None:
                told(len(lines), len(lines))
        _link(lines, *found)


def is_ready() -> bool:
    """Whether all is compiled, here or on disk."""
    return bool(FAILURES) or (path := path_of()) is not None and path.is_file()


def compiled(lines: list[int]) -> tuple[list[tuple[str, str]], bytes]:
    """What it may raise, and an object file."""
    from opsim.engine.fast_engine.machine.compiler import Module

    made = Module(STEPS, step_of)
    text = made.whole(STEPS[line] for line in lines)
    addresses = ", ".join(f"ptr {STEPS[line].symbol}" for line in lines)
    module = llvm.parse_assembly(f"{ENTRY}@addresses = constant [{len(lines)} x ptr] [{addresses}]\n{text}")
    module.verify()
    machine = _machine()
    options = llvm.create_pipeline_tuning_options(speed_level=LEVEL)
    options.loop_vectorization = options.slp_vectorization = options.loop_unrolling = False
    options.inlining_threshold = THRESHOLD
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return [(kind.__name__, words) for kind, words in made.errors], machine.emit_object(module)


@cache
def _machine() -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    features = llvm.get_host_cpu_features().flatten()
    return target.create_target_machine(cpu=llvm.get_host_cpu_name(), features=features, opt=min(LEVEL, 2), jit=True)


@cache
def _linker() -> Any:
    """NOTE: what it has linked lives as long as the process, as the table leads to it."""
    return llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())


def _link(lines: list[int], failures: list[tuple[str, str]], code: bytes) -> None:
    linker = _linker()
    linker.add_object_file(llvm.ObjectFileRef.from_data(code))
    linker.finalize_object()
    found: Any = (ctypes.c_int64 * len(lines)).from_address(linker.get_global_value_address("addresses"))
    TABLE[lines] = np.frombuffer(found, np.int64)
    FAILURES[:] = [tuple(one) for one in failures] or [("", "")]


def entry() -> int:
    """The address of what enters compiled code."""
    return int(_linker().get_function_address("enter"))


def sources() -> list[Path]:
    """The files that count."""
    return sorted([*(path for folder in COMPILED_TOO for path in folder.rglob("*.py")), *SINGLE])


@cache
def _key() -> str:
    told = [f"{path.relative_to(OPSIM)} {blake2b(path.read_bytes()).hexdigest()}" for path in sources()]
    processor = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    versions = (
        sys.implementation.cache_tag,
        sys.version,
        llvmlite.__version__,
        THRESHOLD,
        os.environ.get("TRIAL_STEP"),
        os.environ.get("TRIAL_HOT"),
    )
    return blake2b(repr((told, processor, versions, LEVEL)).encode(), digest_size=8).hexdigest()


@cache
def path_of() -> Path | None:
    """Where the machine code of these sources is, or will be; None: nothing can be written there."""
    where = Path(os.environ.get("NUMBA_CACHE_DIR") or Path(__file__).parent / "__pycache__")
    with suppress(OSError):
        where.mkdir(parents=True, exist_ok=True)
        return where / f"steps-{_key()}.o"
    return None


def _read() -> tuple[list[tuple[str, str]], bytes] | None:
    with suppress(OSError, ValueError, TypeError):
        data = path_of().read_bytes()  # type: ignore[union-attr]
        digest, head, code = data[:16], *data[16:].split(b"\n", 1)
        if digest == blake2b(data[16:], digest_size=16).digest():
            return json.loads(head), code
    return None


def _keep(failures: list[tuple[str, str]], code: bytes) -> None:
    path = path_of()
    if path is None:
        return
    told = json.dumps(failures).encode() + b"\n" + code
    beside = path.with_name(f"{path.name}.{uuid4().hex[:12]}")
    with suppress(OSError):
        beside.write_bytes(blake2b(told, digest_size=16).digest() + told)
        os.replace(beside, path)
        others = sorted(path.parent.glob("steps-*.o"), key=lambda one: one.stat().st_mtime)
        for one in others[:-MOST_KEPT]:
            one.unlink()
