"""Posts of a rotation by how much they add to a body."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from opsim.ergonomics.shift.dose_rates import DoseRates
    from opsim.plan import Plan


def heaviest_first(plan: Plan, rates: DoseRates, posts: Sequence[Sequence[int]], members: Sequence[int]) -> list[int]:
    """Numbers of posts, those first where a job adds most to a body, on the mean of the members; else as they stand."""

    def added(post: Sequence[int]) -> float:
        tasks = [task for station in post for task in plan.stations[station].tasks]
        return sum(plan.tasks[task].mean_s() * per_s(task) for task in tasks)

    def per_s(task: int) -> float:
        return sum(rates.per_s(member, task) for member in members) / len(members)

    strain = [added(post) for post in posts]
    return sorted(range(len(posts)), key=lambda post: (-strain[post], post))
