"""Steps are functions, and the line of a step is the function itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

F = TypeVar("F")


def step(function: F) -> F:
    """A function of the floor and of more."""
    return function


here = line_of = step


def inlined(function: Any) -> Any:
    """A small function; of a model's method, one that asks the model at hand, which may be anybody's."""
    owner, _, name = function.__qualname__.rpartition(".")
    if not owner or owner.endswith("<locals>"):
        return function
    return lambda model, *given: getattr(model, name)(*given)


@dataclass(frozen=True)
class Step:
    """line : the function."""

    line: Any


def step_of(call: Any) -> Step:
    """What stands behind a name that is called as a step."""
    return Step(call)


def call_out(function: Any, one: Any, other: Any) -> Any:
    """Ask Python."""
    return function(one, other)
