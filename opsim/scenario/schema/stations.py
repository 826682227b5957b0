"""What comes together and apart: stores, the parts of a product, what a product is split into, batches on a server.

Stations and products.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from opsim.problems import shown
from opsim.scenario.fields import MostLoad, Name, NameText, Seconds, Whole, plain_error
from opsim.scenario.schema.lines import Blocking, Setup, Share
from opsim.scenario.schema.routing import Inspect, LessThanAll, Onward, Yield, one_word_on_scrap
from opsim.scenario.schema.run import ShiftNames
from opsim.scenario.schema.tasks import Breakdown, Maintenance
from opsim.scenario.schema.tools import Needs
from opsim.scenario.tree import Block

MOST_PIECES = 10_000
"""Pieces of one part in a product, units in a lot, jobs in a batch."""
MOST_INITIAL = 100_000
"""Jobs that may lie in a store at the start."""
MOST_PLACES = 1_000_000_000
ONLY = ""
"""Stands in ``initial`` for the only product that ends in a store."""


def unlimited(value: object) -> object:
    """None for 'unlimited'; other text is refused."""
    if isinstance(value, str):
        if value != "unlimited":
            raise plain_error(f"expected a whole number or unlimited, found {shown(value)}")
        return None
    return value


def _capacity(value: object) -> object:
    found = unlimited(value)
    if isinstance(found, int) and not isinstance(found, bool) and not 1 <= found <= MOST_PLACES:
        raise plain_error(f"a store has from 1 to {MOST_PLACES:,} places, found {shown(value)}")
    return found


def _by_product(value: object) -> dict[str, int]:
    """Numbers by product; a number alone is of the only product."""
    by_product: dict = value if isinstance(value, dict) else {ONLY: value}
    for product, number in by_product.items():
        on = None if product == ONLY else product
        if isinstance(number, bool) or not isinstance(number, int):
            hint = "such as 4 or {wheel: 4}"
            raise plain_error(f"expected a whole number, or numbers by product, found {shown(number)}", hint, on=on)
        if not 0 <= number <= MOST_INITIAL:
            raise plain_error(f"must be from 0 to {MOST_INITIAL:,}, found {shown(number)}", on=on)
    return by_product


_PLACES = {"anyOf": [{"type": "integer", "minimum": 1, "maximum": MOST_PLACES}, {"const": "unlimited"}]}
Capacity = Annotated[Whole | None, BeforeValidator(_capacity), WithJsonSchema(_PLACES)]
_WHOLE = {"type": "integer", "minimum": 0, "maximum": MOST_INITIAL}
_INITIAL = {"anyOf": [_WHOLE, {"type": "object", "additionalProperties": _WHOLE}]}
Pieces = Annotated[Whole, Field(ge=1, le=MOST_PIECES)]
PiecesByStation = dict[NameText, dict[NameText, Pieces]]
Initial = Annotated[dict[str, int], BeforeValidator(_by_product), WithJsonSchema(_INITIAL)]


class Store(Block):
    """Where products wait until they are taken as parts: those whose route ends here, the oldest taken first."""

    at: NameText = Field(description="a place of the layout", examples=["rack"])
    capacity: Capacity | None = Field(
        None, description="jobs that fit, a lot is one; absent or 'unlimited': no limit", examples=["20"]
    )
    initial: Initial = Field(
        {},
        description="jobs that lie here at the start: a number, or numbers by product where several end here",
        examples=["4"],
    )


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
