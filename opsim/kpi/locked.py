"""Whether a floor has locked itself: jobs that wait for each other in a circle and will wait for ever."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from opsim.kpi.waits.bringing import outside_at_end
from opsim.kpi.waits.graph import Pool, circles
from opsim.kpi.waits.inside import Inside, inside_at_end
from opsim.kpi.waits.parts import Waits, add_parts
from opsim.kpi.waits.pools import pools_of
from opsim.kpi.waits.ways import ways_of
from opsim.log import HELD, NO_WORKER, EventLog
from opsim.plan import Plan


@dataclass(frozen=True, slots=True)
class Locked:
    """stations : names of the stations, stores and conveyors of those who all wait for each other, in natural order

    since_s : when the circle closed; workers : names of those who are waited for and stand by a job of it
    circle  : the shortest circle among them, who waits for what, each having what the one before waits for
    n_jobs  : how many jobs wait for each other in all
    """

    stations: tuple[str, ...]
    since_s: float
    workers: tuple[str, ...] = ()
    circle: tuple[str, ...] = field(default=(), compare=False)
    n_jobs: int = field(default=0, compare=False)


def locked(log: EventLog, plan: Plan) -> Locked | None:
    """The circle that closed first, from what was open at the horizon; None where everything could still move.

    Jobs wait for a place (those that are blocked name the operation they want), a server, a worker, tools, cards or
    parts, and what they have is free again once they can move on. A job that wants back into its own station never is
    stuck, since it may take its own place again; repairs, set-ups, transport and whatever time alone ends neither, and
    a source of a time of its own may bring more after the horizon. The stuck jobs are the largest set in which
    everybody lacks something that only others of the set have.
    Source: Coffman, Elphick & Shoshani 1971, System deadlocks, Computing Surveys 3(2) (circular wait).
    """
    inside = inside_at_end(log, plan)
    pools = pools_of(log, plan, inside)
    waits: Waits = {}
    for one in inside:
        ways = ways_of(one, plan, inside, pools)
        if ways is not None:
            waits[one.name] = ways
    words = {one.name: one.words(plan) for one in inside} | add_parts(pools, waits, plan, inside, outside_at_end(log))
    by_name = {one.name: one for one in inside}
    found = [
        _told([by_name[name] for name in sorted(ring) if name in by_name], circle, pools, words, plan)
        for ring, circle in circles(waits, pools)
        if not ring.isdisjoint(by_name)
    ]
    return min(found, key=lambda ring: (ring.since_s, ring.stations), default=None)


def _told(
    ring: Sequence[Inside],
    circle: Sequence[tuple[str, str]],
    pools: Mapping[str, Pool],
    words: Mapping[str, str],
    plan: Plan,
) -> Locked:
    """The circle as people read it."""
    short_of_hands = {one.station for one in ring if one.waits(HELD, NO_WORKER)}
    workers = tuple(w.name for w in plan.workers if any(w.rating[rank] > 0 for rank in short_of_hands))
    steps = [
        f"{words[who]} waits for {pools[pool].what}" for who, pool in circle if not pool.startswith(("who", "step"))
    ]
    return Locked(
        tuple(plan.stations[rank].name for rank in sorted({one.station for one in ring})),
        max(one.since_s for one in ring),
        workers,
        tuple(dict.fromkeys(steps)),
        sum(one.n for one in ring),
    )
