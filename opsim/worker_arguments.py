"""What a Worker is made from, checked on the way in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any

import simpy

from opsim.problems import did_you_mean, shown
from opsim.worker_log import WorkerLog


def check_arguments(env: Any, name: Any, rating: Any, **whole: Any) -> None:
    """Raises TypeError or ValueError for an environment, a name, a rating or a whole number that is none."""
    if not isinstance(env, simpy.Environment):
        raise TypeError(f"worker: expected a simpy.Environment first, found {shown(env)}")
    if not isinstance(name, str) or not name.strip():
        raise TypeError(f"worker: expected a name as text, found {shown(name)}")
    for word, number in whole.items():
        if isinstance(number, bool) or not isinstance(number, Integral) or number < 0:
            raise ValueError(f"worker {name}: {word} must be a whole number from 0, found {shown(number)}")
    if isinstance(rating, bool) or not isinstance(rating, int | float) or not 0 < rating < math.inf:
        raise ValueError(f"worker {name}: rating must be a number above 0, found {shown(rating)}")


def log_or_new(name: str, log: Any) -> WorkerLog:
    """The log given, or a new one. Raises TypeError."""
    if log is None:
        return WorkerLog()
    if not isinstance(log, WorkerLog):
        raise TypeError(f"worker {name}: log must be a WorkerLog, found {shown(log)}")
    return log


def known_body(name: str, body: Any) -> Any:
    """The body as it was given, where it says something that is read. Raises TypeError or ValueError."""
    known = ("height_m", "mass_kg")
    said = list(body) if isinstance(body, Mapping) else [key for key in known if hasattr(body, key)]
    if body is not None and not said:
        raise TypeError(f"worker {name}: body must have height_m or mass_kg, found {shown(body)}")
    for key in said:
        if key not in known:
            raise ValueError(f"worker {name}: body: no {shown(key)}; {did_you_mean(key, known)}")
        _plausible(name, key, body[key] if isinstance(body, Mapping) else getattr(body, key))
    return body


_BODIES = {"height_m": (0.5, 2.6), "mass_kg": (20.0, 400.0)}
"""What people are; the same as a scenario allows."""


def _plausible(name: str, key: str, value: Any) -> None:
    low, high = _BODIES[key]
    if value is None:
        return
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"worker {name}: body: {key} must be a number, found {shown(value)}")
    if not low <= float(value) <= high:
        raise ValueError(f"worker {name}: body: {key} must lie between {low:g} and {high:g}, found {shown(value)}")
