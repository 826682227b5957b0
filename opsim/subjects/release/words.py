"""Which products a source makes: by shares, or in an order that is gone through again and again.

How jobs come in.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, WithJsonSchema, model_validator

from opsim.problems import shown
from opsim.scenario.fields import NameText, Probability, Seconds, Whole, plain_error, summing_to_1
from opsim.scenario.tree import Block
from opsim.subjects.shifts.words import ShiftNames
from opsim.subjects.tasks.kinds import Motions, Task
from opsim.subjects.tasks.words import Emulated, Plugged, TaskBlock

LONGEST_SEQUENCE = 100_000


def _equal(value: object) -> object:
    """Names alone have equal shares."""
    if isinstance(value, list):
        _check_names(value, "a list of products", "such as [a, b]")
        twice = [number for number, name in enumerate(value) if name in value[:number]]
        if twice:
            raise plain_error(f"{shown(value[twice[0]])} is named twice", "give shares: {a: 0.7, b: 0.3}", on=twice[0])
        return {name: 1 / len(value) for name in value}
    if not isinstance(value, dict) or not value:
        found = f"expected products, or products with their shares, found {shown(value)}"
        raise plain_error(found, "such as [a, b] or {a: 0.7, b: 0.3}")
    return value


def _order(value: object) -> object:
    if not isinstance(value, str):
        _check_names(value, "a list of products, or a CSV file", "such as [a, a, b] or mix.csv")
    return value


def _check_names(value: object, expected: str, example: str) -> None:
    if not isinstance(value, list) or not value:
        raise plain_error(f"expected {expected}, found {shown(value)}", example)
    if len(value) > LONGEST_SEQUENCE:
        raise plain_error(f"expected at most {LONGEST_SEQUENCE:,} names, found {len(value):,}")
    for number, name in enumerate(value):
        if not isinstance(name, str):
            raise plain_error(f"expected the name of a product, found {shown(name)}", on=number)


_NAMES = {"type": "array", "minItems": 1, "items": {"type": "string"}}
_SHARE = {"anyOf": [{"type": "number", "minimum": 0, "maximum": 1}, {"type": "string", "pattern": r"^\s*[0-9]+\s*/"}]}
Shares = Annotated[
    dict[str, Probability],
    BeforeValidator(_equal),
    summing_to_1("shares"),
    WithJsonSchema({"anyOf": [_NAMES, {"type": "object", "additionalProperties": _SHARE, "minProperties": 1}]}),
]
Sequence = Annotated[list[str] | str, BeforeValidator(_order), WithJsonSchema({"anyOf": [_NAMES, {"type": "string"}]})]
MOST_AT_ONCE = 100_000
"""Jobs that may come at one instant."""


def _gap_tag(value: object) -> str:
    return "<model>" if isinstance(value, dict | TaskBlock) else "<time>"


Gap = Annotated[Annotated[Seconds, Tag("<time>")] | Annotated[Task, Tag("<model>")], Discriminator(_gap_tag)]


class Release(Block):
    """How jobs come in: by time, by a list of orders, or when the floor can take or wants one."""

    kind: Literal["saturated", "poisson", "renewal", "schedule", "base_stock"] = Field(
        description="saturated: whenever the first buffer has room (and a card is free); poisson: at random; renewal: "
        "gaps as given, by a file too; schedule: by a CSV file of orders; base_stock: whenever the pieces in a store "
        "and on the way to it, less those that are waited for, are fewer than a level",
        examples=["poisson"],
    )
    every: Gap | None = Field(
        None,
        description="poisson: mean time between two arrivals; renewal: where that time comes from",
        examples=["55 s"],
    )
    at_once: Whole = Field(
        1, ge=1, le=MOST_AT_ONCE, description="so many jobs at each arrival (poisson, renewal)", examples=[5]
    )
    file: NameText | None = Field(
        None,
        description="schedule: a CSV file in the scenario's folder with the columns time (seconds, or h:mm:ss from the "
        "start of the run), product, and where wanted quantity, due (a time as well) and priority",
        examples=["orders.csv"],
    )
    store: NameText | None = Field(
        None,
        description="base_stock: the store that is filled; the job is of the product whose route ends there",
        examples=["wheels"],
    )
    level: Whole | None = Field(
        None, ge=0, le=1_000_000, description="base_stock: pieces of the product that are kept there", examples=[4]
    )
    products: Shares | None = Field(
        None,
        description="what it makes: names (in equal shares), or names with shares; else every product by its share",
        examples=["{a: 0.7, b: 0.3}"],
    )
    sequence: Sequence | None = Field(
        None,
        description="what it makes, in this order, again and again: a list, or a CSV file with a column product (and "
        "quantity)",
        examples=["[a, a, b]"],
    )
    when_full: Literal["wait", "lose"] = Field(
        "wait", description="what a job does that finds the first buffer full, or no card"
    )

    shift: ShiftNames | None = Field(
        None,
        description="the shift, or all shifts, in which jobs come in; gaps between arrivals count these hours alone, "
        "and an order of another hour comes when the next of them begins; absent: always",
        examples=["early", "[early, late]"],
    )

    @property
    def gap(self) -> TaskBlock | None:
        """Where the times between arrivals come from (renewal), as a time of a task; else None."""
        return self.every if isinstance(self.every, TaskBlock) else None

    @property
    def every_s(self) -> float | None:
        """Mean time between two arrivals; None where the kind has none, and where a file of times is to be read."""
        return getattr(self.every, "mean_s", None) if isinstance(self.every, TaskBlock) else self.every

    @model_validator(mode="after")
    def _says_what_its_kind_needs(self) -> Release:
        _check_keys(self)
        _check_every(self)
        if self.kind == "schedule" and self.file is None:
            raise plain_error("a schedule needs the file of its orders", "add e.g. 'file: orders.csv'")
        for key in ("store", "level") if self.kind == "base_stock" else ():
            if getattr(self, key) is None:
                found = f"a base_stock release needs its {key}"
                raise plain_error(found, "add e.g. " + ("'store: finished'" if key == "store" else "'level: 4'"))
        if self.products is not None and self.sequence is not None:
            raise plain_error("the products come from products and from sequence", "keep one of them", on="sequence")
        if self.kind == "base_stock" and self.products is not None and len(self.products) != 1:
            hint = "write a source for each product"
            raise plain_error("a base_stock release is of one product", hint, on="products")
        return self


_BY_TIME = {"every", "at_once", "products", "sequence", "when_full"}
_KEYS = {
    "saturated": {"products", "sequence"},
    "poisson": _BY_TIME,
    "renewal": _BY_TIME,
    "schedule": {"file", "products", "sequence", "when_full"},
    "base_stock": {"store", "level", "products"},
}


def _check_keys(release: Release) -> None:
    """Every key that is given means something with the kind."""
    if release.kind == "saturated" and release.every is not None:
        raise plain_error("a saturated release has no 'every': a job enters whenever there is room", on="every")
    if release.when_full == "lose" and "when_full" not in _KEYS[release.kind]:
        raise plain_error(f"a {release.kind} release loses nothing", "remove 'when_full'", on="when_full")
    beyond = release.model_fields_set - _KEYS[release.kind] - {"kind", "when_full", "shift"}
    if beyond:
        key = min(beyond)
        if getattr(release, key) is not None:
            raise plain_error(f"a {release.kind} release has no {key!r}", "remove it", on=key)


def _check_every(release: Release) -> None:
    kind, every, gap = release.kind, release.every, release.gap
    if kind == "poisson" and every is None:
        raise plain_error("a poisson release needs the mean time between two jobs", "add e.g. 'every: 55 s'")
    if kind == "poisson" and gap is not None:
        raise plain_error("a poisson release has exponential gaps", "write 'kind: renewal', or e.g. 55 s", on="every")
    if kind == "renewal" and gap is None:
        found = "a renewal release needs to know where the time between two jobs comes from"
        hint = "such as {fixed: 55 s} or {dist: erlang, mean: 55 s, k: 2}"
        raise plain_error(found, hint, on=None if every is None else "every")
    if isinstance(gap, Emulated | Motions | Plugged):
        raise plain_error("nobody moves between two jobs", "take fixed, recorded or dist", on="every")
    given = set() if gap is None else gap.model_fields_set & set(_NOT_OF_A_GAP)
    if given:
        raise plain_error(f"a gap between jobs has no {_NOT_OF_A_GAP[min(given)]!r}", "remove it", on="every")


_NOT_OF_A_GAP = {
    "load_kg": "load",
    "repeat": "repeat",
    "automatic": "automatic",
    "between_share": "between_share",
    "per": "per",
    "team": "team",
    "needs": "needs",
    "hold": "hold",
}
