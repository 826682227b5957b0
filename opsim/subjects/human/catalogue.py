"""Parameters of human effects: what each means, its unit, its bounds, and the value at which the effect is none.

Every human effect by name: its class, what it does, its source, its parameters with units, defaults, neutral values.

A scenario says ``human: {learning: {model: wright, rate: 0.85}}``; an effect of one model needs no ``model``.
Classes are imported when they are asked for.

The catalogue in words for people: parameters as a scenario writes them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING, Field, dataclass, field, fields
from importlib import import_module
from math import inf, isnan
from typing import Any, ClassVar

from opsim.clock import on_the_clock

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


_HOMES: dict[str, dict[str, str]] = {
    "learning": {
        "wright": "learning.Wright",
        "plateau": "learning.Plateau",
        "de_jong": "learning.DeJong",
        "stanford_b": "learning.StanfordB",
        "hyperbolic": "learning.Hyperbolic",
        "dual_phase": "learning.DualPhase",
    },
    "forgetting": {"lfcm": "forgetting.LearnForgetCurve"},
    "fatigue": {"lffrm": "fatigue.Lffrm", "3cc_r": "muscle_fatigue.ThreeCompartment"},
    "rest": {"by_need": "fatigue.RestByNeed"},
    "state_pace": {"schultz": "fatigue.Schultz"},
    "circadian": {"cosine": "fatigue.Circadian"},
    "errors": {"linear": "fatigue.ErrorsByFatigue"},
}
EFFECTS = tuple(_HOMES)


@dataclass(frozen=True, slots=True)
class Entry:
    """One model of one effect, as ``human: {effect: {model: ...}}`` names it."""

    effect: str
    model: str
    cls: type[Checked]

    @property
    def does(self) -> str:
        """What it does, in a few words."""
        return self.cls.does

    @property
    def source(self) -> str:
        """Who published it."""
        return self.cls.source

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What it can be told."""
        return parameters_of(self.cls)

    @property
    def neutral(self) -> Any:
        """The model at the values at which it changes nothing, through its own code."""
        return neutral_of(self.cls)


def models_of(effect: str) -> tuple[str, ...]:
    """The names of the models of an effect; the first is the one that is meant where none is named."""
    return tuple(_HOMES[effect])


def entry(effect: str, model: str | None = None) -> Entry:
    """A model of an effect by name. Raises KeyError for names that do not exist."""
    model = models_of(effect)[0] if model is None else model
    module, name = _HOMES[effect][model].split(".")
    return Entry(effect, model, getattr(import_module(f"opsim.subjects.human.{module}"), name))


def catalogue() -> Iterator[Entry]:
    """All of them, in the order of the page."""
    return (entry(effect, model) for effect, models in _HOMES.items() for model in models)


def made(effect: str, model: str, values: dict[str, Any]) -> Any:
    """The model of an effect with its parameters; ``model`` is that effect's name where it has but one.

    Raises KeyError for names that do not exist, ValueError with all mistakes for values out of bounds.
    """
    return entry(effect, None if model == effect else model).cls(**values)


def as_written(one: Parameter, value: float | str | None) -> str:
    """A value of a parameter as a scenario has it: "24 h", "16:48", "never", "0.8"."""
    if value is None or isinstance(value, str):
        return value or ""
    if one.name == "peak_s":
        return on_the_clock(value)
    if value == inf:
        return "never"
    return _time(value) if one.unit == "s" else f"{value:g}"


def name_written(one: Parameter) -> str:
    """The name of a parameter as a scenario has it, without its unit."""
    return one.name.removesuffix("_s") if one.unit == "s" else one.name


def parameters_written(entry: Entry) -> str:
    """All parameters of a model with their defaults: "rate 0.8, measured_at 1"."""
    return ", ".join(f"{name_written(one)} {as_written(one, one.default)}".strip() for one in entry.parameters)


def _time(seconds: float) -> str:
    for unit, size in (("d", 86_400.0), ("h", 3_600.0), ("min", 60.0)):
        if seconds >= 2 * size or seconds == size:
            return f"{seconds / size:g} {unit}"
    return f"{seconds:g} s"
