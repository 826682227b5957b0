"""A whole scenario, and the block behind each section."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from opsim.kpi.catalogue import KPIS, USUAL, read_asked
from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import Name, plain_error
from opsim.scenario.schema.run import Run
from opsim.scenario.schema.studies import Studies
from opsim.scenario.schema.sweep import WayFigureText
from opsim.scenario.tree import Block
from opsim.subjects.breakdowns.words import RepairTeam
from opsim.subjects.exposure.words import Ergonomics
from opsim.subjects.human.words import Human
from opsim.subjects.lines.words import Crew, Line
from opsim.subjects.material.words import Card, Store
from opsim.subjects.people.words import Allocation, Rotation, SkillLevels, Worker, Workforce
from opsim.subjects.release.words import Release
from opsim.subjects.routes.words import Product
from opsim.subjects.sequencing.words import Flow
from opsim.subjects.shifts.words import Shift
from opsim.subjects.stations.words import Station
from opsim.subjects.tasks.kinds import Task, Walking
from opsim.subjects.tools.words import Tool
from opsim.subjects.transport.words import Conveyor, Layout, Transporter


def _known_output(value: object) -> object:
    if isinstance(value, str) and value not in KPIS:
        raise plain_error(f"unknown output {shown(value)}", did_you_mean(value, KPIS))
    return value


def _two(figures: list[str]) -> list[str]:
    if len(figures) != 2:
        found = f"expected two figures, found {len(figures) or 'none'}"
        raise plain_error(found, "such as [throughput_per_h, walked_m]")
    if read_asked(figures[0]).name == read_asked(figures[1]).name:
        raise plain_error("the same figure twice", "name two that pull against each other", on=1)
    return figures


Frontier = Annotated[list[WayFigureText], AfterValidator(_two)]


def _nothing(value: object) -> object:
    """``human: null`` in an override switches all effects off."""
    return {} if value is None else value


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
    libraries: dict[Name, str] = Field(
        {}, description="motion libraries by the name tasks use", examples=["{moves: libraries/public_movements.npz}"]
    )
    layout: Layout = Field(
        description="where things are, and how far apart", examples=["{places: {bench: [4 m, 1 m]}}"]
    )
    tasks: dict[Name, Task] = Field(
        min_length=1, description="pieces of work, and how long they take", examples=["{label: {fixed: 20 s}}"]
    )
    stations: dict[Name, Station] = Field(
        min_length=1, description="where tasks are done", examples=["{pack: {at: bench, tasks: [label]}}"]
    )
    stores: dict[Name, Store] = Field(
        {},
        description="where products wait until they are taken as parts, by name",
        examples=["{wheels: {at: rack, capacity: 20}}"],
    )
    conveyors: dict[Name, Conveyor] = Field(
        {},
        description="belts, steps of routes like stations",
        examples=["{belt: {from: press, to: pack, speed: 0.2 m/s, pitch: 0.5 m}}"],
    )
    transporters: dict[Name, Transporter] = Field(
        {},
        description="vehicles that bring jobs from station to station",
        examples=["{forklift: {at: dock, speed: 2 m/s, legs: [[drill, paint]]}}"],
    )
    products: dict[Name, Product] = Field(
        min_length=1, description="what is made, and its way", examples=["{carton: {route: [pack]}}"]
    )
    release: Release | None = Field(None, description="how jobs come in", examples=["{kind: poisson, every: 55 s}"])
    sources: dict[Name, Release] = Field(
        {},
        description="several ways in which jobs come in, by name, instead of one release",
        examples=["{calls: {kind: poisson, every: 55 s, products: [a]}}"],
    )
    cards: dict[Name, Card] = Field(
        {}, description="loops of cards (CONWIP, kanban, POLCA) by name", examples=["{conwip: {n: 8}}"]
    )
    tools: dict[Name, Tool] = Field(
        {},
        description="tools and fixtures that stations and tasks share, by name; one that is given back goes to the job "
        "of the highest priority, of these to the one that has waited longest for it, else as workers are sent, "
        "where all the tools it wants are there, and somebody who takes them",
        examples=["{torque_gun: {n: 2}}"],
    )
    repair_teams: dict[Name, RepairTeam] = Field(
        {}, description="teams that repair and maintain stations, by name", examples=["{mechanics: {n: 1}}"]
    )
    shifts: dict[Name, Shift] = Field(
        {},
        description="hours of the week, by name, for workers, stations and sources",
        examples=["{early: {from: '06:00', to: '14:00', breaks: {lunch: {at: '10:00', lasts: 30 min}}}}"],
    )
    skill_levels: SkillLevels = Field(
        {},
        description="skills by name, for those of workers: a pace, or pace and quality",
        examples=["{learner: {pace: 0.8, quality: 0.95}, expert: 1.15}"],
    )
    workforce: Workforce | None = Field(None, description="workers drawn beside the named ones", examples=["{n: 12}"])
    workers: dict[Name, Worker] = Field(
        {}, description="the people who work here", examples=["{ana: {skills: {pack: 1.0}}}"]
    )
    rotations: dict[Name, Rotation] = Field(
        {},
        description="people who change posts, by name",
        examples=["{packers: {workers: [ana, ben], posts: [pack, label], every: 2 h}}"],
    )
    crews: dict[Name, Crew] = Field(
        {},
        description="people who share a line by a rule of their own, by name",
        examples=["{line: {kind: bucket_brigade, stations: [a, b, c], workers: [slow, fast]}}"],
    )
    walking: Walking | None = Field(
        None, description="how people walk between places", examples=["{emulator: walking/walk}"]
    )
    lines: dict[Name, Line] = Field(
        {},
        description="paced lines: consecutive stations of a route whose jobs move together, by name",
        examples=["{final: {kind: indexed, stations: [door, seat, wheel], takt: 60 s}}"],
    )
    flow: Flow = Field(Flow.model_validate({}), description="the rules by which jobs go on, of all stations")
    allocation: Allocation = Field(Allocation.model_validate({}), description="the rules by which workers choose")
    ergonomics: Ergonomics = Field(
        default_factory=Ergonomics.model_construct,
        description="how postures are scored",
        examples=["{arm_reference: gravity}"],
    )
    human: Annotated[Human, BeforeValidator(_nothing)] = Field(
        default_factory=Human.model_construct,
        description="what becomes of people as they work: learning, fatigue, pace; every effect is off unless named",
        examples=["{learning: {model: wright, rate: 0.85}}"],
    )
    outputs: list[Annotated[str, BeforeValidator(_known_output)]] = Field(
        list(USUAL),
        description="the figures wanted, first those that matter most",
        examples=["[throughput_per_h, worker_states]"],
    )
    frontier: Frontier | None = Field(
        None,
        description="two figures over all variants, one against the other: a KPI, KPI/subject or KPI/subject/part",
        examples=["[throughput_per_h, trunk_beyond_60_min_per_h]"],
    )
    studies: Studies | None = Field(
        None, description="what is asked of it beside running it: opsim sweep, select, labour, layout"
    )

    def _repr_html_(self) -> str:
        from opsim.notebook import scenario_html

        return scenario_html(self)


BLOCKS: dict[str, type[Block]] = {
    "run": Run,
    "layout": Layout,
    "stations": Station,
    "stores": Store,
    "conveyors": Conveyor,
    "transporters": Transporter,
    "products": Product,
    "release": Release,
    "tools": Tool,
    "repair_teams": RepairTeam,
    "shifts": Shift,
    "lines": Line,
    "workforce": Workforce,
    "workers": Worker,
    "rotations": Rotation,
    "crews": Crew,
    "walking": Walking,
    "flow": Flow,
    "allocation": Allocation,
    "ergonomics": Ergonomics,
    "human": Human,
}


@dataclass(frozen=True)
class Loaded:
    """One variant of a scenario file, ready to plan.

    given    : the dotted paths that stand in the file (after ``like`` and overrides), e.g. "workers.ana.walk"
    resolved : the variant as plain values, quantities still as text, for scenario.resolved.yaml
    """

    scenario: Scenario
    variant: str
    file: Path
    folder: Path
    given: frozenset[str]
    resolved: dict[str, Any]

    def _repr_html_(self) -> str:
        from opsim.notebook import scenario_html

        return scenario_html(self.scenario, self.variant)
