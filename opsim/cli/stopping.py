"""Ctrl-C and SIGTERM stop a run once and cleanly; what comes after the first is ignored while ends are tied up."""

from __future__ import annotations

import signal
import threading
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from opsim.cli.verbs import Interrupted

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Terminated(Interrupted):
    """SIGTERM, with a word on what is kept."""

    exit_code = 143


class Stop(KeyboardInterrupt):
    """Somebody wants the run to end; ``number`` is that of the signal."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


@contextmanager
def stops_once() -> Iterator[None]:
    """The first Ctrl-C or SIGTERM in this block raises Stop; later ones do nothing, so that no traceback is left."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, _stop) for number in SIGNALS}
    try:
        yield
    finally:
        if signal.getsignal(signal.SIGINT) is _stop:
            for number, handler in before.items():
                signal.signal(number, handler)


def _stop(number: int, _frame: Any) -> None:
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    raise Stop(number)


def stopped(by: KeyboardInterrupt, kept: str) -> Interrupted:
    """What to raise after a stop, with a word on what is kept; its exit code tells Ctrl-C from SIGTERM."""
    terminated = isinstance(by, Stop) and by.number == signal.SIGTERM
    return (Terminated if terminated else Interrupted)(f"stopped; {kept}")


def held(out: Path, done: Collection[str], wanted: Sequence[str]) -> str:
    """In words, which of the tasks wanted are in ``out`` and which are not."""
    if not done:
        return "nothing was finished"
    return f"{out} holds {', '.join(done)}, not {', '.join(task for task in wanted if task not in done)}"


def written_so_far(written: Sequence[Path], wanted: Sequence[Path]) -> str:
    """In words, which of the files wanted were written and which were not."""
    if not written:
        return "nothing was written"
    missing = ", ".join(str(path) for path in wanted if path not in written)
    return f"written: {', '.join(map(str, written))}" + (f"; not written: {missing}" if missing else "")
