"""Parts: the frames of some pieces of one worker's time, before they are put in the order of time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from opsim.ergonomics.columns import COLUMNS
from opsim.ergonomics.exposure import spread
from opsim.ergonomics.pieces import Pieces
from opsim.ergonomics.shift.stretch import Frames
from opsim.log import EventLog


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
