"""EventLog: one row for each thing that happened. Figures are pure functions of rows; nothing else keeps count."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import nan
from struct import Struct
from typing import Any

import numpy as np

KINDS = (
    *("work", "walk", "wait", "break", "off", "absent", "blocked", "starved", "queue", "held", "setup", "down"),
    *("repair", "transport", "create", "join", "split", "finish", "scrap", "lost", "rework", "tool"),
    *("sent_on", "stands"),
)
WORK, WALK, WAIT, BREAK, OFF, ABSENT, BLOCKED, _STARVED, QUEUE, HELD, SETUP, DOWN = range(12)
REPAIR, TRANSPORT, CREATE, JOIN, SPLIT, FINISH, SCRAP, LOST, REWORK, TOOL, SENT_ON, STANDS = range(12, 24)
WORKER_KINDS = (WORK, WALK, WAIT, BREAK, OFF, ABSENT, SETUP, REPAIR)
"""Kinds that are states of a worker, where the row names one."""
JOB_KINDS = (QUEUE, WORK, SETUP, TRANSPORT, BLOCKED, HELD)
"""Kinds that are states of a job, where the row names one."""
STATION_KINDS = (DOWN, REPAIR, OFF)
"""Kinds that are states of a station, in rows that name neither worker nor job. STANDS is that of a paced line, in a
row of its first station; SENT_ON an instant: a job left a station of such a line unfinished."""
LEAVING_KINDS = (FINISH, SCRAP, JOIN, SPLIT, LOST)
"""Kinds by which a job leaves the floor, each an instant."""

CAUSES = (
    *("", "idle", "blocked", "gate", "worker", "full", "down", "parts", "tool", "team", "card", "batch", "after"),
    *("stock", "pickup", "setup", "preempted", "place", "breakdown", "maintenance", "bad"),
    *("false_alarm", "away", "closed", "meeting", "takt", "line_stop", "unfinished", "behind"),
    "rest",
)
NO_CAUSE, IDLE, JOB_BLOCKED, GATE, NO_WORKER, FULL, IS_DOWN, NO_PARTS, NO_TOOL, TEAM, NO_CARD, BATCH, AFTER = range(13)
STOCK, PICKUP, SETTING_UP, PREEMPTED, NO_PLACE, BREAKDOWN, MAINTENANCE, BAD, FALSE_ALARM = range(13, 22)
AWAY, CLOSED, MEETING, TAKT, LINE_STOP, UNFINISHED, BEHIND, REST = range(22, 30)

COLUMNS: dict[str, type] = {
    "kind": np.int8,
    "start_s": np.float64,
    "end_s": np.float64,
    "worker": np.int32,
    "station": np.int32,
    "place_from": np.int32,
    "place_to": np.int32,
    "source": np.int32,
    "job": np.int64,
    "product": np.int32,
    "operation": np.int32,
    "task": np.int32,
    "performance_id": np.int64,
    "k": np.int64,
    "progress_from": np.float64,
    "progress_to": np.float64,
    "pace_shift": np.float64,
    "cause": np.int8,
}
ORDER = ("end_s", "start_s", "kind", "worker", "station", "source", "job", "k")
NAMED = ("kind", "worker", "station", "place_from", "place_to", "source", "product", "operation", "task", "cause")
"""Columns that hold the number of a name; -1 where the row has none."""


@dataclass(frozen=True)
class EventLog:
    """Rows of one replication, sorted by ``ORDER``.

    columns : a column each, all of one length; names as numbers, -1 for none; NaN progress where nothing was performed
    names   : for each column of ``NAMED``, the names that its numbers stand for
    """

    replication: int
    horizon_s: float
    columns: dict[str, np.ndarray]
    names: dict[str, tuple[str, ...]]

    def __len__(self) -> int:
        return self.columns["kind"].size

    def __getitem__(self, column: str) -> np.ndarray:
        return self.columns[column]

    def where(self, mask: np.ndarray) -> "EventLog":
        """The rows of a mask or an index, in their order."""
        return EventLog(
            self.replication, self.horizon_s, {name: column[mask] for name, column in self.columns.items()}, self.names
        )

    def of(self, *kinds: int) -> "EventLog":
        """The rows of some kinds."""
        return self.where(np.isin(self["kind"], kinds))

    @cached_property
    def duration_s(self) -> np.ndarray:
        """(rows,) seconds from start to end."""
        return self["end_s"] - self["start_s"]

    def clipped_s(self, from_s: float, to_s: float) -> np.ndarray:
        """(rows,) seconds of each row that lie between two times."""
        return np.maximum(np.minimum(self["end_s"], to_s) - np.maximum(self["start_s"], from_s), 0.0)

    def to_frame(self) -> Any:
        """A pandas DataFrame, a row each, names as text. Raises ImportError where pandas is absent."""
        from opsim.results import log_frame

        return log_frame(self)

    def _repr_html_(self) -> str:
        from opsim.notebook import log_html

        return log_html(self)


def row(
    kind: int,
    start_s: float,
    end_s: float,
    worker: int = -1,
    station: int = -1,
    place_from: int = -1,
    place_to: int = -1,
    source: int = -1,
    job: int = -1,
    product: int = -1,
    operation: int = -1,
    task: int = -1,
    performance_id: int = -1,
    k: int = -1,
    progress_from: float = nan,
    progress_to: float = nan,
    pace_shift: float = nan,
    cause: int = 0,
) -> tuple:
    """One row, in the order of ``COLUMNS``."""
    return (
        *(kind, start_s, end_s, worker, station, place_from, place_to, source, job, product, operation, task),
        *(performance_id, k, progress_from, progress_to, pace_shift, cause),
    )


_FORMAT: dict[type, str] = {np.int8: "b", np.int32: "i", np.int64: "q", np.float64: "d"}
pack_row = Struct("<" + "".join(_FORMAT[dtype] for dtype in COLUMNS.values())).pack
"""A row as bytes. NOTE: four times as fast as keeping tuples, and a row is 98 bytes instead of some 600."""
_ROW = np.dtype([(name, np.dtype(dtype).newbyteorder("<")) for name, dtype in COLUMNS.items()])


class LogWriter:
    """Takes rows in the order of ``COLUMNS``: as tuples by ``append``, or ready packed by ``rows.extend``."""

    __slots__ = ("rows",)

    def __init__(self) -> None:
        self.rows = bytearray()

    def append(self, row: tuple) -> None:
        self.rows.extend(pack_row(*row))

    def close(self, replication: int, horizon_s: float, names: dict[str, tuple[str, ...]]) -> EventLog:
        """The finished log, rows in their one order."""
        packed = np.frombuffer(self.rows, _ROW)
        columns: dict[str, np.ndarray] = {name: packed[name].astype(dtype) for name, dtype in COLUMNS.items()}
        order = np.lexsort([columns[name] for name in reversed(ORDER)])
        return EventLog(replication, horizon_s, {name: column[order] for name, column in columns.items()}, names)


def event_log(
    rows: Iterable[tuple], horizon_s: float, names: dict[str, tuple[str, ...]], replication: int = 0
) -> EventLog:
    """A log of rows given as tuples in the order of ``COLUMNS``."""
    writer = LogWriter()
    for row in rows:
        writer.append(row)
    return writer.close(replication, horizon_s, names)


def names_of(plan) -> dict[str, tuple[str, ...]]:
    """For each column of ``NAMED`` the names of a Plan, each at its natural rank."""
    places = plan.places
    return {
        "kind": KINDS,
        "worker": tuple(worker.name for worker in plan.workers),
        "station": tuple(station.name for station in plan.stations),
        "place_from": places,
        "place_to": places,
        "source": tuple(source.name for source in plan.sources),
        "product": tuple(product.name for product in plan.products),
        "operation": plan.operations,
        "task": tuple(task.name for task in plan.tasks),
        "cause": CAUSES,
    }
