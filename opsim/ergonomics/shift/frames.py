"""Every posture of a shift in time order, and what is folded over them.

Frames: what one worker's body did in a stretch of his shift, posture by posture.

Parts: the frames of some pieces of one worker's time, before they are put in the order of time.

Somebody who stands upright with hanging arms: what waiting is taken for, where the scenario says so.

What a modeller says of tasks beside their time, checked and in the program's own words.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from opsim.ergonomics.angles import ANGLES, AT, COLUMNS
from opsim.ergonomics.redraw import Pieces
from opsim.ergonomics.trunk import spread
from opsim.log import EventLog
from opsim.problems import did_you_mean, shown
from opsim.subjects.exposure.plan import FORCES, FOREARMS, GRIPS, LEGS, NOT_SAID, Handling
from opsim.subjects.tools.plan import Moment, moment_of

WALKING, WAITING = -1, -2
"""In place of a task: nobody performs one."""


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """N frames of one worker in the order of time; each array (N,) but measures.

    worker   : rank; all frames are his
    start_s, seconds : when on the clock of the run, and for how long; no frame crosses an hour of the clock
    station, task, product : ranks; -1 where there is none, and WALKING or WAITING in place of a task
    row      : of the log; k : which performance of the task (or walk) of this worker
    progress : the middle of the frame in its performance, 0 to 1
    carrying : whether the hands hold what ``TaskPlan.handling`` tells of (where no load is said: whether they may)
    repeated : whether the same task is begun again and again; static : whether the posture is held
    measures : (N, COLUMNS) by ``columns.py``; all nan where no posture is known, then a frame is a whole piece of work
    """

    worker: int
    start_s: np.ndarray
    seconds: np.ndarray
    station: np.ndarray
    task: np.ndarray
    product: np.ndarray
    row: np.ndarray
    k: np.ndarray
    progress: np.ndarray
    carrying: np.ndarray
    repeated: np.ndarray
    static: np.ndarray
    measures: np.ndarray

    def __len__(self) -> int:
        return self.seconds.size

    @property
    def end_s(self) -> np.ndarray:
        """(N,) when each is over."""
        return self.start_s + self.seconds

    @property
    def known(self) -> np.ndarray:
        """(N,) whether anything is known of the posture."""
        return ~np.isnan(self.measures).all(axis=1)

    def some(self, rows: np.ndarray | slice) -> Frames:
        """A few of them."""
        columns = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "worker"}
        return Frames(self.worker, **{name: column[rows] for name, column in columns.items()})


class Spans(NamedTuple):
    """Pieces of one worker's time in the order of time, (P,) each: their rows of the log, what they are of, since when.

    pieces : ``task`` is WALKING or WAITING where it is no task
    """

    row: np.ndarray
    start_s: np.ndarray
    pieces: Pieces

    def some(self, rows: np.ndarray | slice) -> Spans:
        """A few of them."""
        return Spans(self.row[rows], self.start_s[rows], self.pieces.some(rows))


class Parts(NamedTuple):
    """Frames (N,) of some spans: of which, since when, for how long, where in the performance, with what postures."""

    span: np.ndarray
    start_s: np.ndarray
    seconds: np.ndarray
    progress: np.ndarray
    carrying: np.ndarray
    measures: np.ndarray


def looked_at(
    spans: Spans, which: np.ndarray, measures: np.ndarray, place: np.ndarray, carried: tuple[np.ndarray, np.ndarray]
) -> Parts:
    """Some spans ``which`` (Q,), cut where their postures change.

    measures : (m, C, COLUMNS) of performances in C even parts; place : (Q,) which of them each span is of
    carried  : (m,) and (m,) from and to which progress the hands are full
    The seconds of a span's frames sum to its own; one without progress is not measured.
    """
    n_cells, pieces = measures.shape[1], spans.pieces.some(which)
    seconds, _ = spread(pieces, n_cells)
    before_s = np.cumsum(seconds, axis=1) - seconds
    span, cell = np.nonzero(seconds > 0)
    progress = (cell + 0.5) / n_cells
    begin, end = (edge[place[span]] for edge in carried)
    parts = Parts(
        which[span],
        spans.start_s[which[span]] + before_s[span, cell],
        seconds[span, cell],
        progress,
        (progress >= begin) & (progress < end),
        measures[place[span], cell],
    )
    nowhere = which[seconds.sum(axis=1) <= 0]
    return joined([parts, not_looked_at(spans, nowhere)]) if nowhere.size else parts


def not_looked_at(spans: Spans, which: np.ndarray, carrying: np.ndarray | bool = True) -> Parts:
    """Some spans whose postures nobody knows, a frame each; carrying : (Q,) or one, whether hands may be full."""
    unknown = np.full((which.size, len(COLUMNS)), np.nan, np.float32)
    return whole(spans, which, unknown, carrying)


def not_seen(spans: Spans, which: np.ndarray, full: tuple[float, float]) -> Parts:
    """Some spans whose postures nobody knows, cut where hands are full, from and to one share of each performance."""
    first, last = spans.pieces.progress_from[which], spans.pieces.progress_to[which]
    edges = np.clip(np.array([-np.inf, *full, np.inf])[:, None], first, last)
    length = last - first
    share = np.diff(edges, axis=0) / np.where(length > 0, length, 1.0)
    share[:, ~(length > 0)] = [[0.0], [1.0], [0.0]]
    seconds = share * spans.pieces.seconds[which]
    begins_s = spans.start_s[which] + np.cumsum(seconds, axis=0) - seconds
    middle, phase, at = (edges[:-1] + edges[1:]) / 2, *np.nonzero(seconds > 0)
    unknown = np.full((at.size, len(COLUMNS)), np.nan, np.float32)
    return Parts(which[at], begins_s[phase, at], seconds[phase, at], middle[phase, at], phase == 1, unknown)


def whole(spans: Spans, which: np.ndarray, measures: np.ndarray, carrying: np.ndarray | bool) -> Parts:
    """Some spans as a frame each, with measures (Q, COLUMNS)."""
    pieces = spans.pieces.some(which)
    middle = (pieces.progress_from + pieces.progress_to) / 2
    return Parts(which, spans.start_s[which], pieces.seconds, middle, np.broadcast_to(carrying, which.shape), measures)


def joined(parts: Sequence[Parts]) -> Parts:
    """All frames of some parts of one stretch, one part after the other."""
    return Parts(*(np.concatenate(columns) for columns in zip(*parts)))


def assembled(log: EventLog, rank: int, found: Sequence[tuple[Spans, Parts]], repeated: np.ndarray) -> Frames | None:
    """The frames of one worker's stretch in the order of time, ``static`` nowhere; None where there is none.

    repeated : (rows,) of the log
    """
    if not sum(parts.seconds.size for _, parts in found):
        return None
    row, task, k = (
        np.concatenate([column(spans)[parts.span] for spans, parts in found])
        for column in (lambda spans: spans.row, lambda spans: spans.pieces.task, lambda spans: spans.pieces.k)
    )
    parts = joined([parts for _, parts in found])
    order = np.argsort(parts.start_s, kind="stable")
    row = row[order]
    return Frames(
        worker=rank,
        start_s=parts.start_s[order],
        seconds=parts.seconds[order],
        station=log["station"][row],
        task=task[order].astype(np.int32),
        product=log["product"][row],
        row=row,
        k=k[order],
        progress=parts.progress[order].astype(np.float32),
        carrying=parts.carrying[order],
        repeated=repeated[row],
        static=np.zeros(row.size, bool),
        measures=parts.measures[order],
    )


_LENGTHS_M = {
    "elbow_above_m": -0.30,
    "across_m": -0.20,
    "outside_m": 0.0,
    "hand_up_m": 0.75,
    "ankle_up_m": 0.05,
}
"""Of each side, of somebody 1.75 m tall; source: design. No score changes within a hand's breadth of them."""


