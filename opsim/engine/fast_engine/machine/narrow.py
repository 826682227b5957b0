"""Numbers of fewer bytes than a word, in columns that others read."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types

from opsim.engine.fast_engine.machine.compiling import intrinsic


def _set(bits: int) -> Any:
    @intrinsic
    def set_number(_typingctx: Any, address: Any, item: Any, value: Any) -> Any:
        def codegen(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
            narrow = ir.IntType(bits)
            items = builder.inttoptr(args[0], narrow.as_pointer())
            builder.store(builder.trunc(args[2], narrow), builder.gep(items, [args[1]], inbounds=True))

        return types.void(types.int64, types.int64, types.int64), codegen

    return set_number


set_byte, set_half = _set(8), _set(32)
"""``set_half(address, item, value)``: item of an array of int32 at an address; of int8."""
