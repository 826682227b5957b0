"""As many replications as a figure needs to be known within some per cent of its mean."""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from opsim.kpi.names import KPIS, needs_postures
from opsim.problems import did_you_mean, shown
from opsim.study.interval import Interval, t_interval
from opsim.study.replicated import Replicated

FEWEST = 10
"""Replications before the rule is asked at all: fewer give a half-width that is itself too uncertain."""
MOST = 1000


class NoSuchFigure(ValueError):
    """A precision is wanted of a figure that the run does not have."""


@dataclass(frozen=True, slots=True)
class Precision:
    """A figure and the half-width of its interval as a share of the mean that is wanted."""

    kpi: str
    subject: str
    part: str
    relative: float

    @property
    def name(self) -> str:
        return "/".join(filter(None, (self.kpi, self.subject, self.part)))

    def values(self, done: Sequence[Replicated]) -> list[float]:
        """The figure in each replication. Raises NoSuchFigure."""
        key = (self.kpi, self.subject, self.part)
        found = [figure.value for one in done for figure in one.figures if figure[:3] == key]
        if done and not found:
            raise NoSuchFigure(f"precision: no figure {shown(self.name)}; {self._instead(done[0])}")
        return found

    def _instead(self, one: Replicated) -> str:
        """What there is, where the figure is not."""
        if needs_postures([self.kpi]) and self.kpi not in {figure.kpi for figure in one.figures}:
            return "it is made from postures, and nobody looks at them ('posture: off'), or nobody works"
        return did_you_mean(self.name, ["/".join(filter(None, figure[:3])) for figure in one.figures])


@dataclass(frozen=True, slots=True)
class Reached:
    """What became of a Precision: the relative half-width after ``n`` replications."""

    precision: Precision
    n: int
    found: float
    reached: bool

    @property
    def words(self) -> str:
        known = f"{self.precision.name} is known within {100 * self.found:.2g} % of its mean"
        return f"{known} (wanted: {100 * self.precision.relative:.2g} %)" + ("" if self.reached else ", not reached")


def read_precision(text: str) -> Precision:
    """``throughput_per_h=1%`` or ``worker_states/ana/work=2 %``. Raises ValueError with what was expected."""
    match = re.fullmatch(r"\s*([^=/]+)(?:/([^=/]*))?(?:/([^=/]*))?\s*=\s*([0-9.]+)\s*%\s*", text)
    percent = _number(match[4]) if match else None
    if match is None or percent is None or not 0 < percent < 100:
        raise ValueError(f"precision: expected FIGURE=PER CENT, such as throughput_per_h=1%, found {shown(text)}")
    kpi = match[1].strip()
    if kpi not in KPIS:
        raise ValueError(f"precision: no figure {shown(kpi)}; {did_you_mean(kpi, KPIS)}")
    return Precision(kpi, (match[2] or "").strip(), (match[3] or "").strip(), percent / 100)


def enough(intervals: Sequence[Interval], relatives: Sequence[float]) -> bool:
    """Whether every interval is narrow enough for the true mean to be within its share.

    Source: Law, Simulation Modeling and Analysis, 5th ed., section 9.4.1: half-width / |mean| <= share / (1 + share),
    as the mean itself is only estimated.
    """
    return all(_relative(i) <= relative / (1 + relative) for i, relative in zip(intervals, relatives))


def replicate_until(
    precisions: Sequence[Precision], most: int, run: Callable[[int, int], list[Replicated]]
) -> tuple[list[Replicated], list[Reached]]:
    """Replications 0 .. n-1, n the first number from 10 on that is enough for every precision, at most ``most``.

    run(first, n) gives replications first .. n-1. They come in batches, and n is found among them one by one, so that
    it does not depend on the batches or on the number of processes.
    """
    done = run(0, 1)
    for precision in precisions:
        precision.values(done)
    upto = min(FEWEST, most)
    checked, n = FEWEST - 1, None
    while n is None:
        done = done + run(len(done), upto)
        values = [precision.values(done) for precision in precisions]
        n = next((k for k in range(checked + 1, upto + 1) if _enough(precisions, values, k)), None)
        if n is None and upto >= most:
            n = most
        checked, upto = max(checked, upto), _next(precisions, values, upto, most)
    return done[:n], [_reached(precision, done[:n]) for precision in precisions]


def _enough(precisions: Sequence[Precision], values: Sequence[list[float]], n: int) -> bool:
    return enough([t_interval(of[:n]) for of in values], [precision.relative for precision in precisions])


def _next(precisions: Sequence[Precision], values: Sequence[list[float]], n: int, most: int) -> int:
    """How many will probably be needed, at most twice as many as there are."""
    ratios = [_relative(t_interval(of)) * (1 + p.relative) / p.relative for p, of in zip(precisions, values)]
    needed = n * max(ratios) ** 2
    return min(most, max(n + 1, 2 * n if not needed < 2 * n else math.ceil(needed)))


def _reached(precision: Precision, done: Sequence[Replicated]) -> Reached:
    interval = t_interval(precision.values(done))
    reached = len(done) >= FEWEST and enough([interval], [precision.relative])
    return Reached(precision, len(done), _relative(interval), reached)


def _relative(interval: Interval) -> float:
    """Half-width as a share of the mean; infinite where there is none, nothing where every value is the same."""
    if interval.n < 2:
        return math.inf
    if interval.half_width == 0:
        return 0.0
    return interval.half_width / abs(interval.mean) if interval.mean else math.inf


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
