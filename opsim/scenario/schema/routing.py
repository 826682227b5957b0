"""Routing by probability: where a job goes from each station; ``out`` is the way out."""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import BeforeValidator, WithJsonSchema

from opsim.problems import shown
from opsim.scenario.fields import plain_error, summing_to_1

START, OUT = "start", "out"
_PER_CENT = re.compile(r"\s*([0-9]{1,3}(?:\.[0-9]{1,9})?)\s*(?:%|percent|per cent)\s*")
_FRACTION = re.compile(r"\s*([0-9]{1,9})\s*/\s*([1-9][0-9]{0,8})\s*")


def _probability(value: object) -> float:
    fraction = _FRACTION.fullmatch(value) if isinstance(value, str) else None
    if fraction is not None:
        value = int(fraction[1]) / int(fraction[2])
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise plain_error(f"expected a probability, found {shown(value)}", _of_per_cent(value))
    if not 0 <= value <= 1:
        raise plain_error(f"a probability lies between 0 and 1, found {shown(value)}", _as_share(value))
    return float(value)


def _of_per_cent(value: object) -> str:
    """How ``5 %`` is written, or an example."""
    match = _PER_CENT.fullmatch(value) if isinstance(value, str) else None
    return f"write {float(match[1]) / 100:g}" if match and float(match[1]) <= 100 else "such as 0.3 or 1/3"


def _as_share(value: float) -> str:
    """What was probably meant: per cent, or an example."""
    return f"if it is per cent, write {value / 100:g}" if 1.5 < value <= 100 else "such as 0.3 or 1/3"


def _sure(value: object) -> object:
    """A station's name alone is where every job goes."""
    if isinstance(value, str):
        return {value: 1.0}
    if not isinstance(value, dict) or not value:
        found = f"expected a station, or stations with probabilities, found {shown(value)}"
        raise plain_error(found, "such as {drill: 0.9, out: 0.1}")
    return value


Probability = Annotated[
    float,
    BeforeValidator(_probability),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "number", "minimum": 0, "maximum": 1},
                {"type": "string", "pattern": r"^\s*[0-9]+\s*/\s*[1-9][0-9]*\s*$"},
            ],
            "description": "a probability, such as 0.3 or 1/3",
        }
    ),
]
Onward = Annotated[dict[str, Probability], BeforeValidator(_sure), summing_to_1("probabilities")]
