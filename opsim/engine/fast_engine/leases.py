"""Memory that is lent to logs, and comes back when nobody has them any more.

NOTE: a run of 300,000 rows fills 30 MB. Asked of the system anew for each run, the first touch of every page costs
a third of the run; in a study logs come and go, one after the other.
"""

from __future__ import annotations

import ctypes
from threading import RLock
from typing import Any
from weakref import finalize

import numpy as np

MOST_KEPT, MOST_BYTES = 4, 1 << 28
_kept: list[np.ndarray] = []
_lock = RLock()


def lent(n_bytes: int) -> np.ndarray:
    """(n_bytes or more,) bytes, of any content. Arrays made from it keep it; when the last one is gone it is free."""
    memory = _taken(n_bytes)
    lease: Any = (ctypes.c_uint8 * memory.nbytes).from_address(memory.ctypes.data)
    finalize(lease, _keep, memory).atexit = False
    return np.frombuffer(lease, dtype=np.uint8)


def _taken(n_bytes: int) -> np.ndarray:
    """The smallest of those that are kept and large enough; else new memory."""
    with _lock:
        fitting = [number for number, memory in enumerate(_kept) if memory.nbytes >= n_bytes]
        if fitting:
            return _kept.pop(min(fitting, key=lambda number: _kept[number].nbytes))
    return np.empty(n_bytes, dtype=np.uint8)


def _keep(memory: np.ndarray) -> None:
    if memory.nbytes <= MOST_BYTES:
        with _lock:
            _kept.insert(0, memory)
            del _kept[MOST_KEPT:]
