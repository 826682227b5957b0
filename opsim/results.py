"""A results folder as one frozen thing.

Tables as data frames of pandas, which is needed for nothing else and imported when it is asked for.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from opsim.log import COLUMNS, NAMED, NO_CAUSE, EventLog

Key = tuple[str, str, str, str]
"""(kpi, subject, part, unit)"""
Table = dict[Key, dict[int, float]]
"""By figure, its value in each replication."""
STUDY = "study.json"
"""What the folder of a study has, and that of a run has not."""
AT_ONCE = 200
"""Files read by one query."""


@dataclass(frozen=True)
class Result:
    """What a run left: ``summary`` is the content of summary.json; the rows are in ``events/``."""

    folder: Path
    summary: dict

    @classmethod
    def load(cls, folder: Path) -> Result:
        """Read a results folder. Raises OSError or ValueError where it is none."""
        summary = read_object(folder / "summary.json", "the summary of a run")
        if "study" in summary:
            raise ValueError(_not_a_run(folder, summary["study"]))
        if not {"seed", "kpis", "replications"} <= summary.keys():
            raise ValueError(f"{folder / 'summary.json'}: not the summary of a run")
        return cls(folder, summary)

    @property
    def events_files(self) -> list[Path]:
        """Parquet files of the rows, a replication each."""
        return events_in(self.folder)[: self.summary["replications"]]

    def kpis(self) -> Table:
        """Every figure by replication; nan where nothing was observed. Raises OSError where it cannot be read."""
        from opsim.log_parquet import connect, plain_errors

        with plain_errors(self.kpis_file), connect() as connection:
            return _tables(connection, [self.kpis_file])[0]

    def to_frame(self) -> Any:
        """``kpis`` as a pandas DataFrame, a row for each figure of each replication. Raises ImportError, OSError."""

        return kpi_frame(self.kpis())

    def _repr_html_(self) -> str:
        from opsim.notebook import result_html

        return result_html(self)

    @property
    def kpis_file(self) -> Path:
        """Every figure of every replication."""
        return self.folder / "kpis.parquet"


def figures_of(results: Sequence[Result], names: Collection[str]) -> list[Table]:
    """As ``kpis`` of many results at once, those figures alone: a connection for each would take most of the time.

    Raises OSError where one cannot be read.
    """
    import duckdb

    from opsim.log_parquet import connect

    found: list[Table] = []
    with connect() as connection:
        for first in range(0, len(results), AT_ONCE):
            some = results[first : first + AT_ONCE]
            try:
                found += _tables(connection, [one.kpis_file for one in some], names)
            except (duckdb.Error, KeyError):  # one by one: it is said which cannot be read, and names may hold a '*'
                found += [{key: row for key, row in one.kpis().items() if key[0] in names} for one in some]
    return found


def _tables(connection: Any, files: Sequence[Path], names: Collection[str] | None = None) -> list[Table]:
    """The figures in each file, in the order of the replications; names : those alone."""
    from opsim.log_parquet import quoted

    listed = ", ".join(quoted(str(path)) for path in files)
    only = "" if names is None else f"WHERE kpi IN ({', '.join(quoted(name) for name in names)})"
    rows = connection.execute(
        "SELECT kpi, subject, part, unit, filename, replication, coalesce(value, 'nan'::DOUBLE) "
        f"FROM read_parquet([{listed}], filename = true) {only} ORDER BY replication"
    ).fetchall()
    found: dict[str, Table] = {str(path): {} for path in files}
    alone = found[str(files[0])] if len(files) == 1 else None
    for kpi, subject, part, unit, path, replication, value in rows:
        table = found[path] if alone is None else alone
        table.setdefault((kpi, subject, part, unit), {})[replication] = value
    return [found[str(path)] for path in files]


def events_in(folder: Path) -> list[Path]:
    """Events files of a results folder, by their replications; nothing where there are none."""
    return sorted((folder / "events").glob("replication_*.parquet"), key=lambda path: (len(path.name), path.name))


def lacking_rows(result: Result) -> str:
    """What to say of replications whose rows are gone; "" where all are there."""
    there, n = {path.name for path in events_in(result.folder)}, result.summary["replications"]
    gone = [number for number in range(n) if events_name(number) not in there]
    if not gone:
        return ""
    if len(gone) == n:
        return f"{result.folder}: no rows of events here, expected events/{events_name(0)}; run it again"
    some = ", ".join(map(str, gone[:5])) + (", ..." if len(gone) > 5 else "")
    return f"{result.folder / 'events'}: found no rows of replication {some}, expected 0 to {n - 1}; run it again"


def events_name(replication: int) -> str:
    """The name of a replication's file in the folder events."""
    return f"replication_{replication:05d}.parquet"


