"""Items are handed to processes by the handful, since one at a time costs all of them together 0.2 ms for each."""

from collections.abc import Callable, Iterable, Iterator
from time import perf_counter
from typing import Any, NamedTuple

AT_ONCE_S = 0.01
"""Work of a handful."""
MOST_S = 2 * AT_ONCE_S
"""What has not begun by then is given back: who works on one that takes long does not keep others from being done."""


class Done(NamedTuple):
    """What became of a handful: results of its first items, those that there was no time for, the seconds it took."""

    results: list[Any]
    undone: list[Any]
    took_s: float


def do(work: Callable[[Any], Any], items: list[Any]) -> Done:
    """As many items of a handful as there is time for, one at least. Raises what work raises, with nothing done before:
    an item at which it raises later is given back, so that no result is lost, and raises again as the first of its own.
    """
    results, took_s, started = list[Any](), 0.0, perf_counter()
    while len(results) < len(items) and took_s < MOST_S:
        try:
            results.append(work(items[len(results)]))
        except Exception:
            if results:
                break
            raise
        took_s = perf_counter() - started
    return Done(results, items[len(results) :], took_s)


def next_size(last: Done) -> int:
    """How many items the next handful has: at most twice as many as this one did, for some come sooner than others."""
    n = len(last.results)
    return max(1, min(2 * n, int(n * AT_ONCE_S / last.took_s))) if last.took_s > 0 else 2 * n


class Left(Iterator[Any]):
    """Items that are to be done; those that were given back come first."""

    def __init__(self, items: Iterable[Any]) -> None:
        self._items, self._back = iter(items), list[Any]()

    def __next__(self) -> Any:
        return self._back.pop() if self._back else next(self._items)

    def give_back(self, items: list[Any]) -> None:
        self._back += items
