"""The catalogue in words for people: parameters as a scenario writes them."""

from __future__ import annotations

from math import inf

from opsim.clock import on_the_clock
from opsim.human.catalogue import Entry
from opsim.human.parameter import Parameter


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
