"""What the SimPy engine writes of all shipped variants and of 1,000 made floors, as hashes in ``golden_logs.txt``.

The made floors have the whole vocabulary, see ``engine_evidence``. ``make golden-logs`` says which floors moved, and in
what; with ``RENEW=1`` it writes their new hashes down. Times count to a microsecond, so that another processor's last
bits change nothing.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from hashlib import sha256
from multiprocessing import get_context
from pathlib import Path

HERE = Path(__file__).resolve().parent
if __name__ == "__main__":
    sys.path[:0] = [str(HERE), str(HERE.parent)]

import numpy as np  # noqa: E402 - the path comes first where this is the program
from checked_floors import plan_of  # noqa: E402
from engine_evidence.floors import N_FLOORS, floor_text, replication_of  # noqa: E402
from rich.console import Console  # noqa: E402
from rich.progress import track  # noqa: E402

from opsim.engine.floor.run import run_plan  # noqa: E402
from opsim.log import EventLog  # noqa: E402
from opsim.plan import compile_plan  # noqa: E402
from opsim.scenario.read import scenarios_in  # noqa: E402
from opsim.shipped import shipped_folder  # noqa: E402

FILE = HERE / "golden_logs.txt"
PARTS = {
    "times": ("start_s", "end_s"),
    "people and places": ("worker", "station", "place_from", "place_to"),
    "jobs": ("source", "job", "product", "operation"),
    "what was done": ("kind", "cause", "task", "performance_id", "k", "progress_from", "progress_to", "pace_shift"),
}
"""Columns of the log that are hashed together, under the words in which a change is told."""
MICROSECONDS = 1e6


@dataclass(frozen=True)
class Golden:
    """What is known of one log: how many rows it has, and a hash for each of ``PARTS``."""

    n_rows: int
    hashes: tuple[str, ...]

    @classmethod
    def of(cls, log: EventLog) -> Golden:
        return cls(len(log), tuple(_hashed(log, columns) for columns in PARTS.values()))

    @classmethod
    def read(cls, words: list[str]) -> Golden:
        return cls(int(words[0]), tuple(words[1:]))

    def moved(self, other: Golden) -> str:
        """In words, what of a log is another than it was; empty where nothing is."""
        parts = [part for part, one, two in zip(PARTS, self.hashes, other.hashes, strict=True) if one != two]
        rows = [] if self.n_rows == other.n_rows else [f"{self.n_rows} rows became {other.n_rows}"]
        return ", ".join([*rows, *parts])

    def __str__(self) -> str:
        return f"{self.n_rows} {' '.join(self.hashes)}"


def _hashed(log: EventLog, columns: tuple[str, ...]) -> str:
    digest = sha256()
    for column in columns:
        values = log[column]
        if values.dtype.kind == "f":
            values = np.where(np.isnan(values), -1.0, np.rint(values * MICROSECONDS))
        digest.update(np.ascontiguousarray(values, dtype=np.int64).tobytes())
    return digest.hexdigest()[:8]


def shipped() -> list[str]:
    """``shipped/file/variant`` of every variant that comes along."""
    files = sorted(shipped_folder().glob("*.yaml"))
    return [f"shipped/{file.stem}/{name}" for file in files for name in scenarios_in(file.read_bytes(), file)]


def made() -> list[str]:
    """``made/number`` of the floors over the whole vocabulary, see ``engine_evidence.floors``."""
    return [f"made/{number}" for number in range(N_FLOORS)]


def log_of(name: str) -> EventLog:
    """What the engine writes of a floor by the name it has in the file."""
    family, _, rest = name.partition("/")
    if family == "made":
        return run_plan(plan_of(floor_text(int(rest))), replication_of(int(rest)))
    stem, variant = rest.split("/", 1)
    file = shipped_folder() / f"{stem}.yaml"
    return run_plan(compile_plan(scenarios_in(file.read_bytes(), file)[variant]))


def golden(name: str) -> Golden:
    """Of a floor, as it is today."""
    return Golden.of(log_of(name))


def written() -> dict[str, Golden]:
    """What is written down, by name."""
    lines = (line.split() for line in FILE.read_text().splitlines() if not line.startswith("#"))
    return {words[0]: Golden.read(words[1:]) for words in lines}


def moved(names: list[str], n_processes: int = 1) -> Iterator[tuple[str, str, Golden]]:
    """(name, what moved, as it is today) of those floors that are not as written down."""
    before = written() if FILE.exists() else {}
    for name, now in zip(names, _all_golden(names, n_processes)):
        said = before[name].moved(now) if name in before else "is new"
        if said:
            yield name, said, now


def _all_golden(names: list[str], n_processes: int) -> Iterator[Golden]:
    if n_processes == 1:
        yield from map(golden, names)
        return
    with ProcessPoolExecutor(n_processes, mp_context=get_context("spawn")) as pool:
        yield from track(pool.map(golden, names, chunksize=8), "floors run", len(names), console=Console(stderr=True))


def main() -> int:
    """0 where nothing moved or the new hashes were written, 1 where something did."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--renew", action="store_true", help="write down what moved")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    names = [*shipped(), *made()]
    found = {name: (said, now) for name, said, now in moved(names, options.processes)}
    before = written() if FILE.exists() else {}
    gone = [name for name in before if name not in names]
    for name, (said, _) in found.items():
        print(f"{name}: {said}")
    print(*(f"{name}: is gone" for name in gone), sep="\n", end="\n" if gone else "")
    of_shipped = sum(name in found for name in shipped())
    of_made = len(found) - of_shipped
    print(f"{of_shipped} of {len(shipped())} shipped variants and {of_made} of {len(made())} made floors moved")
    if options.renew:
        whole = {name: found[name][1] if name in found else before[name] for name in names}
        heading = f"# floor, rows, hashes of {json.dumps(list(PARTS))[1:-1]}; see golden_logs.py"
        FILE.write_text("\n".join([heading, *(f"{name} {one}" for name, one in whole.items())]) + "\n")
    return int(bool(found or gone) and not options.renew)


if __name__ == "__main__":
    sys.exit(main())
