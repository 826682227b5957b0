"""Stations and products."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field, model_validator

from opsim.problems import shown
from opsim.scenario.fields import NameText, Whole, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.routing import Onward


def _unlimited(value: object) -> object:
    if isinstance(value, str):
        if value != "unlimited":
            raise plain_error(f"expected a whole number or unlimited, found {shown(value)}")
        return None
    return value


class Station(Block):
    """A place with servers and a buffer in front, where tasks are done in order."""

    at: NameText = Field(description="a place of the layout", examples=["bench"])
    tasks: list[NameText] = Field(min_length=1, description="done here, in this order", examples=["[label]"])
    servers: Whole = Field(1, ge=1, le=100_000, description="jobs in work at once")
    buffer: Annotated[Whole | None, BeforeValidator(_unlimited)] = Field(
        None, ge=0, le=1_000_000_000, description="jobs that can wait in front; absent or 'unlimited': no limit"
    )


def _steps(value: object) -> object:
    """Each step of a route is a station, or a list of stations one of which does it."""
    if not isinstance(value, list) or not value:
        raise plain_error(f"expected a list of stations, found {shown(value)}", "such as [unload, repack]")
    for number, step in enumerate(value):
        if not isinstance(step, str) and not (
            isinstance(step, list) and step and all(isinstance(s, str) for s in step)
        ):
            found = f"step {number + 1} of the route must be a station or a list of stations, found {shown(step)}"
            raise plain_error(found, on=number)
    return value


class Product(Block):
    """What is made: its share of the jobs, and its way through the stations: a route, or a routing by probability."""

    share: float = Field(1.0, gt=0, le=1, description="share of all jobs; the shares of the products sum to 1")
    route: Annotated[list[str | list[str]], BeforeValidator(_steps)] | None = Field(
        None, description="stations in order; a list inside: one of them does it", examples=["[unload, repack]"]
    )
    routing: dict[str, Onward] | None = Field(
        None,
        description="where a job begins (start), and where it goes from each station, by probability; out: it is done",
        examples=["{start: cut, cut: {drill: 0.9, out: 0.1}, drill: out}"],
    )

    carried: bool = Field(
        False,
        description="who did the last task at a station carries the job to the next, and waits while that is full",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Product:
        if self.route is None and self.routing is None:
            raise plain_error("nothing says which way this product goes", "add e.g. 'route: [unload, repack]'")
        if self.route is not None and self.routing is not None:
            raise plain_error("the way comes from route and from routing", "keep one of them", on="routing")
        return self
