"""Runs of shipped scenarios, and one under hostile names, exported, read by pm4py, and counted against the log.

PYTHONPATH=tests:. python -m ocel_evidence.show --reader OTHER/bin/python -o FOLDER
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

SHIPPED = ("repack_cell", "pump_plant", "forklift", "assembly", "two_shift_plant", "eight_station_cell")
HOSTILE = "hostile"
HERE = Path(__file__).parent
ENDINGS = (".jsonocel", ".sqlite")


class Line(NamedTuple):
    """One claim of a file, what was found, and whether it holds."""

    file: str
    claim: str
    found: str
    holds: bool


def main(arguments: list[str] | None = None) -> int:
    """0 where everything holds, 1 where something does not, 2 where the reader is not at hand."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--reader", type=Path, required=True, help="a Python that has pm4py and jsonschema")
    parser.add_argument("-o", "--out", type=Path, default=Path("build/ocel_evidence"))
    said = parser.parse_args(arguments)
    if not said.reader.is_file():
        print(f"{said.reader}: no Python there; make ocel-evidence sets one up", file=sys.stderr)
        return 2
    lines = list(evidence(said.out, said.reader))
    for line in lines:
        print(f"{'holds' if line.holds else 'FAILS'}  {line.file}: {line.claim}: {line.found}")
    failed = sum(not line.holds for line in lines)
    print(f"\n{len(lines) - failed} of {len(lines)} hold")
    return int(failed > 0)


def evidence(out: Path, reader: Path) -> Iterator[Line]:
    """Every claim, of the JSON and the SQLite file of each scenario."""
    from tests.opsim.export.ocel20_schema import SCHEMA

    out.mkdir(parents=True, exist_ok=True)
    schema = out / "schema.json"
    schema.write_text(json.dumps(SCHEMA, indent=1))
    made = dict(_made(out))
    read = _read(reader, schema, [file for files in made.values() for file in files])
    for name, files in made.items():
        expected = _expected(out / (SHIPPED[0] if name == HOSTILE else name))
        found = [read[str(file)] for file in files]
        for file, one in zip(files, found):
            yield from _counted(file.name, expected, one)
        same = all(found[0][key] == found[1][key] for key in ("event_types", "object_types", "qualifiers", "changes"))
        yield Line(name, "the JSON and the SQLite file say the same", "yes" if same else "no", same)


def _made(out: Path) -> Iterator[tuple[str, list[Path]]]:
    """(name, files) of a run of each scenario, of one replication."""
    from opsim.scenario import read_scenarios
    from opsim.study import run_scenario

    for name in SHIPPED:
        folder = out / name
        loaded = next(iter(read_scenarios(name).values()))
        run_scenario(loaded, folder=folder, processes=1, replications=1, overwrite=True)
        files = [out / f"{folder.name}{ending}" for ending in ENDINGS]
        for file in files:
            words = [sys.executable, "-m", "opsim", "export", str(folder), "-o", str(file)]
            subprocess.run(words, check=True, capture_output=True, text=True)
        yield folder.name, files
    yield HOSTILE, _hostile(out, out / SHIPPED[0])


def _hostile(out: Path, folder: Path) -> list[Path]:
    """The files of a run whose workers, stations, tasks and products have names that would do harm."""
    from opsim.export.ocel import object_log, write_ocel_json, write_ocel_sqlite
    from opsim.export.tables import RunClock
    from opsim.study.run import reopened
    from tests.opsim.export.hostile import hostile

    run = reopened(folder)
    log, plan = hostile(run.log(), run.plan)
    made = object_log(log, plan, RunClock(plan.start_s))
    files = [out / f"{HOSTILE}{ending}" for ending in ENDINGS]
    for write, file in zip((write_ocel_json, write_ocel_sqlite), files):
        write(made, file)
    return files


def _read(reader: Path, schema: Path, files: list[Path]) -> dict[str, dict[str, Any]]:
    words = [str(reader), str(HERE / "read_back.py"), str(schema), *map(str, files)]
    said = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    lines = [line for line in said.splitlines() if line.startswith("[{")]
    return {one["file"]: one for one in json.loads(lines[-1])}


def _expected(folder: Path) -> dict[str, Any]:
    """What the rows of the log say themselves."""
    import numpy as np

    from opsim.log import CREATE
    from opsim.log_parquet import read_events

    log = read_events(folder / "events/replication_00000.parquet")
    return {
        "events": len(log),
        "jobs": int(np.sum(log["kind"] == CREATE)),
        "workers": len(set(log["worker"].tolist()) - {-1}),
        "points": len(set(log["station"].tolist()) - {-1}),
        "hours": float(log.duration_s.sum()) / 3600,
    }


def _counted(file: str, expected: dict[str, Any], found: dict[str, Any]) -> Iterator[Line]:
    types = found["object_types"]
    jobs = sum(n for name, n in types.items() if name.startswith("job "))
    points = sum(types.get(kind, 0) for kind in ("station", "store", "conveyor"))
    rules = "the published JSON schema" if file.endswith("ocel") else "the 24 rules of the relational schema"
    yield Line(file, f"obeys {rules}", "; ".join(found["complaints"]) or "no complaint", not found["complaints"])
    for claim, want, got in (
        ("an event for each row", expected["events"], found["events"]),
        ("an object for each job", expected["jobs"], jobs),
        ("for each worker", expected["workers"], types.get("worker", 0)),
        ("for each point of the flow", expected["points"], points),
    ):
        yield Line(file, claim, f"{got:,} of {want:,}", got == want)
    hours = abs(found["hours"] - expected["hours"]) < 1e-6 * max(expected["hours"], 1.0)
    yield Line(file, "hours of all rows", f"{found['hours']:.4f} of {expected['hours']:.4f}", hours)
    arcs = ", ".join(f"{kind} {n}" for kind, n in sorted(found["arcs"].items()))
    rest = (
        f"{found['relations']:,} relations, {found['between_objects']} between objects, {found['changes']:,} changes, "
        f"read in {found['read_s']:.1f} s; arcs of each type: {arcs}"
    )
    yield Line(file, "an object-centric graph is discovered", rest, jobs == 0 or bool(found["arcs"]))


if __name__ == "__main__":
    sys.exit(main())
