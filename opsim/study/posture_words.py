"""What figures of posture take as given."""

from collections.abc import Iterator

from opsim.ergonomics.bodies import has_trunk
from opsim.plan import Plan
from opsim.streams import stream


def posture_assumptions(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of every figure that was made from postures."""
    yield (
        "postures",
        "trunk flexion is the angle of the line from pelvis to neck against the vertical, forward as the hips face; "
        "minutes at an angle are measured minutes of work in an hour of the window: everybody is present all of it",
    )
    unknown = [task.name for task in plan.tasks if not task.automatic and not _has_body(task)]
    if unknown:
        yield (
            "postures",
            f"{', '.join(unknown)}: no posture is known; the time counts as not measured, neither upright nor bent, so "
            "that minutes at an angle are too few by what would have been seen there",
        )
    yield "postures", "walking and waiting are not measured; how people move from one task into the next is not known"


def _has_body(task) -> bool:
    return has_trunk(task.model.sample(1, stream(0, 0, "duration", task.name, "anybody", 0)))
