"""Every human effect by name: its class, what it does, its source, its parameters with units, defaults, neutral values.

A scenario says ``human: {learning: {model: wright, rate: 0.85}}``; an effect of one model needs no ``model``.
Classes are imported when they are asked for.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from opsim.human.parameter import Checked, Parameter, neutral_of, parameters_of

_HOMES: dict[str, dict[str, str]] = {
    "learning": {
        "wright": "power_curves.Wright",
        "plateau": "power_curves.Plateau",
        "de_jong": "power_curves.DeJong",
        "stanford_b": "power_curves.StanfordB",
        "hyperbolic": "other_curves.Hyperbolic",
        "dual_phase": "other_curves.DualPhase",
    },
    "forgetting": {"lfcm": "forgetting.LearnForgetCurve"},
    "fatigue": {"lffrm": "lffrm.Lffrm", "3cc_r": "three_compartment.ThreeCompartment"},
    "rest": {"by_need": "rest.RestByNeed"},
    "state_pace": {"schultz": "state_pace.Schultz"},
    "circadian": {"cosine": "circadian.Circadian"},
    "errors": {"linear": "errors.ErrorsByFatigue"},
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
    return Entry(effect, model, getattr(import_module(f"opsim.human.{module}"), name))


def catalogue() -> Iterator[Entry]:
    """All of them, in the order of the page."""
    return (entry(effect, model) for effect, models in _HOMES.items() for model in models)


def made(effect: str, model: str, values: dict[str, Any]) -> Any:
    """The model of an effect with its parameters; ``model`` is that effect's name where it has but one.

    Raises KeyError for names that do not exist, ValueError with all mistakes for values out of bounds.
    """
    return entry(effect, None if model == effect else model).cls(**values)
