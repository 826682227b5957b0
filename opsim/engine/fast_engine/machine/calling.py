"""Steps called from Python at their addresses, without numba's wrappers, which would be compiled and read as well."""

from __future__ import annotations

import ctypes
import pickle
from collections.abc import Callable
from typing import Any

from opsim.engine.fast_engine.machine.steps import step_of
from opsim.engine.fast_engine.machine.table import TABLE

FINE, FINE_AND_NONE = 0, -2
"""What compiled functions answer in numba's convention; anything else: an exception."""
UNREADABLE = (pickle.UnpicklingError, EOFError, AttributeError, ImportError, LookupError, TypeError, ValueError)
"""What is raised where the bytes of an exception are none, or its class is not there or asks for something else."""
_POINTERS = [ctypes.c_void_p, ctypes.c_void_p]


class _Raised(ctypes.Structure):
    """What numba's convention says of an exception: bytes with its class and what it was made with."""

    _fields_ = [("data", ctypes.c_void_p), ("size", ctypes.c_int32)]


def caller(call: Any) -> Callable[..., int]:
    """A function of Python for a step of a floor's address and of numbers; its answer is a number, 0 for nothing."""
    one = step_of(call)
    made = ctypes.CFUNCTYPE(ctypes.c_int32, *_POINTERS, *[ctypes.c_int64] * len(one.signature.args))

    def called(*arguments: int) -> int:
        answer, raised = ctypes.c_int64(0), ctypes.POINTER(_Raised)()
        state = made(int(TABLE[one.line]))(ctypes.byref(answer), ctypes.byref(raised), *arguments)
        if state not in (FINE, FINE_AND_NONE):
            raise _exception(one.name, raised)
        return answer.value

    return called


def _exception(name: str, raised: Any) -> BaseException:
    """The exception itself, as far as it can be told."""
    try:
        kind, given = pickle.loads(ctypes.string_at(raised.contents.data, raised.contents.size))[:2]
        return kind(*(given or ()))
    except UNREADABLE as error:
        return SystemError(f"{name}: compiled code has failed, and how cannot be read: {error}")
