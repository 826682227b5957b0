"""Amounts of a figure as people write them, ``2``, ``20 s``, ``1 %``, and limits: ``rula_mean <= 4 +- 0.1``.

Apart from the figures themselves, so that reading a scenario needs no numpy.

What a day has to reach, as it is written: ``480 a day``, or ``throughput_per_h >= 60``.

Apart from the figures themselves, so that reading a scenario needs no numpy.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from opsim import units
from opsim.kpi.catalogue import KPIS, AskedFigure, read_asked
from opsim.problems import did_you_mean, shown

AT_MOST, AT_LEAST = "<=", ">="
USUAL_TOLERANCE = 0.02
"""Of a limit's bound, where nobody says another."""
SUCH = "such as 'rula_from_5_min_per_h/worst <= 10'"
_ENDINGS = (
    *(("_min_per_h", "min/h"), ("_kcal_per_min", "kcal/min"), ("_per_min", "1/min"), ("_per_calendar_h", "1/h")),
    *(("_per_h", "1/h"), ("_share", "share"), ("_states", "share"), ("_h", "h"), ("_s", "s"), ("_m", "m")),
)
_KINDS = {"s": "time", "h": "time", "m": "length", "kg": "mass"}
_WORDS = {
    "1/h": ("1/h", "/h", "per h", "per hour", "an hour", "a hour", "jobs/h"),
    "min/h": ("min/h", "min per h", "min per hour", "min an hour", "minutes per hour", "minutes an hour"),
    "1/min": ("1/min", "/min", "per min", "per minute", "a minute"),
    "deg": ("deg", "\u00b0", "degrees"),
}
_SAID = {"1/h": "per hour", "1/min": "per minute", "min/h": "in minutes per hour"}
_NUMBER = re.compile(r"\s*([-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_LIMIT = re.compile(r"\s*(\S(?:.*?\S)?)\s*(<=|>=)\s*(\S.*?)\s*(?:(?:\+-|\+/-|\u00b1)\s*(\S.*?)\s*)?")


@dataclass(frozen=True, slots=True)
class LimitText:
    """A limit as it is written; ``tolerance`` is "" where none is."""

    asked: AskedFigure
    sense: str
    bound: str
    tolerance: str = ""


def unit_of(kpi: str) -> str:
    """The unit in which a figure is kept, as far as its name says; "" where it does not."""
    if kpi in ("worker_states", "station_states", "transporter_states"):
        return "share"
    return next((unit for ending, unit in _ENDINGS if kpi.endswith(ending)), "")


def amount(said: str | float, unit: str, figure: str) -> float:
    """A number in a figure's unit. Raises ValueError in words: no number, a wrong unit, or none where one belongs."""
    if isinstance(said, bool) or not isinstance(said, int | float | str):
        raise ValueError(f"expected a number, found {shown(said)}")
    kind = _KINDS.get(unit)
    if kind is not None:
        return units.parse(f"{said:g}" if isinstance(said, int | float) else said, kind) / _size(unit, kind)
    match = _NUMBER.fullmatch(str(said))
    number = float(match[1]) if match else math.nan
    if match is None or not math.isfinite(number):
        raise ValueError(f"expected a number, found {shown(said)}")
    if unit == "share" and match[2] == "%":
        return number / 100
    if match[2] and match[2].casefold() not in _WORDS.get(unit, (unit,)):
        raise ValueError(f"{shown(said)}: {figure} {_written(unit, match[1])}")
    return number


def percent(said: str | float, unit: str) -> float | None:
    """The share that ``1 %`` is of the base; None where an amount is no per cent, or is one of a figure in per cent."""
    match = _NUMBER.fullmatch(said) if isinstance(said, str) else None
    return float(match[1]) / 100 if match and match[2] == "%" and unit != "share" else None


def read_limit(text: str) -> LimitText:
    """``rula_from_5_min_per_h/worst <= 10 +- 0.5``. Raises ValueError: what is wrong; the way out."""
    match = _LIMIT.fullmatch(text)
    if match is None:
        raise ValueError(f"no limit: {shown(text)}; write a figure, <= or >=, and a number, {SUCH}")
    asked = read_asked(match[1])
    if asked.kpi not in KPIS:
        raise ValueError(f"unknown figure {shown(asked.kpi)}; {did_you_mean(asked.kpi, KPIS)}")
    limit = LimitText(asked, match[2], match[3], match[4] or "")
    bounds(limit, unit_of(asked.kpi))
    return limit


def bounds(limit: LimitText, unit: str) -> tuple[float, float]:
    """(bound, tolerance) in a figure's unit. Raises ValueError where one is no amount of it, or the tolerance is 0."""
    name = limit.asked.name
    if percent(limit.bound, unit) is not None and unit:
        raise ValueError(f"{name} {limit.sense} {limit.bound}: per cent of what? write a number")
    bound = amount(limit.bound, unit, name)
    if not limit.tolerance and bound == 0:
        raise ValueError(f"{name} {limit.sense} 0: how near is near enough? write '{limit.sense} 0 +- 0.1', say")
    share = percent(limit.tolerance, unit) if limit.tolerance else USUAL_TOLERANCE
    tolerance = abs(bound) * share if share is not None else amount(limit.tolerance, unit, name)
    if not tolerance > 0:
        raise ValueError(f"{name}: a tolerance is more than 0, found {limit.tolerance}")
    return bound, tolerance


def check_indifference(said: str | float, kpi: str) -> None:
    """Raises ValueError where an indifference is no amount above 0 of a figure, nor some per cent."""
    unit = unit_of(kpi)
    share = percent(said, unit)
    value = share if share is not None else amount(said, unit, kpi)
    if not value > 0:
        hint = "it is a difference too small to matter, such as 2, or '1 %' of the base"
        raise ValueError(f"expected more than 0, found {shown(said)}; {hint}")


def _size(unit: str, kind: str) -> float:
    return float(units.UNITS[kind][unit])


def _written(unit: str, number: str) -> str:
    """How a number of a unit is written."""
    if unit == "share":
        return "is a share: write 0.05 or '5 %'"
    if unit in ("", "1"):
        return f"has another unit, or none: write {number}"
    return f"is {_SAID.get(unit, f'in {unit}')}: write {number}"


_DECIMAL = r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"
_A_DAY = re.compile(rf"\s*{_DECIMAL}\s*(?:jobs|units|pieces)?\s*(?:a|per|/)\s*day\s*", re.IGNORECASE)
_COMPARED = re.compile(rf"\s*(\S(?:.*\S)?)\s*(>=|<=)\s*{_DECIMAL}\s*")
SUCH_A_TARGET = "such as 'throughput_per_h >= 60', or '480 a day'"


@dataclass(frozen=True, slots=True)
class Target:
    """A bound of one figure. ``kpi`` is "" where it is the good units of a day; ``at_least``: else at most."""

    asked: AskedFigure
    bound: float
    at_least: bool = True

    @property
    def a_day(self) -> bool:
        """Whether units of a day are meant."""
        return not self.asked.kpi

    @property
    def words(self) -> str:
        """As it could be written."""
        if self.a_day:
            return f"{self.bound:g} a day"
        return f"{self.asked.name} {'>=' if self.at_least else '<='} {self.bound:g}"


def read_target(text: str) -> Target:
    """Read a target. Raises ValueError: what is wrong; the nearest right word, or how it is written."""
    if found := _A_DAY.fullmatch(text):
        return Target(AskedFigure(""), float(found[1]))
    found = _COMPARED.fullmatch(text)
    if found is None:
        raise ValueError(f"expected a target, found {shown(text)}; write it {SUCH_A_TARGET}")
    asked = read_asked(found[1])
    if asked.kpi not in KPIS:
        raise ValueError(f"unknown figure {shown(asked.kpi)}; {did_you_mean(asked.kpi, KPIS)}")
    return Target(asked, float(found[3]), found[2] == ">=")
