"""Machine code that was kept, made ready to run: by an LLVM linker of the engine's own."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Any

import llvmlite.binding as llvm

from opsim.engine.fast_engine.machine.store import Code

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
