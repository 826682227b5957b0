"""The table of addresses: steps are compiled, or their machine code is found on disk, when a floor needs them first.

What lacks is compiled at once, with all that it comes to: such steps call each other directly, and are compiled into
each other where that is faster. What was compiled before is called by the table.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterable
from functools import cache
from threading import RLock
from typing import Any

import llvmlite.binding as llvm
import numpy as np

from opsim.engine.fast_engine.machine import code_cache
from opsim.engine.fast_engine.machine.code_cache import Code, stamp_of
from opsim.engine.fast_engine.machine.compiler import Module
from opsim.engine.fast_engine.machine.steps import LINES, STEPS, Step

TABLE = np.zeros(LINES, dtype=np.int64)
FAILURES: dict[int, tuple[str, str]] = {}
"""Exceptions that compiled code raises, by their numbers: the name of the class, and what it says."""
SPEED_LEVEL, INLINING_THRESHOLD = 2, 150
_FRAME = """
define i64 @enter_{name}(ptr %function, ptr %answer, ptr %floor, i64 %given) {{
 %both = call {{i64, i64}} %function(ptr %floor, i64 %given)
 %found = extractvalue {{i64, i64}} %both, 0
 store i64 %found, ptr %answer
 %state = extractvalue {{i64, i64}} %both, 1
 ret i64 %state
}}
@steps_{name} = constant [{n} x ptr] [{addresses}]
!0 = !{{!"branch_weights", i32 1, i32 2000}}
"""
"""What is seen of a module from elsewhere: how Python enters a step, whose answer has two parts, and the addresses."""
_LOCK = RLock()
_ENTRIES: list[int] = []


def complete(steps: Iterable[Step], told: Callable[[int, int], None] | None = None) -> None:
    """Have some steps, and all that they come to, in the table; ``told(done, total)`` where any have to be compiled.

    Raises NotSo, with the file and the line, for what cannot be compiled.
    """
    with _LOCK:
        found, lines = _found(steps)
        _link(found)
        if lines:
            told = told or (lambda _done, _total: None)
            told(0, len(lines))
            made = compiled(STEPS[line] for line in lines)
            code_cache.keep(made)
            _link([made])
            told(len(lines), len(lines))


def lacking(steps: Iterable[Step]) -> list[int]:
    """Lines of those of some steps that would have to be compiled, and of those known that they come to."""
    return _found(steps)[1]


def _found(steps: Iterable[Step]) -> tuple[list[Code], list[int]]:
    """What is on disk for some steps and is not in the table, those with most of them first; and what lacks."""
    lines = {one.line for one in steps if not TABLE[one.line]}
    kept = [one for one in code_cache.kept() if _is_of_today(one)] if lines else []
    found: list[Code] = []
    while lines and kept:
        best = max(kept, key=lambda one: len(lines & one.steps.keys()))
        if not lines & best.steps.keys():
            break
        kept.remove(best)
        found.append(best)
        has = {line for one in found for line in one.steps}
        lines = {line for line in lines.union(best.calls) if line not in has and not TABLE[line]}
    return found, sorted(lines)


def _is_of_today(code: Code) -> bool:
    """Whether the files that its steps stand in, as far as they were imported, are those that it was compiled from."""
    ours = ((STEPS[line], stamp) for line, stamp in code.steps.items() if line in STEPS)
    return all(stamp_of(one.function.__code__.co_filename) == stamp for one, stamp in ours)


def compiled(steps: Iterable[Step]) -> Code:
    """Machine code of some steps, and of all that they come to and is not in the table. Raises NotSo."""
    made = Module(steps, lambda line: bool(TABLE[line]))
    lines = sorted(made.steps)
    stamps = {line: stamp_of(made.steps[line].function.__code__.co_filename) for line in lines}
    code = Code(stamps, tuple(sorted(made.calls)), made.failures, b"")
    addresses = ", ".join(f"ptr {made.steps[line].symbol}" for line in lines)
    frame = _FRAME.format(name=code.name, n=len(lines), addresses=addresses)
    return Code(code.steps, code.calls, code.failures, machine_code(frame + made.text))


def machine_code(text: str) -> bytes:
    """An object file of what stands in LLVM's language."""
    module, machine = llvm.parse_assembly(text), _machine()
    module.verify()
    options = llvm.create_pipeline_tuning_options(speed_level=SPEED_LEVEL)
    options.loop_vectorization = options.slp_vectorization = options.loop_unrolling = False
    options.inlining_threshold = INLINING_THRESHOLD
    passes = llvm.create_pass_builder(machine, options)
    passes.getModulePassManager().run(module, passes)
    made: bytes = machine.emit_object(module)
    return made


@cache
def _machine() -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    features = llvm.get_host_cpu_features().flatten()
    return target.create_target_machine(cpu=llvm.get_host_cpu_name(), features=features, opt=2, jit=True)


@cache
def _linker() -> Any:
    """NOTE: what it has linked lives as long as the process, as the table leads to it."""
    return llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())


def _link(codes: list[Code]) -> None:
    """Put what they hold into the table."""
    if not codes:
        return
    linker = _linker()
    for one in codes:
        linker.add_object_file(llvm.ObjectFileRef.from_data(one.machine_code))
    linker.finalize_object()
    for one in codes:
        lines = sorted(one.steps)
        at = linker.get_global_value_address(f"steps_{one.name}")
        TABLE[lines] = np.ctypeslib.as_array((ctypes.c_int64 * len(lines)).from_address(at))
        FAILURES.update(one.failures)
        _ENTRIES.append(int(linker.get_function_address(f"enter_{one.name}")))
    code_cache.used()


def entry() -> int:
    """The address of what enters a step of the table."""
    return _ENTRIES[0]
