"""One writer at a time: a lock that ends with the process that holds it, however that ends."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class Busy(ValueError):
    """Somebody else writes there now."""


@contextmanager
def locked(path: Path, words: str, wait_s: float = 0.0) -> Iterator[None]:
    """Hold the lock file ``path`` while the block runs; the operating system lets it go when a process is killed.

    words : what is said where another process holds it. wait_s : for so long it is waited for
    Raises Busy, OSError.
    """
    from filelock import FileLock, Timeout

    path.parent.mkdir(parents=True, exist_ok=True)
    lock = FileLock(path)
    try:
        lock.acquire(timeout=wait_s)
    except Timeout:
        raise Busy(words) from None
    try:
        yield
    finally:
        lock.release()
