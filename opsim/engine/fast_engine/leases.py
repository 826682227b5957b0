"""Memory that is lent to logs, and comes back when nobody has them any more.

NOTE: a run of 300,000 rows fills 30 MB. Asked of the system anew for each run, the first touch of every page costs
a third of the run; in a study logs come and go, one after the other.
"""

from __future__ import annotations

import ctypes
from collections import deque
from collections.abc import Iterable
from typing import Any
from weakref import finalize

import numpy as np

MOST_KEPT, MOST_BYTES = 4, 1 << 28
"""Of what nobody has: so many, and together so much."""
MOST_WASTE = 4
"""Times what was asked for: larger memory is not lent for it."""
_kept: deque[np.ndarray] = deque()
"""What came back last comes first. NOTE: memory comes back whenever Python collects what is unused, also in the middle
of the functions here. So there is no lock: each block is taken out before it is looked at."""


def lent(n_bytes: int) -> np.ndarray:
    """(n_bytes or more,) bytes, of any content. Arrays made from it keep it; when the last one is gone it is free."""
    memory = _taken(n_bytes)
    lease: Any = (ctypes.c_uint8 * memory.nbytes).from_address(memory.ctypes.data)
    finalize(lease, _keep, memory).atexit = False
    return np.frombuffer(lease, dtype=np.uint8)


def _taken(n_bytes: int) -> np.ndarray:
    """The smallest of those that are kept and large enough, and not far too large; else new memory."""
    kept = _all_taken()
    fitting = [number for number, memory in enumerate(kept) if n_bytes <= memory.nbytes <= MOST_WASTE * n_bytes]
    if not fitting:
        _put_back(kept)
        return np.empty(n_bytes, dtype=np.uint8)
    found = kept.pop(min(fitting, key=lambda number: kept[number].nbytes))
    _put_back(kept)
    return found


def _keep(memory: np.ndarray) -> None:
    _put_back([memory, *_all_taken()])


def _all_taken() -> list[np.ndarray]:
    found: list[np.ndarray] = []
    while True:
        try:
            found.append(_kept.popleft())
        except IndexError:
            return found


def _put_back(blocks: Iterable[np.ndarray]) -> None:
    """As many as may be kept, those that come first."""
    n, n_bytes = 0, 0
    for memory in blocks:
        if n < MOST_KEPT and n_bytes + memory.nbytes <= MOST_BYTES:
            n, n_bytes = n + 1, n_bytes + memory.nbytes
            _kept.append(memory)
