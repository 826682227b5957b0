"""What a Worker is made from, checked on the way in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any

import simpy

from opsim.bodies import BODY_KEYS, BODY_RANGES
from opsim.effects import ACROSS_TASKS
from opsim.problems import did_you_mean, shown
from opsim.worker_log import WorkerLog


def check_arguments(env: Any, name: Any, rating: Any, across_tasks: Any, **whole: Any) -> None:
    """Raises TypeError or ValueError for an environment, a name, a rating, a word or a whole number that is none."""
    if not isinstance(env, simpy.Environment):
        raise TypeError(f"worker: expected a simpy.Environment first, found {shown(env)}")
    if not isinstance(name, str) or not name.strip():
        raise TypeError(f"worker: expected a name as text, found {shown(name)}")
    for word, number in whole.items():
        if isinstance(number, bool) or not isinstance(number, Integral) or number < 0:
            raise ValueError(f"worker {name}: {word} must be a whole number from 0, found {shown(number)}")
    if across_tasks not in ACROSS_TASKS:
        known = did_you_mean(str(across_tasks), ACROSS_TASKS)
        raise ValueError(f"worker {name}: across_tasks: no {shown(across_tasks)}; {known}")
    if isinstance(rating, bool) or not isinstance(rating, int | float) or not 0 < rating < math.inf:
        raise ValueError(f"worker {name}: rating must be a number above 0, found {shown(rating)}")


def log_or_new(name: str, log: Any) -> WorkerLog:
    """The log given, or a new one. Raises TypeError."""
    if log is None:
        return WorkerLog()
    if not isinstance(log, WorkerLog):
        raise TypeError(f"worker {name}: log must be a WorkerLog, found {shown(log)}")
    return log


def known_body(name: str, body: Any, models: Mapping[str, Any]) -> Any:
    """The body as it was given, where it says something that is read. Raises TypeError or ValueError."""
    said = list(body) if isinstance(body, Mapping) else [key for key in BODY_KEYS if hasattr(body, key)]
    if body is not None and not said:
        raise TypeError(f"worker {name}: body must have one of {', '.join(BODY_KEYS)}, found {shown(body)}")
    for key in said:
        if key not in BODY_KEYS:
            raise ValueError(f"worker {name}: body: no {shown(key)}; {did_you_mean(key, BODY_KEYS)}")
        value = body[key] if isinstance(body, Mapping) else getattr(body, key)
        if value is not None:
            _plausible(name, key, value, models)
    return body


def _plausible(name: str, key: str, value: Any, models: Mapping[str, Any]) -> None:
    if key in BODY_RANGES:
        _number(name, key, value, *BODY_RANGES[key])
    elif not isinstance(value, str):
        raise TypeError(f"worker {name}: body: {key} must be text, found {shown(value)}")
    elif key == "person":
        people = {one for model in models.values() for one in getattr(model, "workers", ())}
        if value not in people:
            hint = did_you_mean(value, people, otherwise="recorded") or "none of them is emulated"
            raise ValueError(f"worker {name}: body: no person {shown(value)} was recorded in these tasks; {hint}")
    elif value not in ("f", "m"):
        raise ValueError(f"worker {name}: body: sex must be 'f' or 'm', found {shown(value)}")


def _number(name: str, key: str, value: Any, low: float, high: float) -> None:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"worker {name}: body: {key} must be a number, found {shown(value)}")
    if not low <= float(value) <= high:
        raise ValueError(f"worker {name}: body: {key} must lie between {low:g} and {high:g}, found {shown(value)}")
