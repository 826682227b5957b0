"""The upper half of a product of two words of 64 bits: one instruction, for which numba has no name."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


def _product_high(_typing: Any, one: Any, other: Any) -> Any:
    """The upper 64 of the 128 bits of ``one * other``, both uint64."""

    def emit(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        wide = ir.IntType(128)
        product = builder.mul(*(builder.zext(value, wide) for value in values))
        return builder.trunc(builder.lshr(product, ir.Constant(wide, 64)), ir.IntType(64))

    return types.uint64(types.uint64, types.uint64), emit


product_high: Any = intrinsic(_product_high)