def _standing() -> np.ndarray:
    found = np.full(len(COLUMNS), np.nan, np.float32)
    found[: len(ANGLES)] = 0.0
    for name, length_m in _LENGTHS_M.items():
        found[[AT[f"left_{name}"], AT[f"right_{name}"]]] = length_m
    found[[AT["hands_forward_m"], AT["hands_left_m"]]] = 0.0
    found[AT["pelvis_up_m"]] = 0.95
    return found


STANDING = _standing()
"""(COLUMNS,) measures; every angle is 0."""


WORDS = {"grip": GRIPS, "force": FORCES, "forearm": FOREARMS, "legs": LEGS}
FLAGS = ("arms_supported", "sitting", "rapid")


def handlings(said: Any, models: Mapping[str, Any], whose: str = "") -> dict[str, Handling]:
    """By task: a ``Handling``, from one or from its words (``{"load_kg": 8, "grip": "fair", "start": "grasp"}``).

    ``start`` and ``end`` may be names of marks, or shares of a performance.
    Raises one ValueError that lists all mistakes, a line each; TypeError where it is no mapping.
    """
    if said is None:
        return {}
    if not isinstance(said, Mapping):
        raise TypeError(f"{whose}handling: expected a mapping of tasks to Handling, found {shown(said)}")
    mistakes: list[str] = []
    found = {task: _handling(task, one, models, mistakes) for task, one in said.items()}
    if mistakes:
        raise ValueError("\n".join(whose + mistake for mistake in mistakes))
    return found


