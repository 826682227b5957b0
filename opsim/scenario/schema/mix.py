"""Which products a source makes: by shares, or in an order that is gone through again and again."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, WithJsonSchema

from opsim.problems import shown
from opsim.scenario.fields import plain_error, summing_to_1
from opsim.scenario.schema.routing import Probability

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
