"""What bodies went through as a small table, for a terminal and for a notebook: minutes, by worker and task."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from math import isnan
from typing import Any

import numpy as np

from opsim.ergonomics.shift.ledger import AT_MOST, KEY, Ledger
from opsim.ergonomics.shift.stretch import WAITING
from opsim.kpi.levels import bounds_of_level, mean_score, minutes

TITLES = {
    "rula_from_5": "RULA 5+",
    "rula_from_7": "RULA 7",
    "reba_from_8": "REBA 8+",
    "owas_from_3": "OWAS 3+",
    "trunk_beyond_20": "trunk>20",
    "trunk_beyond_60": "trunk>60",
    "arm_beyond_60": "arm>60",
    "arm_beyond_90": "arm>90",
}
HEAD = ("worker", "task", "minutes", "unknown", *TITLES.values(), "RULA mean")
FOOT = "minutes; a-b: at least and at most, as grip, support and the like were not said for all tasks"


def as_text(found: Any) -> str:
    """A line each: every worker at every task, and all of it."""
    rows = [HEAD, *_rows(found)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEAD))]
    lines = ["  ".join(_put(cell, width, at) for at, (cell, width) in enumerate(zip(row, widths))) for row in rows]
    return "\n".join([*(line.rstrip() for line in lines), *_foot(rows)])


def as_html(found: Any) -> str:
    """The same as a table of a notebook."""
    head, *rows = (HEAD, *_rows(found))
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    foot = "".join(f"<p>{escape(line)}</p>" for line in _foot(rows))
    return f"<table><tr>{''.join(f'<th>{escape(cell)}</th>' for cell in head)}</tr>{body}</table>{foot}"


def _rows(found: Any) -> Iterator[tuple[str, ...]]:
    ledger, tasks = found.ledger, {rank: task.name for rank, task in enumerate(found.plan.tasks)}
    tasks[WAITING] = "waiting"
    for rank, worker in enumerate(found.plan.workers):
        own = ledger.where(ledger.key[:, KEY.index("worker")] == rank)
        for task in np.unique(own.key[:, KEY.index("task")]).tolist():
            yield worker.name, tasks[task], *_cells(own.where(own.key[:, KEY.index("task")] == task))
    yield "all", "", *_cells(ledger)


def _cells(ledger: Ledger) -> Iterator[str]:
    one = ledger.together()
    yield f"{one.seconds[0] / 60:.1f}"
    yield f"{one.unmeasured_s[0] / 60:.1f}"
    for level in TITLES:
        yield _span(*(float(minutes(one, level, bound)[0]) for bound in bounds_of_level(level)))
    yield _span(*(float(mean_score(one, f"rula{bound}")[0]) for bound in ("", AT_MOST)))


def _span(low: float, high: float | None = None) -> str:
    if isnan(low):
        return "?"
    least, most = f"{low:.1f}", f"{low if high is None else high:.1f}"
    return least if least == most else f"{least}-{most}"


def _put(cell: str, width: int, at: int) -> str:
    return cell.ljust(width) if at < 2 else cell.rjust(width)


def _foot(rows: list[tuple[str, ...]]) -> list[str]:
    return [FOOT] if any("-" in cell for row in rows for cell in row[2:]) else []
