"""Must-show: the fast engine writes the log of the SimPy engine, row by row, on 1,000 random floors.

``PYTHONPATH=tests python -m engine_evidence.equality [n]`` runs the first n floors (1000) on both engines and compares
all columns to the last bit; then how many floors use each block of the vocabulary. ``--shipped`` runs all variants of
all shipped scenarios, two replications each. Exit code 1 where anything differs, and over all floors where a block is
in fewer than 25 of them, fewer than 20 jobs finish in one, or nothing ties; also where there is nothing to compare.
"""

from __future__ import annotations

import argparse
import faulthandler
import os
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from multiprocessing import get_context
from typing import Any

from engine_evidence.compared import Seen, floor_seen, shipped, shipped_seen
from engine_evidence.coverage import VOCABULARY
from engine_evidence.floors import ENOUGH_JOBS, N_FLOORS
from engine_evidence.sample import SAMPLE

ENOUGH_FLOORS = 25
PROCESSES = 2
MOST_S = 600.0
"""That one job may take, compiling included, before its process is ended."""
Look = Callable[[Any], Seen | None]
"""What looks at one job: a floor's number, or a shipped file and variant."""


def compared(
    jobs: Iterable, look: Look, processes: int = PROCESSES, most_s: float = MOST_S, how: str | None = None
) -> list[Seen]:
    """What each of some jobs shows, in their order, with a word on how far it is.

    A job whose process dies (an engine that writes where it may not), or which does not come to an end, is told of, and
    the others go on. ``how`` processes are begun, as multiprocessing says it.
    """
    left, found = list(enumerate(jobs)), dict[int, Seen | None]()
    n, began, watched = len(left), time.monotonic(), partial(_watched, look, most_s)
    until_one_dies = partial(_until_one_dies, look=watched, how=how)
    while left:
        for number, one in until_one_dies(left, processes=processes):
            found[number] = one
            _tell(one)
            _progress(len(found), n, time.monotonic() - began)
        left = [(number, job) for number, job in left if number not in found]
        for number, job in left[: 2 * processes + 1]:  # one of those that were begun has died: each of them alone
            since = time.monotonic()
            alone = list(until_one_dies([(number, job)], processes=1))
            why = "no end" if time.monotonic() - since > most_s else "its process died"
            found[number] = alone[0][1] if alone else Seen(f"{job}", frozenset(), trouble=why)
            _tell(found[number])
        left = [(number, job) for number, job in left if number not in found]
    sys.stderr.write("\n")
    return [one for number in sorted(found) if (one := found[number]) is not None]


def _until_one_dies(
    jobs: Sequence[tuple[int, Any]], look: Look, processes: int, how: str | None
) -> Iterator[tuple[int, Seen | None]]:
    """(number, what it shows) of jobs, up to the first whose process dies."""
    with ProcessPoolExecutor(processes, mp_context=get_context(how)) as pool:
        futures = [(number, pool.submit(look, job)) for number, job in jobs]
        for number, future in futures:
            try:
                yield number, future.result()
            except BrokenProcessPool:
                return


def _watched(look: Look, most_s: float, job: Any) -> Seen | None:
    """What a job shows; its process ends where that takes too long, whatever it does: compiled code hears no signal."""
    with open(os.devnull, "w") as nowhere:
        faulthandler.dump_traceback_later(most_s, exit=True, file=nowhere)
        try:
            return look(job)
        finally:
            faulthandler.cancel_dump_traceback_later()


def _tell(one: Seen | None) -> None:
    if one is not None and (one.differs or one.trouble):
        sys.stderr.write("\r")
        print(f"{one.name}: {one.trouble or 'differs at ' + one.differs}", flush=True)


def _progress(number: int, n: int, spent_s: float) -> None:
    if number % 10 == 0 or number == n:
        left_s = spent_s / number * (n - number)
        sys.stderr.write(f"\r{number} of {n}, {left_s:.0f} s left   ")
        sys.stderr.flush()


