"""The second half of a settle step: dispatch until nothing changes."""

from opsim.engine.simpy_engine.allocation import send_workers
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import admit, release_saturated, turn_away

MOST_ROUNDS = 10_000


class EndlessInstant(RuntimeError):
    """An instant that would not come to rest: a loop of zero delays."""


def dispatch(floor: Floor) -> None:
    """Move jobs, then send workers, until nothing changes."""
    for _ in range(MOST_ROUNDS):
        if not _round(floor):
            return
    names = ", ".join(station.plan.name for station in floor.calling.values())
    raise EndlessInstant(
        f"t = {floor.env.now} s: more than {MOST_ROUNDS} rounds in one instant; still calling: {names}"
    )


def _round(floor: Floor) -> bool:
    changed = admit(floor)
    if floor.plan.release.kind == "saturated":
        changed |= release_saturated(floor)
    if floor.plan.release.when_full == "lose":
        turn_away(floor)
    return send_workers(floor) or changed
