"""Stations, and batches on their servers."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from opsim.scenario.fields import MOST_PIECES, Name, NameText, Seconds, Whole, unlimited
from opsim.scenario.tree import Block
from opsim.subjects.breakdowns.words import Breakdown, Maintenance
from opsim.subjects.lines.words import Share
from opsim.subjects.quality.words import Inspect, LessThanAll, Yield, one_word_on_scrap
from opsim.subjects.sequencing.words import Blocking, Setup
from opsim.subjects.shifts.words import ShiftNames
from opsim.subjects.tools.words import Needs


class Batch(Block):
    """Several jobs at once on one server, such as in an oven: its tasks are done once for all of them together.

    A batch begins when it is full, or when the first job of it has waited as long as it may.
    """

    size: Whole = Field(ge=2, le=MOST_PIECES, description="jobs on a server at once, a lot is one", examples=[4])
    most_wait_s: Seconds | None = Field(
        None,
        alias="most_wait",
        description="a job that has waited so long takes a server with those there are; absent: waits for a full batch",
        examples=["10 min"],
    )
    of: Literal["any", "product", "family"] = Field(
        "any", description="which jobs go together: any, those of one product, or those of one family"
    )


class Station(Block):
    """A place with servers and a buffer in front, where tasks are done in order."""

    at: NameText = Field(description="a place of the layout", examples=["bench"])
    tasks: list[NameText] = Field(description="done here, in this order; [] where jobs only pass", examples=["[label]"])
    servers: Whole = Field(1, ge=1, le=100_000, description="jobs in work at once", examples=[2])
    buffer: Annotated[Whole | None, BeforeValidator(unlimited)] = Field(
        None,
        ge=0,
        le=1_000_000_000,
        description="jobs that can wait in front; absent or 'unlimited': no limit",
        examples=[4, "unlimited"],
    )
    buffer_after: Whole = Field(
        0,
        ge=0,
        le=1_000_000_000,
        description="finished jobs that can wait here for room downstream, off the servers",
        examples=[2],
    )
    blocking: Blocking | None = Field(
        None,
        description="after: a finished job keeps its server until there is room downstream; before: a job is begun "
        "only when its place downstream is sure; absent: as flow.blocking",
    )
    dispatch: NameText | None = Field(
        None, description="which waiting job is next; absent: as flow.dispatch", examples=["spt"]
    )
    preempt: Literal["resume", "restart"] | None = Field(
        None,
        description="a job of higher priority takes the server of a lower one, which goes on where it was later "
        "(resume) or begins the interrupted task anew (restart); absent: what was begun is finished",
    )
    setup: Setup | None = Field(
        None, description="what changing over costs", examples=["{otherwise: 10 min, by: family}"]
    )
    batch: Batch | None = Field(
        None, description="several jobs at once on a server, the tasks done once for all", examples=["{size: 4}"]
    )
    breakdowns: dict[Name, Breakdown] = Field(
        {},
        description="what stops the station by chance, by name; one at a time",
        examples=[
            "{jam: {every: {dist: exponential, mean: 4 h}, by: busy, repair: {dist: exponential, mean: 10 min}}}"
        ],
    )
    maintenance: dict[Name, Maintenance] = Field(
        {},
        description="what stops the station as planned, by name",
        examples=["{oiling: {every: 8 h, lasts: 20 min, team: mechanics}}"],
    )
    needs: Needs = Field(
        {}, description="so many of each tool, all at once, from the server until the job leaves the station"
    )
    yield_share: Yield | None = Field(
        None,
        alias="yield",
        description="share of jobs that the work here leaves without a defect; absent: all",
        examples=[0.97],
    )
    scrap_share: LessThanAll | None = Field(
        None,
        alias="scrap",
        description="share of jobs that the work here spoils; they, and those that came with a defect, are scrapped",
        examples=[0.02],
    )
    inspect: Inspect | None = Field(
        None, description="a look at each job when its work here is done", examples=["{finds: 0.98, then: scrap}"]
    )

    shift: ShiftNames | None = Field(
        None,
        description="the shift, or all shifts, in which the station is open; absent: always",
        examples=["day", "[early, late]"],
    )
    at_close: Literal["finish", "resume"] = Field(
        "finish",
        description="the tasks under way when it closes: finish: are done first, by whoever takes them over too, and "
        "the next task, or repeat, waits for the opening; resume: stop at once, and go on with the rest at the opening",
    )

    priority: Whole = Field(
        0,
        ge=-1000,
        le=1000,
        description="workers go to stations of a higher one first, before the rule of allocation",
        examples=[1],
    )
    share: Share | None = Field(
        None,
        description="its last tasks, where the next station may do them instead",
        examples=["{tasks: [lid], with: closing, when: half_full}"],
    )

    @model_validator(mode="after")
    def _one_word_on_scrap(self) -> Station:
        one_word_on_scrap(self)
        return self
