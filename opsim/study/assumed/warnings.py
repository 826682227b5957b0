"""What somebody should know before he believes the figures of a run."""

from collections.abc import Iterator, Sequence

from opsim.kpi.locked import Locked
from opsim.kpi.waits.bringing import NOBODY
from opsim.kpi.waits.fills import TO_FILL
from opsim.names import listed
from opsim.plan import Plan
from opsim.plan.unread import unread
from opsim.study.replicated import Replicated


def warnings_of(done: Sequence[Replicated], plan: Plan) -> list[str]:
    """Every warning in a sentence."""
    return [*_locked(done), *unread(plan)]


def _locked(done: Sequence[Replicated]) -> Iterator[str]:
    """Floors that stood still because jobs waited for each other in a circle, with what each of them waited for."""
    stuck = [(one.locked.since_s, one.replication, one.locked) for one in done if one.locked is not None]
    if not stuck:
        return
    since_s, replication, ring = min(stuck, key=lambda one: one[:2])
    people = f"; needed there, and held by blocked jobs: {', '.join(ring.workers)}" if ring.workers else ""
    others = f" ({ring.n_jobs} jobs in all, at {listed(list(ring.stations))})" if ring.n_jobs > len(ring.circle) else ""
    yield (
        f"the floor locked itself in {len(stuck)} of {len(done)} replications and stood still from then on; first in "
        f"replication {replication} at {since_s:.0f} s: {', '.join(ring.circle)}{others}{people}. "
        f"{_remedy(ring)}"
    )


def _remedy(ring: Locked) -> str:
    told = " ".join(ring.circle)
    if NOBODY in told:
        return _TAKE
    if TO_FILL in told:
        return _FILL
    return _REMEDY if ring.workers else _MORE


_TAKE = "A card that comes back before the store ('to'), or a product that takes from it ('parts') helps"
_FILL = "'most_wait' lets a batch begin that is not full; more room or cards, or a smaller 'size' helps too"
_MORE = "More of what they wait for helps: room ('buffer: unlimited'), tools, cards or stock"
_REMEDY = "More room, 'buffer: unlimited' or 'when_blocked: free' helps"
