"""What a scenario may say: one frozen model a block. The YAML key is the alias; the attribute carries the SI unit."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag, model_validator

from opsim.kpi.names import KPIS
from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import (
    Height,
    Length,
    Load,
    Mass,
    Name,
    NameText,
    Seconds,
    SecondsOrZero,
    Speed,
    Whole,
    plain_error,
)

DAYS = ("Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun")
_DAY_WORDS = {*DAYS, "Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday"}


class Block(BaseModel):
    """The common ground of all blocks: nothing changes after reading, no unknown key, no silent conversion."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


# ---------------------------------------------------------------------------------------------------------------- run
def _day_and_time(value: object) -> object:
    match = re.fullmatch(r"\s*([A-Za-z]+)\s+([0-9]{1,2}):([0-9]{2})\s*", value) if isinstance(value, str) else None
    if match is None or match[1].title() not in _DAY_WORDS or int(match[2]) > 23 or int(match[3]) > 59:
        raise plain_error(f"expected a weekday and a time, found {shown(value)}", "such as 'Mon 06:00'")
    return f"{match[1][:3].title()} {int(match[2]):02d}:{match[3]}"


class Run(Block):
    """How long is simulated, how often, and with which luck."""

    start: Annotated[str, BeforeValidator(_day_and_time)] = Field("Mon 06:00", description="weekday and time at t = 0")
    horizon_s: Seconds = Field(alias="horizon", description="simulated time, end not included", examples=["8 h"])
    warm_up_s: SecondsOrZero = Field(0.0, alias="warm_up", description="time at the start that does not count")
    replications: Whole = Field(10, ge=1, le=1_000_000)
    seed: Whole = Field(0, ge=0, lt=2**63)

    @property
    def start_s(self) -> float:
        """Seconds from Monday 00:00 to the start."""
        day, clock = self.start.split()
        hours, minutes = clock.split(":")
        return DAYS.index(day) * 86400.0 + int(hours) * 3600.0 + int(minutes) * 60.0

    @model_validator(mode="after")
    def _warm_up_ends(self) -> Run:
        if self.warm_up_s >= self.horizon_s:
            raise plain_error(
                f"the warm-up ({self.warm_up_s:g} s) must end before the horizon ({self.horizon_s:g} s)", on="warm_up"
            )
        return self


# ------------------------------------------------------------------------------------------------------------- layout
def _two_lengths(value: object) -> object:
    if not isinstance(value, list) or len(value) != 2:
        raise plain_error(f"expected a place as two lengths, found {shown(value)}", "such as [4 m, 1 m]")
    return tuple(value)


class Layout(Block):
    """Where things are, and how a way between two places is measured."""

    distance: Literal["euclidean", "rectilinear"] = "rectilinear"
    places: dict[Name, Annotated[tuple[Length, Length], BeforeValidator(_two_lengths)]] = Field(
        description="x and y of each place", examples=["{bench: [4 m, 1 m]}"]
    )


# -------------------------------------------------------------------------------------------------------------- tasks
class TaskBlock(Block):
    """What every task may say."""

    load_kg: Load | None = Field(None, alias="load", description="mass in the hands")
    repeat: Whole = Field(1, ge=1, le=10_000, description="how often it is done, each with a draw of its own")
    automatic: bool = Field(False, description="true: the station does it alone, no worker")


class Emulated(TaskBlock):
    """Duration and posture from a motion emulator: ``emulator: library/task``."""

    emulator: str = Field(examples=["moves/deep_squat"])

    @property
    def library(self) -> str:
        return self.emulator.partition("/")[0]

    @property
    def library_task(self) -> str:
        return self.emulator.partition("/")[2]


class Fixed(TaskBlock):
    """Always this long."""

    fixed_s: Seconds = Field(alias="fixed", examples=["20 s"])


class Recorded(TaskBlock):
    """Durations in seconds from a column of a CSV file, drawn again (resample) or replayed in order (trace)."""

    recorded: str = Field(examples=["times.csv"])
    column: str | None = None
    by: Literal["resample", "trace"] = "resample"


_CV = Field(gt=0, le=10, description="standard deviation / mean", examples=[0.25])


class Exponential(TaskBlock):
    """Memoryless: standard deviation equal to the mean."""

    dist: Literal["exponential"]
    mean_s: Seconds = Field(alias="mean", examples=["20 s"])


class Lognormal(TaskBlock):
    """Lognormal, with a share of the variance of log time between workers."""

    dist: Literal["lognormal"]
    mean_s: Seconds = Field(alias="mean", examples=["20 s"])
    cv: float = _CV
    between_share: float = Field(0.0, ge=0, le=1, description="share of the variance of log time between workers")


class Gamma(TaskBlock):
    """Gamma, by its mean and cv."""

    dist: Literal["gamma"]
    mean_s: Seconds = Field(alias="mean", examples=["20 s"])
    cv: float = _CV


class Uniform(TaskBlock):
    """Anything from low to high, equally likely."""

    dist: Literal["uniform"]
    low_s: Seconds = Field(alias="low", examples=["15 s"])
    high_s: Seconds = Field(alias="high", examples=["25 s"])

    @model_validator(mode="after")
    def _low_below_high(self) -> Uniform:
        if self.low_s >= self.high_s:
            raise plain_error(f"low ({self.low_s:g} s) must be less than high ({self.high_s:g} s)", on="low")
        return self


DISTRIBUTIONS: dict[str, type[TaskBlock]] = {
    "exponential": Exponential,
    "lognormal": Lognormal,
    "gamma": Gamma,
    "uniform": Uniform,
}
TASK_KINDS: dict[str, type[TaskBlock]] = {
    "<emulator>": Emulated,
    "<fixed>": Fixed,
    "<recorded>": Recorded,
    **{f"<{name}>": model for name, model in DISTRIBUTIONS.items()},
}
_KIND_KEYS = ("emulator", "fixed", "recorded", "dist")


