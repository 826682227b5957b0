"""Breakdowns by the clock, by time at work or by cycles; planned maintenance; repair teams."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from opsim.problems import shown
from opsim.scenario.fields import NameText, Seconds, Whole, plain_error
from opsim.scenario.tree import DIST, Block
from opsim.subjects.tasks.kinds import PlainTime, TimeModel
from opsim.subjects.tasks.words import TaskBlock

MOST_CYCLES = 1_000_000_000


class GeometricCycles(Block):
    """The same chance, one in `mean`, after each cycle."""

    dist: Literal["geometric"] = DIST
    mean: float = Field(ge=1, le=MOST_CYCLES, description="cycles on average", examples=[100])


class UniformCycles(Block):
    """Any number of cycles from low to high, equally likely: what wears out in use."""

    dist: Literal["uniform"] = DIST
    low: Whole = Field(ge=1, le=MOST_CYCLES, description="fewest cycles", examples=[400])
    high: Whole = Field(ge=1, le=MOST_CYCLES, description="most cycles", examples=[500])

    @model_validator(mode="after")
    def _low_first(self) -> UniformCycles:
        if self.low > self.high:
            raise plain_error(f"low ({self.low}) must be at most high ({self.high})", on="low")
        return self


CYCLE_KINDS: dict[str, type[Block]] = {"<geometric cycles>": GeometricCycles, "<uniform cycles>": UniformCycles}
SO_MANY = "<so many>"
Cycles = (
    Annotated[Whole, Field(ge=1, le=MOST_CYCLES), Tag(SO_MANY)]
    | Annotated[GeometricCycles, Tag("<geometric cycles>")]
    | Annotated[UniformCycles, Tag("<uniform cycles>")]
)
"""A whole number of cycles, or a block with numbers where one of a time has quantities."""


def cycles_tag(value: object) -> str | None:
    """Which form of Cycles a value has; None where it has quantities, or is something else."""
    if isinstance(value, int):
        return SO_MANY
    if isinstance(value, GeometricCycles | UniformCycles):
        return f"<{value.dist} cycles>"
    if isinstance(value, dict) and f"<{value.get('dist')} cycles>" in CYCLE_KINDS:
        said = [value[key] for key in ("mean", "low", "high") if key in value]
        return None if any(isinstance(one, str) for one in said) or "step" in value else f"<{value['dist']} cycles>"
    return None


_TEAM = Field(None, description="repair team that has to come; absent: it begins at once", examples=["mechanics"])


def _not_a_mean(value: object) -> object:
    """A time alone would be taken for a mean by one and for an exact time by another."""
    if isinstance(value, str):
        raise plain_error(f"{shown(value)} on average or exactly?", "{dist: exponential, mean: ...} or {fixed: ...}")
    return value


def _counts(value: object) -> object:
    """By cycles, ``every`` is a number of cycles, with no unit."""
    if isinstance(value, dict) and value.get("by") == "cycles":
        every = value.get("every")
        if isinstance(every, str) or (isinstance(every, dict) and cycles_tag(every) is None):
            found = f"by: cycles counts operations, found {shown(every) if isinstance(every, str) else 'a time'}"
            raise plain_error(found, "such as 500, {dist: geometric, mean: 500} or {dist: uniform, ...}", on="every")
    return value


Every = Annotated[
    Cycles | Annotated[TimeModel, Tag("<model>")],
    Discriminator(lambda value: cycles_tag(value) or "<model>"),
    BeforeValidator(_not_a_mean),
]


class Breakdown(Block):
    """The station stops, all of its servers, until it is repaired. Short ones without a team are minor stops.

    by: clock: the time that it is up, in work or not; busy: the time that something is done on it; cycles: operations
    done, and it stops as the next one would begin. What is under way is interrupted. A station that stands does not
    break down again, and its counts stand still; what falls due at the same time follows.
    """

    every: Every = Field(
        description="from one repair to the next breakdown: a time by its distribution, or by cycles a number",
        examples=["{dist: exponential, mean: 4 h}"],
    )
    by: Literal["clock", "busy", "cycles"] = Field(
        "clock", description="what counts towards it: time that it is up, time at work, or operations done"
    )
    repair: Annotated[TimeModel, BeforeValidator(_not_a_mean)] = Field(
        description="how long the repair takes", examples=["{dist: lognormal, mean: 10 min, cv: 0.8}"]
    )
    team: NameText | None = _TEAM
    job: Literal["resume", "restart", "scrap"] = Field(
        "resume",
        description="the jobs that were in work: the task goes on with what was left, begins anew, or the job is scrap",
    )

    @model_validator(mode="before")
    @classmethod
    def _counted(cls, value: object) -> object:
        return _counts(value)

    @model_validator(mode="after")
    def _as_it_is_counted(self) -> Breakdown:
        if self.by != "cycles" and not isinstance(self.every, TaskBlock):
            hint = "write 'by: cycles', or e.g. {dist: exponential, mean: 4 h}"
            raise plain_error(f"by: {self.by} needs a time, found a number of cycles", hint, on="every")
        return self


def mean_s(time: float | TaskBlock) -> float | None:
    """Mean of a plain time in seconds; None where a file has to be read first."""
    return time if isinstance(time, float) else getattr(time, "mean_s", None)


class Maintenance(Block):
    """A planned stop by the clock: at `first`, then every so often, however long the last one took."""

    every_s: Seconds = Field(alias="every", description="from one start to the next", examples=["8 h"])
    first_s: Seconds | None = Field(
        None, alias="first", description="when it is due for the first time; absent: as `every`", examples=["4 h"]
    )
    lasts: PlainTime = Field(description="how long it takes", examples=["20 min"])
    team: NameText | None = _TEAM
    when: Literal["after_job", "at_once"] = Field(
        "after_job",
        description="after_job: jobs that were begun are finished first, none is begun; at_once: they are interrupted",
    )

    @property
    def lasts_s(self) -> float | None:
        """Mean length in seconds; None where a file has to be read first."""
        return mean_s(self.lasts)

    @model_validator(mode="after")
    def _shorter_than_its_period(self) -> Maintenance:
        if self.lasts_s is not None and self.lasts_s >= self.every_s:
            found = f"lasts {self.lasts_s:g} s and comes every {self.every_s:g} s: the station would never work"
            raise plain_error(found, "make it shorter, or rarer", on="lasts")
        return self


class RepairTeam(Block):
    """People who repair: so many stops can be put right at once, the one that waits longest first."""

    n: Whole = Field(1, ge=1, le=100_000, description="how many stops at once", examples=[1])