def read_object(path: Path, what: str) -> dict[str, Any]:
    """A JSON object from a file. Raises OSError, and ValueError with the file's name where it holds none."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:  # of the text's encoding, too
        raise ValueError(f"{path}: found no JSON ({error}), expected {what}") from None
    if not isinstance(found, dict):
        raise ValueError(f"{path}: not {what}")
    return found


def variants_in(folder: Path) -> dict[str, Result]:
    """The results of each variant of a run by name; the folder may also be that of one variant.

    Raises ValueError where it holds no results, OSError where they cannot be read.
    """
    if (folder / "summary.json").is_file():
        return {folder.name: Result.load(folder)}
    found = {path.parent.name: Result.load(path.parent) for path in sorted(folder.glob("*/summary.json"))}
    if not found and (folder / STUDY).is_file():
        raise ValueError(_not_a_run(folder, None))
    if not found:
        raise ValueError(f"{folder}: no results here; 'opsim run FILE.yaml -o {folder}' makes some")
    return found


def _not_a_run(folder: Path, kind: object) -> str:
    """What to say of the folder of a study; kind : of a finished one, None before."""
    said = f"of 'opsim {kind}'" if isinstance(kind, str) and kind.replace("_", "").isalnum() else "of a study"
    page = folder / f"{kind}.html"
    see = f": its answer is in {page}" if page.is_file() else ""
    return f"{folder}: a folder {said}, which keeps figures and no runs{see}; 'opsim run FILE.yaml' keeps runs"


HOW = "to_frame() needs pandas, which is not installed; 'pip install opsim[frames]' gets it"
_NUMBERED = ("job", "performance_id", "k")


def frame(columns: Mapping[str, Any]) -> Any:
    """A pandas DataFrame of columns by name. Raises ImportError that says what to install, where pandas is absent."""
    try:
        from pandas import DataFrame
    except ImportError:
        raise ImportError(HOW) from None
    return DataFrame(dict(columns))


def frame_of_rows(names: Sequence[str], rows: Iterable[Sequence[Any]]) -> Any:
    """A DataFrame of rows whose columns have these names; of no rows too."""
    listed = list(rows)
    return frame({name: [row[at] for row in listed] for at, name in enumerate(names)})


def log_frame(log: EventLog) -> Any:
    """A row each, names as categories; what a row does not have is missing, also a job's number (Int64)."""
    made = frame({"replication": np.full(len(log), log.replication, np.int32)})
    for name in COLUMNS:
        made[name] = _column(log, name)
    return made


def kpi_frame(table: Mapping[tuple[str, str, str, str], Mapping[int, float]]) -> Any:
    """Figures of a ``Result``: a row for each of each replication, as the file has them."""
    names = ("replication", "kpi", "subject", "part", "unit", "value")
    rows = [(replication, *key, value) for key, values in table.items() for replication, value in values.items()]
    return frame_of_rows(names, sorted(rows, key=lambda row: row[0]))


def _column(log: EventLog, name: str) -> Any:
    from pandas import Categorical, arrays

    if name in NAMED:
        none = (log[name] < 0) | ((name == "cause") & (log[name] == NO_CAUSE))
        return Categorical.from_codes(np.where(none, -1, log[name]), log.names[name])
    if name in _NUMBERED:
        return arrays.IntegerArray(log[name], log[name] < 0)
    return log[name]
