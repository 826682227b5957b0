"""Paced lines: stations of a route whose jobs move together.

Crews: people who share a line by a rule of their own.

Work sharing: the last tasks of a station, which the next one may do instead.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from opsim.scenario.fields import (
    BeltSpeed,
    NameText,
    PathLength,
    Pitch,
    Seconds,
    SecondsOrZero,
    plain_error,
)
from opsim.scenario.tree import Block

INDEXED, MOVING = "indexed", "moving"


class Andon(Block):
    """Somebody who is called to a job that is not done in time.

    He serves the line's stations only when he is called. The call goes to whoever of them is free, by the rule of
    allocation, or comes free first; where the job is done before he is there, he is free again. His own time counts for
    what is left: `take_over`: he goes on alone with all that is left at the station, and who was there is free; `help`:
    both work on it, so that what is left takes 1 / (1/a + 1/b) where it would take one a and the other b.
    """

    workers: list[NameText] = Field(min_length=1, description="who is called", examples=["[joker]"])
    at_s: SecondsOrZero = Field(
        alias="at",
        description="called when the job has been so long in its stretch, or at its station, and is not done; the time "
        "in which the line stands does not count",
        examples=["50 s"],
    )
    does: Literal["take_over", "help"] = Field("take_over", description="goes on alone, or helps who is there")


class Line(Block):
    """Consecutive stations of a route whose jobs move together; each station has one job at a time.

    Jobs come onto the line at every takt, one at a time; where none waits, an empty place moves on. `indexed`: all jobs
    move by one station at the same instant, a takt after the last move. `moving`: the line moves all the time, and jobs
    are takt x speed apart. A station is then a stretch of it; its worker walks with his job, and when it is done back
    to the next one, or to where he may begin. He begins when he and the job are there and the station before is done
    with it. The place of such a station is where its stretch begins. A station without tasks is an empty stretch.

    The line stands, and its clock with it, while one of its stations is down or closed, while nobody who works on it is
    there (breaks, the end of a shift), while a finished job cannot leave it, and, with `unfinished: stop`, while a job
    that should have moved on is worked on. Meanwhile work goes on. With `unfinished: send_on` such a job goes on as it
    is, whatever it waits for: its work at the station is broken off for good, and it is bad.
    """

    kind: Literal["indexed", "moving"] = Field(
        description="indexed: all jobs move at the same instants; moving: a line that moves all the time"
    )
    stations: list[NameText] = Field(
        min_length=1, description="stations in the order of the line", examples=["[door, seat, wheel]"]
    )
    takt_s: Seconds = Field(alias="takt", description="from one job coming onto the line to the next")
    unfinished: Literal["stop", "send_on"] = Field(
        "stop",
        description="what becomes of a job that is not done when it should move on, or comes to where its worker must "
        "stop: stop: the line stands until it is done; send_on: it goes on unfinished, and is bad",
    )
    andon: Andon | None = Field(
        None, description="who is called before it comes to that", examples=["{workers: [joker], at: 50 s}"]
    )
    length_m: Pitch | None = Field(
        None, alias="length", description="moving: of each station's stretch", examples=["6 m"]
    )
    lengths_m: dict[NameText, Pitch] = Field(
        {}, alias="lengths", description="moving: of the stretches that differ, by station", examples=["{seat: 9 m}"]
    )
    speed_m_per_s: BeltSpeed | None = Field(
        None,
        alias="speed",
        description="moving: of the line; absent: length / takt, so that jobs are a stretch apart",
        examples=["0.1 m/s"],
    )
    upstream_m: PathLength = Field(
        0.0,
        alias="upstream",
        description="moving: how far before his stretch a worker may begin, where the station before is done",
        examples=["1 m"],
    )
    drift_m: PathLength = Field(
        0.0, alias="drift", description="moving: how far beyond his stretch he may go on", examples=["1 m"]
    )

    @property
    def pace_m_per_s(self) -> float:
        """How fast a moving line moves."""
        return self.speed_m_per_s if self.speed_m_per_s is not None else (self.length_m or 0.0) / self.takt_s

    @model_validator(mode="after")
    def _says_what_its_kind_needs(self) -> Line:
        if self.kind == INDEXED:
            for key in ("length", "lengths", "speed", "upstream", "drift"):
                if self.model_fields_set & {f"{key}_m", f"{key}_m_per_s"}:
                    hint = "remove it, or write 'kind: moving'"
                    raise plain_error(f"an indexed line has no {key!r}: its jobs stand at stations", hint, on=key)
        elif self.length_m is None:
            hint = "add e.g. 'length: 6 m'"
            raise plain_error("a moving line needs to know how long a station's stretch is", hint)
        if self.andon is not None and self.andon.at_s >= self._most_s:
            found = f"called at {self.andon.at_s:g} s, when the {self._most_s:g} s that a job has there are over"
            raise plain_error(found, "call earlier", on="andon")
        return self

    @property
    def _most_s(self) -> float:
        """The longest that a job may be in any stretch, or at any station, while the line runs."""
        if self.length_m is None:
            return self.takt_s
        return (max([self.length_m, *self.lengths_m.values()]) + self.drift_m) / self.pace_m_per_s


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


class Share(Block):
    """Work that two neighbours share: the last tasks here may be left to the next station, which does them first.

    When the tasks before are done, the station looks at the next one. Where a server is free there, or less than so
    much of its buffer is taken, the job goes on as it is; else the shared task is done here, and it is looked again
    before another one. A task that was begun is finished where it was begun.
    """

    tasks: list[NameText] = Field(
        min_length=1, description="the last of the station's tasks, in their order", examples=["[lid]"]
    )
    partner: NameText = Field(
        alias="with", description="the next station on the way of every job that comes here", examples=["closing"]
    )
    when: Literal["half_full", "full"] = Field(
        "half_full",
        description="the station does the work itself where the next one's buffer is at least half full, or full",
    )
