"""The second half of a settle step: dispatch until nothing changes."""

from opsim.engine.simpy_engine.allocation import send_workers
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import admit, release_saturated, turn_away

MOST_ROUNDS = 10_000


class EndlessInstant(RuntimeError):
    """An instant that would not come to rest: a loop of zero delays."""


def dispatch(floor: Floor) -> None:
    """Move jobs, give out tools, parts, vehicles and what else they wait for, send workers, until nothing changes."""
    for _ in range(MOST_ROUNDS):
        if floor.stirred:
            admit(floor)
        if floor.saturated:
            release_saturated(floor)
        if floor.losing:
            turn_away(floor)
        changed = False
        for given_out in floor.dispatchers:
            if given_out(floor):
                changed = True
        if floor.free:
            send_workers(floor)
        if not floor.stirred and not changed:
            return
    names = ", ".join(sorted({station.plan.name for gate in floor.stirred for station in gate.stations}))
    raise EndlessInstant(f"t = {floor.now} s: over {MOST_ROUNDS} rounds in one instant; still moving at: {names}")
