"""OCEL 2.0 files, one for each replication of each variant that is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from opsim.cli.export_asked import OCEL_JSON, Asked
from opsim.cli.export_told import Told, size


def export_ocel(asked: Asked) -> Told:
    """Write them, one after the other: no more than one replication is in the memory."""
    from opsim.cli.console import printable
    from opsim.cli.progress import progress
    from opsim.study.reopened import reopened

    written: list[dict[str, Any]] = []
    total = len(asked.variants) * len(asked.replications)
    with progress("export") as report:
        for variant, result in asked.variants.items():
            run = reopened(result.folder)
            for replication in asked.replications:
                if total > 1:
                    report(len(written), total, variant)
                path = _path(asked, variant, replication)
                made = _write(asked, run, replication, path)
                written.append({"variant": variant, "replication": replication, **made})
        if total > 1:
            report(total, total)
    lines = [
        printable(f"{one['out']}: {one['events']:,} events, {one['objects']:,} objects, {size(one['bytes'])}")
        for one in written
    ]
    return Told(tuple(lines), {"format": asked.form, "files": written})


def _path(asked: Asked, variant: str, replication: int) -> Path:
    from opsim.export.places import out_for

    several = len(asked.replications) > 1
    return out_for(
        asked.out,
        variant=variant if len(asked.variants) > 1 else "",
        replication=replication if several else None,
    )


def _write(asked: Asked, run: Any, replication: int, path: Path) -> dict[str, Any]:
    from opsim.export.ocel import object_log
    from opsim.export.ocel_json import write_ocel_json
    from opsim.export.ocel_sqlite import write_ocel_sqlite
    from opsim.export.run_clock import MONDAY, RunClock, monday_of

    date = asked.options["date"]
    clock = RunClock(run.plan.start_s, MONDAY if date is None else monday_of(date))
    log = run.log(replication)
    made = object_log(log, run.plan, clock, by_task=asked.options["by_task"])
    (write_ocel_json if asked.form == OCEL_JSON else write_ocel_sqlite)(made, path)
    return {"out": str(path), "events": len(log), "objects": made.n_things, "bytes": path.stat().st_size}
