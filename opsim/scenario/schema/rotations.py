"""Job rotation: people who change posts by the clock, by what was done, or by a rule."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from opsim.problems import shown
from opsim.scenario.fields import NameText, Seconds, Whole, plain_error
from opsim.scenario.schema.base import Block

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
