"""Joins of motions whose postures are far apart: said as warnings, never refused."""

import math
from collections.abc import Iterator

from opsim.plan.plan import Plan


def wide_joins(plan: Plan) -> list[str]:
    """Every warning in a sentence."""
    return list(_wide(plan))


def _wide(plan: Plan) -> Iterator[str]:
    for task in plan.tasks:
        joins = getattr(task.model, "joins", None)
        for join in () if joins is None else joins():
            if join.gap_rad > join.most_rad:
                degrees, most = (math.degrees(angle) for angle in (join.gap_rad, join.most_rad))
                yield (
                    f"{task.name}: {join.before} ends far from where {join.after} begins: the bone to {join.joint} is "
                    f"{degrees:.0f} degrees away (more than {most:.0f}) and is led there as nobody was recorded; put a "
                    "motion between"
                )