def _one_kind(value: object) -> object:
    """A task says in exactly one way where its time comes from."""
    if not isinstance(value, dict):
        raise plain_error(f"expected a block of keys, found {shown(value)}", "such as {fixed: 20 s}")
    kinds = [key for key in _KIND_KEYS if key in value]
    if not kinds:
        near = next((hint for key in value if (hint := did_you_mean(key, _KIND_KEYS)).startswith("did")), "")
        raise plain_error(
            "nothing says how long this task takes", near or "add one of: emulator, fixed, recorded, dist"
        )
    if len(kinds) > 1:
        raise plain_error(f"the time comes from {kinds[0]} and from {kinds[1]}", "keep one of them", on=kinds[1])
    if kinds == ["dist"] and value["dist"] not in list(DISTRIBUTIONS):
        hint = did_you_mean(value["dist"], DISTRIBUTIONS)
        raise plain_error(f"unknown distribution {shown(value['dist'])}", hint, on="dist")
    return value


def _kind_tag(value: Any) -> str:
    kind = next(key for key in _KIND_KEYS if key in value)
    return f"<{value['dist']}>" if kind == "dist" else f"<{kind}>"


Task = Annotated[
    Annotated[Emulated, Tag("<emulator>")]
    | Annotated[Fixed, Tag("<fixed>")]
    | Annotated[Recorded, Tag("<recorded>")]
    | Annotated[Exponential, Tag("<exponential>")]
    | Annotated[Lognormal, Tag("<lognormal>")]
    | Annotated[Gamma, Tag("<gamma>")]
    | Annotated[Uniform, Tag("<uniform>")],
    Discriminator(_kind_tag),
    BeforeValidator(_one_kind),
]


# ----------------------------------------------------------------------------------------------- stations and material
def _unlimited(value: object) -> object:
    if isinstance(value, str):
        if value != "unlimited":
            raise plain_error(f"expected a whole number or unlimited, found {shown(value)}")
        return None
    return value


class Station(Block):
    """A place with servers and a buffer in front, where tasks are done in order."""

    at: NameText = Field(description="a place of the layout", examples=["bench"])
    tasks: list[NameText] = Field(min_length=1, examples=["[label]"])
    servers: Whole = Field(1, ge=1, le=100_000)
    buffer: Annotated[Whole | None, BeforeValidator(_unlimited)] = Field(
        None, ge=0, description="jobs that can wait in front; absent or 'unlimited': no limit"
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
    """What is made: its share of the jobs and its way through the stations."""

    share: float = Field(1.0, gt=0, le=1)
    route: Annotated[list[str | list[str]], BeforeValidator(_steps)] = Field(examples=["[unload, repack]"])


class Release(Block):
    """How jobs come in."""

    kind: Literal["saturated", "poisson"] = Field(examples=["poisson"])
    every_s: Seconds | None = Field(None, alias="every", description="mean time between two jobs (poisson)")
    when_full: Literal["wait", "lose"] = Field("wait", description="what a job does that finds the first buffer full")

    @model_validator(mode="after")
    def _every_where_it_means_something(self) -> Release:
        if self.kind == "poisson" and self.every_s is None:
            raise plain_error("a poisson release needs the mean time between two jobs", "add e.g. 'every: 55 s'")
        if self.kind == "saturated" and self.every_s is not None:
            raise plain_error("a saturated release has no 'every': a job enters whenever there is room", on="every")
        if self.kind == "saturated" and self.when_full == "lose":
            raise plain_error("a saturated release loses nothing", "remove 'when_full'", on="when_full")
        return self


# ------------------------------------------------------------------------------------------------------------- workers
class Worker(Block):
    """A person: body, walking speed, skills. A skill is a rating; 1.1 means the duration divided by 1.1."""

    height_m: Height | None = Field(None, alias="height")
    mass_kg: Mass | None = Field(None, alias="mass")
    walk_m_per_s: Speed = Field(1.2, alias="walk")
    skills: dict[str, Annotated[float, Field(gt=0, le=10)]] = Field({}, description="rating by station")
    home: NameText | None = Field(None, description="a place of the layout")


class Allocation(Block):
    """The rules by which workers choose."""

    rule: Literal["longest_queue", "nearest", "oldest_job"] = "longest_queue"
    idle: Literal["stay"] = "stay"
    when_blocked: Literal["free", "held"] = "free"


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
    name: str = Field(examples=["Repacking cell"])
    run: Run = Field(examples=["{horizon: 8 h}"])
    libraries: dict[Name, str] = Field({}, description="motion libraries by the name tasks use")
    layout: Layout = Field(examples=["{places: {bench: [4 m, 1 m]}}"])
    tasks: dict[Name, Task] = Field(min_length=1, examples=["{label: {fixed: 20 s}}"])
    stations: dict[Name, Station] = Field(min_length=1, examples=["{pack: {at: bench, tasks: [label]}}"])
    products: dict[Name, Product] = Field(min_length=1, examples=["{carton: {route: [pack]}}"])
    release: Release = Field(examples=["{kind: poisson, every: 55 s}"])
    workers: dict[Name, Worker] = {}
    allocation: Allocation = Field(default_factory=Allocation)
    outputs: list[Annotated[str, BeforeValidator(_known_output)]] = list(KPIS)


BLOCKS: dict[str, type[Block]] = {
    "run": Run,
    "layout": Layout,
    "stations": Station,
    "products": Product,
    "release": Release,
    "workers": Worker,
    "allocation": Allocation,
}
