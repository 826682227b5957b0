"""Crews: people who share a line by a rule of their own."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from opsim.scenario.fields import NameText
from opsim.scenario.schema.base import Block


class Crew(Block):
    """People who go with their jobs along a line. Nobody else works at its stations, and they work nowhere else.

    No job overtakes another: who catches up with the one ahead waits behind him. Who is on a break, absent or off is
    passed over, and what he left is taken up by the next who comes to it. Who finds nothing to do goes to the first
    station.

    bucket_brigade: who has come to the end of the line walks back along it, station by station, to the job that is
    furthest on of those of the people before him, and takes it over where it is, in the middle of a task too; whom he
    relieves does the same, and the first begins a new job. What is left takes his own next time for the same share. A
    job that is done at the station to which he is on his last way waits there for him. A task whose own rule of
    interruption is finish, finish_job or restart is not taken over in the middle: he waits until it is done.

    rabbit_chase: everybody goes with his job from the first station to the last, and straight back to the first.

    Source: Bartholdi & Eisenstein 1996, A production line that balances itself, Operations Research 44(1).
    """

    kind: Literal["bucket_brigade", "rabbit_chase"] = Field(
        description="bucket_brigade: a job is taken over from the one before; rabbit_chase: everybody with his own job"
    )
    stations: list[NameText] = Field(
        min_length=1, description="in the order of the line; jobs may skip some, never go back", examples=["[a, b, c]"]
    )
    workers: list[NameText] = Field(
        min_length=1,
        description="in the order of the line: of a bucket brigade, from the one who begins jobs to the one who ends "
        "them; slowest to fastest balances itself, the other way round they wait for each other",
        examples=["[slow, middle, fast]"],
    )
