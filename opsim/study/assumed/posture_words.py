"""What figures of posture take as given."""

from collections.abc import Iterator

from opsim.ergonomics.bodies import has_trunk
from opsim.ergonomics.walking import LOOKED_AT
from opsim.plan import Plan
from opsim.streams import stream


def posture_assumptions(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of every figure that was made from postures."""
    in_shifts = any(worker.duties is not None for worker in plan.workers)
    present = " in which a worker is there, breaks included" if in_shifts else ": everybody is present all of it"
    yield (
        "postures",
        "trunk flexion is the angle of the line from pelvis to neck against the vertical, forward as the hips face; "
        f"minutes at an angle are measured minutes of work in an hour of the window{present}",
    )
    unknown = [task.name for task in plan.tasks if not task.automatic and not _has_body(task)]
    if unknown:
        yield (
            "postures",
            f"{', '.join(unknown)}: no posture is known; the time counts as not measured, neither upright nor bent, so "
            "that minutes at an angle are too few by what would have been seen there",
        )
    waits = "walking and waiting are" if plan.walking is None else "waiting is"
    yield "postures", f"{waits} not measured; how people move from one task into the next is not known"
    if plan.walking is not None:
        yield (
            "postures",
            "figures of the trunk are of work, and have the parts 'walking' and 'together' (work and walking) besides; "
            f"of a worker who walks more than {LOOKED_AT} times in a replication, {LOOKED_AT} walks are looked at and "
            "stand for all",
        )


def _has_body(task) -> bool:
    return has_trunk(task.model.sample(1, stream(0, 0, "duration", task.name, "anybody", 0)))
