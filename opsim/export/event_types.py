"""What the kinds of rows are called as events, and which attributes each has."""

from __future__ import annotations

import numpy as np

from opsim import log as kinds
from opsim.export.object_log import FLOAT, INTEGER, STRING, TIME
from opsim.log import KINDS, EventLog

WORDS = {
    kinds.OFF: "off duty",
    kinds.SETUP: "set up",
    kinds.TOOL: "hold tool",
    kinds.SENT_ON: "send on",
    kinds.STANDS: "line stands",
}
"""Kinds whose event is not called as they are."""
CLOSED, DRIVE = "closed", "drive"
"""A station that is off; a vehicle that goes, is loaded or unloaded."""

_LASTS = (("end", TIME), ("duration_s", FLOAT))
FOR = ("for", STRING)
"""The id of the job that somebody walks to, or waits at."""
_WHY = (*_LASTS, ("reason", STRING))
_WAY = (("from", STRING), ("to", STRING))
_DONE = (
    *_LASTS,
    *(("operation", STRING), ("task", STRING), ("performance", INTEGER), ("k", INTEGER)),
    *(("progress_from", FLOAT), ("progress_to", FLOAT), ("pace_shift", FLOAT)),
)
_STOP = (*_WHY, ("task", STRING), ("occurrence", INTEGER))
_PLAIN = (("operation", STRING), ("reason", STRING))
ATTRIBUTES: dict[int, tuple[tuple[str, str], ...]] = {
    **dict.fromkeys((kinds.WORK, kinds.SETUP), _DONE),
    kinds.WALK: (*_LASTS, *_WAY, FOR),
    kinds.TRANSPORT: (*_WHY, *_WAY),
    kinds.WAIT: (*_WHY, ("place", STRING), FOR),
    **dict.fromkeys((kinds.BREAK, kinds.OFF, kinds.ABSENT), (*_WHY, ("place", STRING))),
    **dict.fromkeys((kinds.QUEUE, kinds.HELD, kinds.BLOCKED), (*_WHY, ("operation", STRING), ("task", STRING))),
    **dict.fromkeys((kinds.DOWN, kinds.REPAIR), _STOP),
    kinds.STANDS: _WHY,
    kinds.TOOL: (*_LASTS, ("operation", STRING), ("task", STRING)),
}
"""By kind, what an event of it may have; those of an instant have ``_PLAIN``."""


def attributes_of(kind: int) -> tuple[tuple[str, str], ...]:
    """(name, type) of what an event of a kind may have."""
    return ATTRIBUTES.get(kind, _PLAIN)


def type_names(log: EventLog, by_task: bool = False) -> list[str]:
    """(rows,) what each row's event is called. by_task : work and set-up are told apart by their task."""
    words = [WORDS.get(kind, name) for kind, name in enumerate(KINDS)]
    alone = (log["worker"] < 0) & (log["job"] < 0)
    names = [words[kind] for kind in log["kind"].tolist()]
    for kind, word in ((kinds.OFF, CLOSED), (kinds.TRANSPORT, DRIVE)):
        for row in np.flatnonzero(alone & (log["kind"] == kind)).tolist():
            names[row] = word
    if by_task:
        tasks = log.names["task"]
        for row in np.flatnonzero(np.isin(log["kind"], (kinds.WORK, kinds.SETUP)) & (log["task"] >= 0)).tolist():
            names[row] = f"{names[row]}: {tasks[log['task'][row]]}"
    return names