def _handling(task: Any, one: Any, models: Mapping[str, Any], mistakes: list[str]) -> Handling:
    where = f"handling of {task}"
    if task not in models:
        mistakes.append(f"handling: no task {shown(task)}; {did_you_mean(task, models)}")
        return NOT_SAID
    if not isinstance(one, Mapping | Handling):
        mistakes.append(f"{where}: expected a Handling or its words, found {shown(one)}")
        return NOT_SAID
    known = [field.name for field in fields(Handling)]
    given = dict(one) if isinstance(one, Mapping) else {name: getattr(one, name) for name in known}
    words = {word: value for word, value in given.items() if value is not None}
    wrong = [f"{where}: no {shown(word)}; {did_you_mean(word, known)}" for word in words if word not in known]
    wrong += [f"{where}: {name}: {problem}" for name in known if (problem := _problem(name, words.get(name)))]
    if wrong:
        mistakes.extend(wrong)
        return NOT_SAID
    names = tuple(getattr(models[task], "mark_names", ()))
    try:
        moments = {name: _moment(words[name], names) for name in ("start", "end") if name in words}
    except ValueError as error:
        mistakes.append(f"{where}: {error}")
        return NOT_SAID
    return replace(NOT_SAID, **{**words, **moments})


def _problem(name: str, value: Any) -> str:
    """What is wrong with one word; nothing where nothing is."""
    if value is None:
        return ""
    if name in WORDS and value not in WORDS[name]:
        return f"no {shown(value)}; {did_you_mean(value, WORDS[name])}"
    if name in FLAGS and not isinstance(value, bool):
        return f"found {shown(value)}, expected True or False"
    if name == "load_kg" and not (_number(value) and isfinite(value) and value >= 0):
        return f"found {shown(value)}, expected kilograms from 0"
    if name in ("start", "end") and not isinstance(value, Moment | str) and not (_number(value) and 0 <= value <= 1):
        return f"found {shown(value)}, expected the name of a mark, or a share from 0 to 1"
    return ""


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _moment(said: Any, names: tuple[str, ...]) -> Moment:
    return said if isinstance(said, Moment) else moment_of(said if isinstance(said, str) else float(said), names)
