"""Prints how the emulator stands on unseen halves of six recorded classes: ``make motion-evidence``."""

from __future__ import annotations

import argparse
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context

from motion_evidence.halves import CLASSES, path_of
from motion_evidence.judged import Split, judge_split
from motion_evidence.table import lines
from motion_evidence.verdicts import failures


def main(arguments: list[str] | None = None) -> int:
    """0 where every bound holds, 1 where one does not, 2 where the recordings are not at hand."""
    options = _options(arguments)
    absent = [task for task in options.classes if not path_of(task).exists()]
    if absent:
        print(f"needs motion/uiprmd_{absent[0]}.npz in ../shared/data or in $OPSIM_DATA", file=sys.stderr)
        return 2
    splits = judge_all([(task, split) for task in options.classes for split in range(options.splits)], options.draws)
    print("\n".join(lines(splits)))
    found = failures(splits)
    print("\nevery bound holds" if not found else "\ndoes not hold:\n  " + "\n  ".join(found))
    return int(bool(found))


def judge_all(jobs: list[tuple[str, int]], n_draws: int) -> list[Split]:
    """The splits judged in two processes, in the order of ``jobs``; progress with the time left on stderr."""
    start_s, made = time.monotonic(), {}
    with ProcessPoolExecutor(min(2, os.cpu_count() or 1), mp_context=get_context("spawn")) as pool:
        running = {pool.submit(judge_split, *job, n_draws): job for job in jobs}
        for future in as_completed(running):
            made[running[future]] = future.result()
            left_s = (time.monotonic() - start_s) / len(made) * (len(jobs) - len(made))
            print(f"\r{len(made)} of {len(jobs)} splits, {left_s:4.0f} s left ", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return [made[job] for job in jobs]


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m motion_evidence.show", description=__doc__)
    parser.add_argument("classes", nargs="*", metavar="CLASS", help=", ".join(CLASSES))
    parser.add_argument("--splits", type=int, default=10)
    parser.add_argument("--draws", type=int, default=1000)
    options = parser.parse_args(arguments)
    unknown = [name for name in options.classes if name not in CLASSES]
    if unknown:
        parser.error(f"no class {unknown[0]!r}; known: {', '.join(CLASSES)}")
    options.classes = options.classes or list(CLASSES)
    return options


if __name__ == "__main__":
    sys.exit(main())
