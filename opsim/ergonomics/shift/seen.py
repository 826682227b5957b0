"""The postures of one worker's performances, each looked at once: what comes again later is kept until then."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from opsim.ergonomics.exposure import named_by
from opsim.ergonomics.measures import has_body, measures_of
from opsim.ergonomics.pieces import Lucks, Pieces, drawn_again
from opsim.ergonomics.shift.parts import Parts, Spans, looked_at, not_looked_at, not_seen
from opsim.plan import Plan
from opsim.plan.handling import Handling
from opsim.plan.tools import Moment
from opsim.streams import BLOCK


class Looked(NamedTuple):
    """Performances looked at: measures (m, C, COLUMNS), and (m,) from and to which progress hands may be full."""

    measures: np.ndarray
    begin: np.ndarray
    end: np.ndarray

    def one(self, place: int) -> Looked:
        """One of them, by itself; NOTE: a copy, so that it does not keep the others."""
        return Looked(*(column[place : place + 1].copy() for column in self))


class Seen:
    """Looks at pieces of one worker, stretch after stretch, block by block of his draws."""

    def __init__(self, plan: Plan, replication: int, neutrals_rad: dict[str, float], lucks: Lucks):
        self._plan, self._replication = plan, replication
        self._neutrals_rad, self._lucks = neutrals_rad, lucks
        self._kept: dict[tuple[int, int], Looked] = {}

    def parts(self, spans: Spans, again: np.ndarray) -> Iterator[Parts]:
        """Frames of some pieces of work; again : (P,) whether the performance of each goes on after this stretch."""
        kept = np.array([key in self._kept for key in _keys(spans.pieces)], dtype=bool)
        yield from self._seen_before(spans, np.flatnonzero(kept), again)
        new = np.flatnonzero(~kept)
        new, at = new[np.lexsort([spans.pieces.k[new], spans.pieces.task[new]])], 0
        for block, some in drawn_again(spans.pieces.some(new), self._replication, self._plan, self._lucks):
            which = new[at : at + some.k.size]
            at += some.k.size
            if has_body(block):
                yield self._seen_now(spans, which, block, again)
            else:
                handling = self._plan.tasks[int(some.task[0])].handling
                if handling.by_share:
                    yield not_seen(spans, which, (handling.start.share, handling.end.share))
                else:
                    yield not_looked_at(spans, which)

    def _seen_before(self, spans: Spans, which: np.ndarray, again: np.ndarray) -> Iterator[Parts]:
        for at, key in zip(which.tolist(), _keys(spans.pieces.some(which))):
            looked = self._kept[key]
            yield looked_at(spans, np.array([at]), looked.measures, np.array([0]), (looked.begin, looked.end))
        for at, key in zip(which.tolist(), _keys(spans.pieces.some(which))):
            if not again[at]:
                self._kept.pop(key, None)

    def _seen_now(self, spans: Spans, which: np.ndarray, block: Any, again: np.ndarray) -> Parts:
        pieces = spans.pieces.some(which)
        numbers, first, place = np.unique(pieces.k, return_index=True, return_inverse=True)
        looked = self._look(block, int(pieces.task[0]), numbers % BLOCK)
        for at in np.flatnonzero(again[which[first]]).tolist():
            self._kept[int(pieces.task[0]), int(numbers[at])] = looked.one(at)
        return looked_at(spans, which, looked.measures, place, (looked.begin, looked.end))

    def _look(self, block: Any, task: int, rows: np.ndarray) -> Looked:
        named = self._plan.tasks[task]
        with named_by(named):
            measures = measures_of(block, rows, self._plan.ergonomics, self._neutrals_rad[named.name])
        return Looked(np.asarray(measures, np.float32), *hands_full(named.handling, block, rows))


def _keys(pieces: Pieces) -> Iterator[tuple[int, int]]:
    """Task and k of each: which performance of the worker."""
    return zip(pieces.task.tolist(), pieces.k.tolist())


def hands_full(handling: Handling, block: Any, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m,) and (m,) from and to which share of their time hands hold what is handled, in some rows of a block."""
    return _share(handling.start, block, rows), _share(handling.end, block, rows)


def _share(moment: Moment, block: Any, rows: np.ndarray) -> np.ndarray:
    if moment.mark < 0:
        return np.full(rows.size, moment.share)
    return np.asarray(block.mark_s)[rows, moment.mark] / np.asarray(block.duration_s)[rows]
