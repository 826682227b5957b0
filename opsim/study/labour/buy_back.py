"""What buys back what differences between people cost: gained by each step, and the first that is enough."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.study.interval import CONFIDENCE, Interval
from opsim.study.labour.budget import difference_interval, table_interval
from opsim.study.labour.parts import CROSSED


@dataclass(frozen=True, slots=True)
class Step:
    """So many more: what that gains, and what is then left over (more than 0) or missing, in pairs.

    gained : against the people as they are; beyond : against the same people without differences between them
    sure   : the interval of ``beyond`` with all steps of all ways held together (Bonferroni), since the best of many
             steps is partly lucky; None where this is the only one
    """

    count: int
    gained: Interval
    beyond: Interval
    sure: Interval | None = None

    @property
    def enough(self) -> bool:
        """Whether the mean reaches the rate without the loss."""
        return self.beyond.mean >= 0

    @property
    def surely(self) -> bool:
        """Whether the interval does, with all steps that were tried held together."""
        return (self.sure or self.beyond).low >= 0


@dataclass(frozen=True, slots=True)
class Curve:
    """One way to buy the loss back, step by step."""

    name: str
    kind: str
    steps: tuple[Step, ...]

    @property
    def first(self) -> Step | None:
        """The first step whose mean is enough."""
        return next((step for step in self.steps if step.enough), None)


@dataclass(frozen=True, slots=True)
class BoughtBack:
    """loss : of throughput by differences between people, equal : throughput without them; curves : way by way."""

    loss: Interval
    equal: Interval
    curves: tuple[Curve, ...]

    def best(self, kind: str) -> Curve | None:
        """Of a kind the curve that is enough first, then the one that gains most; None where there is none."""
        of = [curve for curve in self.curves if curve.kind == kind]
        return min(of, key=_rank, default=None)


def _rank(curve: Curve) -> tuple[float, float]:
    first = curve.first
    last = curve.steps[-1] if first is None else first
    return (np.inf if first is None else float(first.count)), -last.gained.mean


def curve_of(
    name: str,
    kind: str,
    steps: Sequence[tuple[int, np.ndarray]],
    full: np.ndarray,
    equal: np.ndarray,
    design: str = CROSSED,
    tried: int | None = None,
) -> Curve:
    """steps : (how many more, (W, R) rates); full, equal : rates as they are, and without differences of people.

    tried : steps of all ways, held together; by default those of this one
    """
    crossed, together = design == CROSSED, 1 - (1 - CONFIDENCE) / (tried or len(steps))
    made = (
        Step(
            n,
            difference_interval(table - full, full, crossed),
            difference_interval(table - equal, full, crossed),
            difference_interval(table - equal, full, crossed, together),
        )
        for n, table in steps
    )
    return Curve(name, kind, tuple(made))


def bought_back(full: np.ndarray, equal: np.ndarray, curves: Sequence[Curve], design: str = CROSSED) -> BoughtBack:
    """full, equal : (W, R) rates as they are, and without differences between people."""
    crossed = design == CROSSED
    return BoughtBack(difference_interval(equal - full, full, crossed), table_interval(equal, crossed), tuple(curves))
