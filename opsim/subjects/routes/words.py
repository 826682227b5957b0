"""Routing by probability: where a job goes from each station; ``out`` is the way out.

Products.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field, model_validator

from opsim.problems import shown
from opsim.scenario.fields import (
    MOST_PIECES,
    MostLoad,
    NameText,
    Probability,
    Seconds,
    Whole,
    plain_error,
    summing_to_1,
)
from opsim.scenario.tree import Block
from opsim.subjects.material.words import PiecesByStation

START, OUT = "start", "out"


def _sure(value: object) -> object:
    """A station's name alone is where every job goes."""
    if isinstance(value, str):
        return {value: 1.0}
    if not isinstance(value, dict) or not value:
        found = f"expected a station, or stations with probabilities, found {shown(value)}"
        raise plain_error(found, "such as {drill: 0.9, out: 0.1}")
    return value


Onward = Annotated[dict[str, Probability], BeforeValidator(_sure), summing_to_1("probabilities")]


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

    share: float = Field(
        1.0, gt=0, le=1, description="share of all jobs; the shares of the products sum to 1", examples=[0.6]
    )
    route: Annotated[list[str | list[str]], BeforeValidator(_steps)] | None = Field(
        None, description="stations in order; a list inside: one of them does it", examples=["[unload, repack]"]
    )
    routing: dict[str, Onward] | None = Field(
        None,
        description="where a job begins (start), and where it goes from each station, by probability; out: it is done",
        examples=["{start: cut, cut: {drill: 0.9, out: 0.1}, drill: out}"],
    )

    lot: Whole = Field(
        1,
        ge=1,
        le=MOST_PIECES,
        description="units in a job; tasks are done for each unit, those 'per: lot' once",
        examples=[10],
    )
    family: NameText | None = Field(
        None, description="products of one family go together (batches, set-ups); absent: by itself", examples=["big"]
    )
    parts: PiecesByStation = Field(
        {},
        description="bill of material: pieces for one unit, by station and product, taken together before the first "
        "task there from the stores where those products end, as soon as all are there",
        examples=["{assemble: {wheel: 2, frame: 1}}"],
    )
    split: PiecesByStation = Field(
        {},
        description="by station: what one unit becomes when all is done there; the pieces go the ways of their "
        "products",
        examples=["{saw: {board: 4}}"],
    )
    mass_kg: MostLoad | None = Field(
        None, alias="mass", description="of one piece, for who carries it; absent: nobody's limit", examples=["8 kg"]
    )
    priority: Whole = Field(
        0, ge=-1000, le=1000, description="jobs of a higher one go first, before any dispatch rule", examples=[1]
    )
    due_s: Seconds | None = Field(
        None, alias="due", description="from the arrival of a job to its due date", examples=["4 h"]
    )
    carried: bool = Field(
        False,
        description="who did the last task at a station carries the job to the next, and waits while that is full; "
        "from a break he comes back to it, and when his shift is over, whoever is free and may serve that station "
        "comes for it as soon as there is room",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Product:
        if self.route is None and self.routing is None:
            raise plain_error("nothing says which way this product goes", "add e.g. 'route: [unload, repack]'")
        if self.route is not None and self.routing is not None:
            raise plain_error("the way comes from route and from routing", "keep one of them", on="routing")
        return self
