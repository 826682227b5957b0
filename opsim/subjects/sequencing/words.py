"""The sequence of work: what waits where, in which order, and what changing over costs."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from opsim import units
from opsim.clock import LONGEST_S
from opsim.problems import shown
from opsim.scenario.fields import NameText, is_name, not_a_name, plain_error
from opsim.scenario.tree import Block

Blocking = Literal["after", "before"]


def _time_or_task(value: object) -> object:
    """What reads as a time is one; any other name is that of a task."""
    if isinstance(value, str) and not value[:1].isdigit() and value[:1] not in "+-.":
        if not is_name(value):
            raise plain_error(*not_a_name(value))
        return value
    try:
        seconds = units.parse(value, "time")
    except units.UnitError as error:
        raise plain_error(error.message, error.hint or "a time such as 5 min, or the name of a task") from None
    if not 0 <= seconds <= LONGEST_S:
        raise plain_error(
            f"must be from 0 s to {LONGEST_S:.10g} s, found {shown(value)}", "such as '5 min', or 0 s for none"
        )
    return seconds


SetupTime = Annotated[
    float | str,
    BeforeValidator(_time_or_task),
    WithJsonSchema({"type": "string", "examples": ["5 min"], "description": "a time, or the name of a task"}),
]


class Setup(Block):
    """What a server needs before a job of another product, or family, than the one it did last."""

    times: dict[str, dict[str, SetupTime]] = Field(
        {},
        description="from what the server did last to what comes: a time, or the name of a task; the same again needs "
        "none unless it stands here",
        examples=["{a: {b: 5 min}}"],
    )
    otherwise: SetupTime | None = Field(
        None, description="every change that is not in times; a time, or the name of a task", examples=["10 min"]
    )
    by: Literal["product", "family"] = Field("product", description="what is told apart: products, or their families")
    attended: bool = Field(True, description="true: a worker with the station's skill does it; false: it runs alone")
    first: NameText | None = Field(
        None,
        description="what the servers are set up for at the start; absent: for whatever comes first",
        examples=["carton"],
    )

    @model_validator(mode="after")
    def _says_something(self) -> Setup:
        if not self.times and self.otherwise is None:
            raise plain_error("nothing says how long a set-up takes", "add e.g. 'otherwise: 10 min'")
        return self


class Flow(Block):
    """What holds at every station that does not say otherwise."""

    dispatch: NameText = Field(
        "fifo",
        description="which waiting job is next, after priorities: fifo; spt: shortest operation; edd: earliest due "
        "date; critical_ratio: time left over work left; least_setup: shortest set-up; downstream_first: fewest "
        "operations left; a plug-in may bring more rules",
        examples=["fifo", "spt", "edd", "critical_ratio", "least_setup", "downstream_first"],
    )
    routing: NameText = Field(
        "shortest_queue",
        description="which of the stations of a step with room a job goes to: shortest_queue: fewest jobs per server; "
        "least_loaded: where it would be done first by mean times; first_free: the first of the list with a free "
        "server; in_order: the first of the list with room; a plug-in may bring more rules",
        examples=["shortest_queue", "least_loaded", "first_free", "in_order"],
    )
    blocking: Blocking = Field(
        "after",
        description="after: a job that is done waits on its server for room downstream; before: a job is begun only "
        "when its place downstream is sure, and keeps it",
    )
