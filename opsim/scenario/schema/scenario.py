"""A whole scenario, and the block behind each section."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from opsim.kpi.names import KPIS, USUAL
from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import Name, Rating, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.layout import Layout
from opsim.scenario.schema.material import Product, Station
from opsim.scenario.schema.release import Release
from opsim.scenario.schema.run import Run
from opsim.scenario.schema.task_kinds import Task
from opsim.scenario.schema.walking import Walking
from opsim.scenario.schema.workers import Allocation, Worker, Workforce


def _known_output(value: object) -> object:
    if value not in KPIS:
        raise plain_error(f"unknown output {shown(value)}", did_you_mean(value, KPIS))
    return value


def _version_1(value: object) -> object:
    if isinstance(value, bool) or value != 1:
        raise plain_error(f"expected 1, found {shown(value)}", "this opsim reads version 1 of the language: 'opsim: 1'")
    return 1


class Scenario(Block):
    """A whole scenario, ``like`` and overrides already applied."""

    opsim: Annotated[Literal[1], BeforeValidator(_version_1)] = Field(
        description="version of this language", examples=[1]
    )
    name: str = Field(
        min_length=1, max_length=200, description="title of tables and report", examples=["Repacking cell"]
    )
    run: Run = Field(description="how long, how often, with which luck", examples=["{horizon: 8 h}"])
    libraries: dict[Name, str] = Field({}, description="motion libraries by the name tasks use")
    layout: Layout = Field(
        description="where things are, and how far apart", examples=["{places: {bench: [4 m, 1 m]}}"]
    )
    tasks: dict[Name, Task] = Field(
        min_length=1, description="pieces of work, and how long they take", examples=["{label: {fixed: 20 s}}"]
    )
    stations: dict[Name, Station] = Field(
        min_length=1, description="where tasks are done", examples=["{pack: {at: bench, tasks: [label]}}"]
    )
    products: dict[Name, Product] = Field(
        min_length=1, description="what is made, and its way", examples=["{carton: {route: [pack]}}"]
    )
    release: Release = Field(description="how jobs come in", examples=["{kind: poisson, every: 55 s}"])
    skill_levels: dict[Name, Rating] = Field(
        {}, description="ratings by name, for the skills of workers", examples=["{learner: 0.8, expert: 1.15}"]
    )
    workforce: Workforce | None = Field(None, description="workers drawn beside the named ones", examples=["{n: 12}"])
    workers: dict[Name, Worker] = Field({}, description="the people who work here")
    walking: Walking | None = Field(
        None, description="how people walk between places", examples=["{emulator: walking/walk}"]
    )
    allocation: Allocation = Field(Allocation.model_validate({}), description="the rules by which workers choose")
    outputs: list[Annotated[str, BeforeValidator(_known_output)]] = Field(
        list(USUAL), description="the figures wanted, first those that matter most"
    )


BLOCKS: dict[str, type[Block]] = {
    "run": Run,
    "layout": Layout,
    "stations": Station,
    "products": Product,
    "release": Release,
    "workforce": Workforce,
    "workers": Worker,
    "walking": Walking,
    "allocation": Allocation,
}
