"""``python -m study_evidence.same_results BEFORE [AFTER]``: two checkouts give the same results of what ships.

Every scenario and study that the checkout BEFORE ships is run by the code of both (AFTER: this checkout), from the
files of BEFORE: numbers of ``summary.json`` to 1e-12, words as they are. For changes of how the house looks alone.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

HERE = Path(__file__).parents[2]
CLOSE = 1e-12
FEW = ("--replications", "2", "--processes", "1")
STUDIES = (
    ("sweep", "serial_line.yaml", "--processes", "1"),
    ("layout", "u_cell.yaml", "--processes", "1"),
    ("select", "serial_line.yaml", "--processes", "1"),
)
TIMES = ("seconds", "wall", "created", "version", "command", "folder", "host", "python", "packages", "engine")
"""Parts of a summary that tell of the machine and the moment."""


def main(before: Path, after: Path) -> int:
    """0 where everything is the same."""
    jobs = [("run", path.name, *FEW) for path in sorted((before / "scenarios").glob("*.yaml"))]
    n_numbers, n_wrong = 0, 0
    for job in [*jobs, *STUDIES]:
        with TemporaryDirectory() as folder:
            found = [_summary(root, before, job, Path(folder) / str(k)) for k, root in enumerate((before, after))]
        lines = list(differences(*found))
        n_numbers, n_wrong = n_numbers + len(list(_leaves(found[0]))), n_wrong + len(lines)
        print(f"{' '.join(job[:2])}: {len(lines)} differ", *lines[:5], sep="\n  ", flush=True)
    print(f"{n_numbers:,} values, {n_wrong} differ")
    return int(n_wrong > 0)


def differences(one: Any, two: Any) -> Iterator[str]:
    """A line for each value that is elsewhere or not the same to ``CLOSE``."""
    ours, theirs = dict(_leaves(one)), dict(_leaves(two))
    yield from (f"{place}: only in one of the two" for place in sorted(set(ours) ^ set(theirs)))
    for place in sorted(set(ours) & set(theirs)):
        a, b = ours[place], theirs[place]
        close = isinstance(a, float) and isinstance(b, float) and abs(a - b) <= CLOSE * max(1.0, abs(a))
        if a != b and not close:
            yield f"{place}: {a!r} and {b!r}"


def _leaves(value: Any, place: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, part in value.items():
            if not any(word in key for word in TIMES):
                yield from _leaves(part, f"{place}/{key}")
    elif isinstance(value, list):
        for number, part in enumerate(value):
            yield from _leaves(part, f"{place}/{number}")
    else:
        yield place, value


def _summary(root: Path, before: Path, job: tuple[str, ...], out: Path) -> Any:
    """What ``opsim`` of a checkout says of a scenario of BEFORE; what it says on the screen where it is refused."""
    verb, name, *options = job
    words = [sys.executable, "-m", "opsim", verb, str(before / "scenarios" / name), "-o", str(out), *options]
    done = subprocess.run(words, env=os.environ | {"PYTHONPATH": str(root)}, capture_output=True, text=True, cwd=root)
    if done.returncode:
        return {"exit": done.returncode, "said": done.stderr.replace(str(out), "OUT")}
    found = {str(path.relative_to(out)): path.read_text(encoding="utf-8") for path in out.rglob("summary.json")}
    return {"exit": 0} | {name: json.loads(text) for name, text in found.items()}


if __name__ == "__main__":
    sys.exit(main(*(Path(word).resolve() for word in [*sys.argv[1:], str(HERE)][:2])))
