"""Numbers of joints where compiled code finds them: the state of muscles, and the loads of a task."""

from __future__ import annotations

from typing import Any

import numba
from numba.core import types

from opsim.engine.fast_engine.machine import inlined
from opsim.engine.fast_engine.machine.compiling import intrinsic
from opsim.human.burden import PARTS
from opsim.human.three_compartment import JOINTS

N_JOINTS, N_NUMBERS = len(JOINTS), 5


def kept_muscles(build: Any, shares: Any) -> int:
    """The address of (J, 5) numbers, as each replication begins with them."""
    assert shares.shape == (N_JOINTS, N_NUMBERS)
    return int(build.floats(shares.ravel()))


@intrinsic
def _floats_at(_typingctx: Any, address: Any) -> Any:
    pointer = types.CPointer(types.float64)

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], context.get_value_type(sig.return_type))

    return pointer(types.int64), codegen


@inlined
def muscles_at(address: int) -> Any:
    """(J, 5), as ``kernels.compartments`` has the state of muscles."""
    return numba.carray(_floats_at(address), (N_JOINTS, N_NUMBERS))


@inlined
def course_at(address: int) -> Any:
    """(PARTS, J) loads."""
    return numba.carray(_floats_at(address), (PARTS, N_JOINTS))
