"""What a day has to reach, as it is written: ``480 a day``, or ``throughput_per_h >= 60``.

Apart from the figures themselves, so that reading a scenario needs no numpy.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from opsim.kpi.better import Asked, read_asked
from opsim.kpi.names import KPIS
from opsim.problems import did_you_mean, shown

_NUMBER = r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"
_A_DAY = re.compile(rf"\s*{_NUMBER}\s*(?:jobs|units|pieces)?\s*(?:a|per|/)\s*day\s*", re.IGNORECASE)
_COMPARED = re.compile(rf"\s*(\S(?:.*\S)?)\s*(>=|<=)\s*{_NUMBER}\s*")
SUCH = "such as 'throughput_per_h >= 60', or '480 a day'"


@dataclass(frozen=True, slots=True)
class Target:
    """A bound of one figure. ``kpi`` is "" where it is the good units of a day; ``at_least``: else at most."""

    asked: Asked
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
        return Target(Asked(""), float(found[1]))
    found = _COMPARED.fullmatch(text)
    if found is None:
        raise ValueError(f"no target: {shown(text)}; write it {SUCH}")
    asked = read_asked(found[1])
    if asked.kpi not in KPIS:
        raise ValueError(f"unknown figure {shown(asked.kpi)}; {did_you_mean(asked.kpi, KPIS)}")
    return Target(asked, float(found[3]), found[2] == ">=")