def table(found: Sequence[Seen]) -> str:
    """Of each block: how many floors have it, jobs finished and instants tied in them, and how many are not equal."""
    lines = [f"{'block':<36}{'floors':>8}{'finished':>10}{'ties':>9}{'unequal':>8}"]
    for word in [*VOCABULARY, ""]:
        of = [one for one in found if word in one.words or not word]
        numbers = (len(of), sum(one.n_finished for one in of), sum(one.n_ties for one in of), n_wrong(of))
        lines.append(f"{word or 'all':<36}{numbers[0]:>8,}{numbers[1]:>10,}{numbers[2]:>9,}{numbers[3]:>8,}")
    return "\n".join(lines)


def n_wrong(found: Iterable[Seen]) -> int:
    """How many differ, failed, or were refused."""
    return sum(one.is_wrong for one in found)


def told_of(found: Sequence[Seen]) -> str:
    """The end of the table in sentences: how many were compared, and what the fast engine refused."""
    refused = Counter(one.refused for one in found if one.refused)
    n_equal = sum(not one.is_wrong and one.fast_s > 0 for one in found)
    lines = [
        f"{len(found):,} run, {n_equal:,} equal, {n_wrong(found):,} not; {sum(one.n_rows for one in found):,} rows"
    ]
    lines += [f"simpy {sum(one.simpy_s for one in found):.1f} s, fast {sum(one.fast_s for one in found):.1f} s"]
    return "\n".join([*lines, *(f"refused {n} times: {words}" for words, n in refused.most_common())])


def shortfalls(found: Sequence[Seen]) -> list[str]:
    """What the 1,000 floors fall short of, in sentences."""
    seen = Counter(word for one in found for word in one.words)
    few = [f"{word}: in {seen[word]} floors" for word in VOCABULARY if seen[word] < ENOUGH_FLOORS]
    few += [f"{one.name}: {one.n_finished} finished jobs" for one in found if one.n_finished < ENOUGH_JOBS]
    return few + [f"{one.name}: nothing ties" for one in found if not one.n_ties]


def main() -> int:
    """The exit code."""
    asked = _asked()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if asked.shipped:
        look = partial(_shipped, horizon_s=asked.horizon and asked.horizon * 3600, simpy_only=asked.simpy_only)
        found = compared(list(shipped()), look, asked.processes)
    else:
        numbers = SAMPLE if asked.sample else range(asked.first, asked.n if asked.to is None else asked.to)
        look = partial(floor_seen, only=asked.only, simpy_only=asked.simpy_only)
        found = compared(numbers, look, asked.processes)
    print(table(found))
    print(told_of(found))
    whole = len(found) >= N_FLOORS and not asked.shipped
    short = shortfalls(found) if whole else []
    print("\n".join(short))
    return int(bool(not found or n_wrong(found) or short))


def _shipped(which: tuple[str, str, int], **how) -> Seen:
    return shipped_seen(*which, **how)


def _asked() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="engine_evidence.equality", description=__doc__)
    parser.add_argument("n", type=int, nargs="?", default=N_FLOORS, help="so many floors, from the first one on")
    parser.add_argument("--from", dest="first", type=int, default=0, help="the first floor")
    parser.add_argument("--to", type=int, help="the floor before which to end")
    parser.add_argument("--sample", action="store_true", help="the floors of engine_evidence.sample")
    parser.add_argument(
        "--only", default="", metavar="BLOCK", help=f"floors that use a block, such as {VOCABULARY[1]!r}"
    )
    parser.add_argument("--simpy-only", action="store_true", help="coverage alone: nothing is compared")
    parser.add_argument("--shipped", action="store_true", help="the shipped scenarios and their variants")
    parser.add_argument("--horizon", type=float, metavar="H", help="shipped: at most so many hours")
    parser.add_argument("--processes", type=int, default=PROCESSES)
    asked = parser.parse_args()
    if asked.only and asked.only not in VOCABULARY:
        parser.error(f"no block is called {asked.only!r}; they are: " + "; ".join(VOCABULARY))
    return asked


if __name__ == "__main__":
    sys.exit(main())
