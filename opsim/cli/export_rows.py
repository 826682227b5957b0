"""Event rows or figures of all that is asked for, in one file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from opsim.cli.export_asked import Asked
from opsim.cli.export_told import Told, size


def export_rows(asked: Asked) -> Told:
    """Write them as they lie in the results; DuckDB streams them from file to file."""
    from opsim.cli.console import printable
    from opsim.export.rows import write_figures, write_rows

    if asked.options["figures"]:
        n = write_figures({name: result.kpis_file for name, result in asked.variants.items()}, asked.out, asked.form)
    else:
        files = {name: _files(result, asked.replications) for name, result in asked.variants.items()}
        n = write_rows(files, asked.out, asked.form, _clocks(asked))
    what, n_bytes = "figures" if asked.options["figures"] else "rows", asked.out.stat().st_size
    line = printable(f"{asked.out}: {n:,} {what} of {', '.join(asked.variants)}, {size(n_bytes)}")
    plain = {"format": asked.form, "out": str(asked.out), "variants": list(asked.variants), what: n, "bytes": n_bytes}
    return Told((line,), plain)


def _files(result: Any, replications: tuple[int, ...]) -> list[Path]:
    return [result.events_files[n] for n in replications] if replications else result.events_files


def _clocks(asked: Asked) -> dict[str, Any] | None:
    """Of each variant, where a date is given: the times of the calendar stand in the rows too."""
    from opsim.export.run_clock import RunClock, monday_of
    from opsim.export.when import start_of

    if asked.options["date"] is None:
        return None
    monday = monday_of(asked.options["date"])
    return {name: RunClock(start_of(result.summary["start"]), monday) for name, result in asked.variants.items()}
