"""No search for garbage while many small things are made and none is in a cycle."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def without_collecting() -> Iterator[None]:
    """Around what reads or plans: to look for cycles meanwhile costs a fifth of the time, and more in a process that
    holds much else.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
