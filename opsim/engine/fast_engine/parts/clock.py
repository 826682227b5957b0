"""Time on the grid, as ``opsim.clock`` has it; and the lowest bit of a word: what a processor does at once."""

from __future__ import annotations

import math
from typing import Any

from llvmlite import ir
from numba.core import types

from opsim.engine.fast_engine.machine import inlined
from opsim.engine.fast_engine.machine.compiling import intrinsic

TICKS, STEP = 2.0**20, 2.0**-20
INF, NAN = math.inf, math.nan


@intrinsic
def rounded(_typingctx: Any, number: Any) -> Any:
    """To the nearest whole number, halves to the even one, as ``round``."""

    def codegen(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        double = ir.DoubleType()
        rint = builder.module.declare_intrinsic("llvm.rint", [double], ir.FunctionType(double, [double]))
        return builder.call(rint, args)

    return types.float64(types.float64), codegen


@intrinsic
def lowest_bit(_typingctx: Any, bits: Any) -> Any:
    """The number of the lowest bit that is set; of 0: 64."""

    def codegen(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        return builder.cttz(args[0], ir.Constant(ir.IntType(1), 0))

    return types.int64(types.int64), codegen


@inlined
def on_grid(delay_s: float) -> float:
    """A delay rounded once to a multiple of 2^-20 s, at least one of them; products with powers of 2 are exact."""
    return max(1.0, rounded(delay_s * TICKS)) * STEP


@inlined
def on_grid_from_0(delay_s: float) -> float:
    """The same for what may be 0, or negative."""
    return rounded(delay_s * TICKS) * STEP
