"""Rows as the engine writes them -> columns of an EventLog, in their one order."""

from __future__ import annotations

import numpy as np

from opsim.engine.fast_engine.machine.layouts import LAYOUTS
from opsim.log import COLUMNS, ORDER


def columns_of(chunks: list[np.ndarray], n_rows: int) -> dict[str, np.ndarray]:
    """The columns of all rows in the order of ``ORDER``; rows alike in these stay as they were written.

    chunks : of bytes, full of rows but for the last
    """
    fields = LAYOUTS["Row"].fields
    dtype = np.dtype([(name, np.float64 if fields[name].kind == "float" else np.int64) for name in COLUMNS])
    rows = np.concatenate([chunk.view(dtype) for chunk in chunks]) if chunks else np.empty(0, dtype)
    rows = rows[:n_rows]
    columns = {name: rows[name].astype(kind) for name, kind in COLUMNS.items()}
    order = np.lexsort([columns[name] for name in reversed(ORDER)])
    return {name: column[order] for name, column in columns.items()}
