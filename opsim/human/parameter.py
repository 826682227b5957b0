"""Parameters of human effects: what each means, its unit, its bounds, and the value at which the effect is none."""

from __future__ import annotations

from dataclasses import MISSING, Field, dataclass, field, fields
from math import inf, isnan
from typing import Any, ClassVar

_KEY = "parameter"


@dataclass(frozen=True, slots=True)
class Parameter:
    """One parameter of a model.

    unit     : "s", "kg", ..., "share" for 0..1, "times" for a count; "" for a plain number
    neutral  : the value at which, all neutral ones together, the model changes nothing; None: any value will do
    at_least, above, at_most, below : its bounds; ``endless``: whether it may be infinite
    required : whether it has no default
    words    : what it may be, where it is no number
    """

    name: str
    meaning: str
    unit: str
    default: Any
    neutral: float | None = None
    at_least: float = -inf
    above: float = -inf
    at_most: float = inf
    below: float = inf
    endless: bool = False
    required: bool = False
    words: tuple[str, ...] = ()

    @property
    def expected(self) -> str:
        """Its bounds in words: "a number above 0.5, at most 1"."""
        if self.words:
            return " or ".join(self.words)
        said = (("at least", self.at_least), ("above", self.above), ("at most", self.at_most), ("below", self.below))
        bounds = [f"{word} {bound:g}" for word, bound in said if abs(bound) != inf]
        return " ".join(["a number", ", ".join(bounds)]).strip()

    def takes(self, value: Any) -> bool:
        """Whether it may have a value."""
        if self.words:
            return value in self.words
        if isinstance(value, bool) or not isinstance(value, int | float) or isnan(value):
            return False
        if abs(value) == inf:
            return self.endless and value > 0
        return self.at_least <= value <= self.at_most and self.above < value < self.below


def parameter(
    default: float | str | None, meaning: str, *, unit: str = "", neutral: float | None = None, **bounds: Any
) -> Any:
    """A field of a frozen model; ``default`` None: it must be given. ``bounds`` are those of ``Parameter``."""
    told = {"meaning": meaning, "unit": unit, "neutral": neutral, **bounds}
    return field(metadata={_KEY: told}) if default is None else field(default=default, metadata={_KEY: told})


def parameters_of(model: Any) -> tuple[Parameter, ...]:
    """The parameters of a model or its class, in the order of its fields."""
    return tuple(_parameter(one) for one in fields(model) if _KEY in one.metadata)


def neutral_of(model: type) -> Any:
    """A model at the values at which it changes nothing, defaults for the others."""
    return model(**{one.name: one.neutral for one in parameters_of(model) if one.neutral is not None})


def mistakes_of(model: Any) -> list[str]:
    """What is wrong with the values of a model, in words, one sentence a parameter."""
    values = [(one, getattr(model, one.name)) for one in parameters_of(model)]
    return [f"{one.name}: found {value!r}, expected {one.expected}" for one, value in values if not one.takes(value)]


class Checked:
    """A model that refuses parameters out of bounds with one ValueError that lists all of them.

    does : what it does, in a few words; source : who published it
    """

    __slots__ = ()
    does: ClassVar[str]
    source: ClassVar[str]

    def __post_init__(self) -> None:
        if mistakes := mistakes_of(self):
            raise ValueError("; ".join(mistakes))


def _parameter(one: Field) -> Parameter:
    missing = one.default is MISSING
    return Parameter(name=one.name, default=None if missing else one.default, required=missing, **one.metadata[_KEY])
