"""Tables as data frames of pandas, which is needed for nothing else and imported when it is asked for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from opsim.log import COLUMNS, NAMED, NO_CAUSE, EventLog

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
