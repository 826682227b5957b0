"""What a log shows of people: where the end of somebody's time met him at work, and what each rule did about it."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from opsim import log as kinds
from opsim.log import EventLog
from opsim.plan import Plan


@dataclass(frozen=True)
class Piece:
    """A row of work or set-up, as plain numbers."""

    start_s: float
    end_s: float
    worker: int
    station: int
    source: int
    job: int
    task: int
    performance_id: int
    progress_from: float
    progress_to: float


@dataclass(frozen=True)
class Met:
    """A break, a meeting or the end of a shift that came in the middle of a performance.

    after : the next piece of the same job and task at the station, where there is one; rule : that holds for it
    """

    time_s: float
    rule: str
    piece: Piece
    after: Piece | None


def pieces_of(log: EventLog) -> list[Piece]:
    """All pieces of work by somebody, in the order of the log."""
    rows = log.where(np.isin(log["kind"], (kinds.WORK, kinds.SETUP)) & (log["worker"] >= 0))
    return [Piece(*values) for values in zip(*(rows[name].tolist() for name in Piece.__dataclass_fields__))]


def met_at_work(log: EventLog, plan: Plan) -> list[Met]:
    """Each planned end of somebody's time that met him at work."""
    everything = pieces_of(log)
    return [met for worker in range(len(plan.workers)) for met in _met(everything, plan, worker)]


def _met(everything: list[Piece], plan: Plan, worker: int) -> Iterator[Met]:
    own = [piece for piece in everything if piece.worker == worker]
    ends_s = [piece.end_s for piece in own]
    for time_s, rule in _ends(plan, worker):
        at = bisect_left(ends_s, time_s)
        if at < len(own) and own[at].start_s < time_s and (own[at].end_s > time_s or own[at].progress_to < 1):
            piece = own[at]
            said = plan.tasks[piece.task].interruption
            yield Met(time_s, rule if said is None else said, piece, _after(everything, piece))


def _ends(plan: Plan, worker: int) -> Iterator[tuple[float, str]]:
    """When his time is planned to end or to pause, and by which rule."""
    for duty in plan.workers[worker].duties or ():
        shift = plan.shifts[duty.shift]
        for pause in duty.pauses:
            yield pause.start_s, shift.at_break
        if not duty.cut:
            yield duty.end_s, shift.at_end


def _after(everything: list[Piece], piece: Piece) -> Piece | None:
    def same(other: Piece) -> tuple[int, ...]:
        return other.source, other.job, other.station, other.task

    later = (other for other in everything if other.start_s >= piece.end_s and same(other) == same(piece))
    return min(later, key=lambda other: other.start_s, default=None)


def _stopped(met: Met) -> bool:
    return met.piece.end_s == met.time_s and met.piece.progress_to < 1


def _resumed(met: Met) -> bool:
    return _stopped(met) and met.after is not None and met.after.performance_id == met.piece.performance_id


def _by_another(met: Met) -> bool:
    after = met.after
    return after is not None and after.worker != met.piece.worker and after.progress_from > 0


def _begun_anew(met: Met) -> bool:
    return _stopped(met) and met.after is not None and met.after.progress_from == 0


CONTESTED: dict[str, Callable[[Met], bool]] = {
    "finish": lambda met: met.piece.end_s > met.time_s,
    "finish_job": lambda met: (
        met.after is not None and met.after.worker == met.piece.worker and met.after.start_s == met.piece.end_s
    ),
    "resume": _resumed,
    "resume_any": lambda met: _stopped(met) and _by_another(met),
    "hand_over": lambda met: _by_another(met) and met.after.start_s == met.piece.end_s,  # type: ignore[union-attr]
    "restart": _begun_anew,
}
"""Of each rule of interruption, whether a meeting with it shows what it does and the other rules would not."""


def contested(mets: list[Met]) -> set[str]:
    """The rules of interruption that a log shows at work."""
    return {met.rule for met in mets if CONTESTED[met.rule](met)}


def stays_on(log: EventLog, plan: Plan) -> bool:
    """Whether somebody began to work after the end of his shift, before the next one of his."""
    for worker, planned in enumerate(plan.workers):
        rows = log.where((log["worker"] == worker) & (log["kind"] == kinds.WORK))
        for duty, following in zip(planned.duties or (), [*(planned.duties or ())[1:], None]):
            until_s = plan.horizon_s if following is None else following.start_s
            if np.any((rows["start_s"] >= duty.end_s) & (rows["start_s"] < until_s)):
                return True
    return False
