"""Job rotation: who is at which post, and what makes people change."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from opsim.engine.rules import in_turn
from opsim.names import natural_key
from opsim.posts import given_out, turns_away

if TYPE_CHECKING:
    from opsim.plan.worker import WorkerPlan

IN_TURN = "in_turn"


@dataclass(frozen=True, slots=True)
class RotationPlan:
    """workers : ranks in the order of the list; posts : ranks of the stations of each post, in the order of the list

    every_s : changes by the clock; after : by so many operations at one of the posts; None where not so
    rule    : who takes which post, one of ``opsim.engine.rules.ROTATION_RULES`` or a plug-in's
    """

    name: str
    workers: tuple[int, ...]
    posts: tuple[tuple[int, ...], ...]
    every_s: float | None = None
    after: int | None = None
    rule: str = IN_TURN

    @property
    def stations(self) -> int:
        """The stations of all posts, as bits of their ranks."""
        return sum(1 << rank for rank in {rank for post in self.posts for rank in post})

    def leaves(self, post: int, all_stations: int) -> int:
        """The stations where somebody at a post may work, as bits: those of the post, and those in no post."""
        return (all_stations & ~self.stations) | sum(1 << rank for rank in set(self.posts[post]))

    def can(self, workers: Sequence[WorkerPlan]) -> Callable[[int, int], bool]:
        """Whether a member, by his number in the list, can be at a post: with a skill for it, or where none is."""
        able = [[_able(workers[rank], post) for post in self.posts] for rank in self.workers]
        return lambda member, post: able[member][post]

    def by_turns(self, there: Sequence[int], turn: int, can: Callable[[int, int], bool]) -> dict[int, int]:
        """{member: post} of those who are there, after so many changes, by turns."""
        away = self.turns_away(there, turn)
        return given_out(
            len(self.posts), there, can, lambda member, slot: in_turn(away(member, slot), 0.0, 0.0, member)
        )

    def turns_away(self, there: Sequence[int], turn: int) -> Callable[[int, int], int]:
        """Of a member who is there and a slot: after how many changes more it is his."""
        position, n_slots = {member: n for n, member in enumerate(there)}, max(len(there), len(self.posts))
        return lambda member, slot: turns_away(position[member], turn, slot, n_slots)


def _able(worker: WorkerPlan, post: Sequence[int]) -> bool:
    return not post or any(worker.rating[station] > 0 for station in post)


def plan_rotations(scenario, ranks) -> tuple[RotationPlan, ...]:
    """All rotations in natural order of names."""
    numbers = {name: rank for rank, name in enumerate(sorted(scenario.workers, key=natural_key))}
    return tuple(
        RotationPlan(
            name,
            tuple(numbers[worker] for worker in made.workers),
            tuple(tuple(ranks.stations[station] for station in post) for post in made.posts),
            made.every_s,
            made.after if made.every_s is not None or made.after is not None else 1,
            made.rule,
        )
        for name, made in sorted(scenario.rotations.items(), key=lambda item: natural_key(item[0]))
    )
