"""What a scenario may say of job rotation, and what that is in numbers: who is at which post, and when."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from opsim.engine.rules import in_turn
from opsim.layout import given_out, turns_away
from opsim.problems import natural_key, shown
from opsim.scenario.fields import NameText, Seconds, Whole, plain_error
from opsim.scenario.tree import Block

IN_TURN = "in_turn"


def _post(value: object) -> object:
    """One station by its name is a post too."""
    if isinstance(value, str):
        return [value]
    if not isinstance(value, list):
        raise plain_error(f"expected a station or a list of them, found {shown(value)}", "such as [pack]")
    return value


_ONE_OR_MORE = WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]})


Post = Annotated[list[NameText], BeforeValidator(_post), _ONE_OR_MORE]


class Rotation(Block):
    """People who change posts. A post is a station, or a few; who has a post works at no other post of the rotation.

    The members who are there man the posts in the order of the lists, then each post a second time, and so on; at each
    change everybody moves up by one post. Where there are fewer people than posts they go on to the empty ones. A post
    goes to somebody with a skill for it, where there is one. What was begun is finished at the old post. A break
    changes nothing; when somebody goes off shift or comes back, posts are given out anew. Stations in no post, and
    people who are no members, are as ever.
    """

    workers: list[NameText] = Field(min_length=1, description="who changes posts", examples=["[ana, ben, cem]"])
    posts: list[Post] = Field(
        min_length=2,
        description="the posts, each a station or a list of them; an empty list is a rest, or work at stations that "
        "are in no post",
        examples=["[pack, label, [lift, stack]]"],
    )
    every_s: Seconds | None = Field(
        None,
        alias="every",
        description="by the clock, from the start of the run: time between changes",
        examples=["2 h"],
    )
    after: Whole | None = Field(
        None,
        ge=1,
        le=1_000_000,
        description="by count: everybody changes when so many operations were done at one of the posts since the last "
        "change",
        examples=[50],
    )
    rule: NameText = Field(
        IN_TURN,
        description="who takes which post at a change: in_turn (everybody moves up by one), least_time (each post, the "
        "first of the list first, goes to who was there for the shortest time so far), least_exposed (each post, the "
        "heaviest first, goes to whose body has gone through least so far, RULA x time at work), or a plug-in's; "
        "alone, without `every` and `after`, it is asked whenever an operation is done at one of the posts",
        examples=["least_time", "least_exposed"],
    )

    @model_validator(mode="after")
    def _at_some_time(self) -> Rotation:
        if self.every_s is not None and self.after is not None:
            raise plain_error(
                "changes by the clock (every) and by count (after) both", "remove one of them", on="after"
            )
        if self.every_s is None and self.after is None and "rule" not in self.model_fields_set:
            found = "nothing says when people change posts"
            raise plain_error(found, "add 'every: 2 h', 'after: 50' or 'rule: least_time'")
        return self


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

    def can(self, ratings: Sequence[Sequence[float]]) -> Callable[[int, int], bool]:
        """Whether a member, by his number in the list, can be at a post: with a skill for it, or where none is.

        ratings : of each worker at each station, 0 without the skill
        """
        able = [[_able(ratings[rank], post) for post in self.posts] for rank in self.workers]
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


def _able(rating: Sequence[float], post: Sequence[int]) -> bool:
    return not post or any(rating[station] > 0 for station in post)


def plan_rotations(
    said: Mapping[str, Rotation], workers: Iterable[str], stations: Mapping[str, int]
) -> tuple[RotationPlan, ...]:
    """All rotations in natural order of names; workers : names of all; stations : their ranks."""
    numbers = {name: rank for rank, name in enumerate(sorted(workers, key=natural_key))}
    return tuple(
        RotationPlan(
            name,
            tuple(numbers[worker] for worker in made.workers),
            tuple(tuple(stations[station] for station in post) for post in made.posts),
            made.every_s,
            made.after if made.every_s is not None or made.after is not None else 1,
            made.rule,
        )
        for name, made in sorted(said.items(), key=lambda item: natural_key(item[0]))
    )
