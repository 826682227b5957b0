"""What somebody should know before he believes the figures of a run."""

from collections.abc import Iterator, Sequence

from opsim.plan import Plan
from opsim.plan.unread import unread
from opsim.study.replicate import Replicated


def warnings_of(done: Sequence[Replicated], plan: Plan) -> list[str]:
    """Every warning in a sentence."""
    return [*_locked(done), *unread(plan)]


def _locked(done: Sequence[Replicated]) -> Iterator[str]:
    """Floors that stood still because jobs waited for each other in a ring."""
    stuck = [(one.locked.since_s, one.replication, one.locked) for one in done if one.locked is not None]
    if not stuck:
        return
    since_s, replication, ring = min(stuck, key=lambda one: one[:2])
    waits = zip(ring.stations, (*ring.stations[1:], ring.stations[0]))
    chain = ", ".join(f"{here} waits for {there}" for here, there in waits)
    people = f"; needed there, and held by blocked jobs: {', '.join(ring.workers)}" if ring.workers else ""
    yield (
        f"the floor locked itself in {len(stuck)} of {len(done)} replications and stood still from then on; first in "
        f"replication {replication} at {since_s:.0f} s: {chain}{people}. More room, 'buffer: unlimited' or "
        f"'when_blocked: free' helps"
    )
