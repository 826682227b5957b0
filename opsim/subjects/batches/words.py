"""What a scenario may say of batches, and what that is in numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Literal

from pydantic import Field

from opsim.clock import on_grid
from opsim.problems import natural_key
from opsim.scenario.fields import MOST_PIECES, Seconds, Whole
from opsim.scenario.tree import Block


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


@dataclass(frozen=True, slots=True)
class BatchPlan:
    """size : jobs on a server at once

    most_wait_s : after which a job goes with those there are, on the grid; inf for never
    class_of : (P,) jobs go together whose products have the same number
    """

    station: int
    size: int
    most_wait_s: float
    class_of: tuple[int, ...]


def plan_batches(
    said: Mapping[str, Batch], families: Mapping[str, str | None], stations: Mapping[str, int]
) -> tuple[BatchPlan, ...]:
    """All batches in natural order of their stations; families : of all products, by rank; stations : their ranks."""
    return tuple(_batch(stations[name], said[name], families) for name in sorted(said, key=natural_key))


def _batch(station: int, batch: Batch, families: Mapping[str, str | None]) -> BatchPlan:
    classes = [_class(batch.of, product, family) for product, family in families.items()]
    number = {one: number for number, one in enumerate(dict.fromkeys(classes))}
    most_wait_s = inf if batch.most_wait_s is None else batch.most_wait_s and on_grid(batch.most_wait_s)
    return BatchPlan(station, batch.size, most_wait_s, tuple(number[one] for one in classes))


def _class(of: str, product: str, family: str | None) -> str:
    """What goes together has the same word: all, a product, or a family (a product without one is by itself)."""
    if of == "family":
        return product if family is None else f"family: {family}"
    return product if of == "product" else ""
