"""Laws of people written to be read: nobody is anywhere he did not walk to, and pieces of work join without a gap."""

from __future__ import annotations

from collections.abc import Iterator

from contests import Piece, pieces_of

from opsim import log as kinds
from opsim.log import EventLog
from opsim.plan import Plan

AWAY = (kinds.OFF, kinds.ABSENT)


def jumps(log: EventLog, plan: Plan) -> Iterator[str]:
    """Who is somewhere without having walked there. Who comes to his shift appears at home."""
    for rank, worker in enumerate(plan.workers):
        rows = log.where(log["worker"] == rank)
        at: int | None = worker.place
        columns = (rows[name].tolist() for name in ("kind", "start_s", "station", "place_from", "place_to"))
        for kind, start_s, station, place_from, place_to in sorted(zip(*columns), key=lambda row: row[1]):
            if kind in AWAY:
                at = None  # wherever he is, he comes back to his home
                continue
            at = worker.place if at is None else at
            if kind in (kinds.WORK, kinds.SETUP):
                place_from = place_to = plan.stations[station].place
            if kind != kinds.TRANSPORT and place_from >= 0:
                if place_from != at:
                    was, found = plan.places[at], plan.places[place_from]
                    yield f"{worker.name} is at {found} at {start_s:g} s, and was at {was}"
                at = place_to


def unjoined(log: EventLog) -> Iterator[str]:
    """Pieces that go on where nothing ended: from a progress that no piece of the same job and task came to."""
    reached: dict[tuple[int, ...], float] = {}
    of_jobs = [piece for piece in pieces_of(log) if piece.job >= 0]  # parts of a team's work name no job
    for piece in sorted(of_jobs, key=lambda piece: (piece.start_s, piece.end_s)):
        if piece.progress_from > 0 and reached.get(_place(piece)) != piece.progress_from:
            yield f"job {piece.job} goes on from {piece.progress_from} at {piece.start_s:g} s, which nobody came to"
        reached[_place(piece)] = piece.progress_to


def _place(piece: Piece) -> tuple[int, ...]:
    return piece.job, piece.station, piece.task
