"""What a modeller says of tasks beside their time, checked and in the program's own words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from math import isfinite
from typing import Any

from opsim.plan.handling import FORCES, FOREARMS, GRIPS, LEGS, NOT_SAID, Handling
from opsim.plan.tools import Moment, moment_of
from opsim.problems import did_you_mean, shown

WORDS = {"grip": GRIPS, "force": FORCES, "forearm": FOREARMS, "legs": LEGS}
FLAGS = ("arms_supported", "sitting", "rapid")


def handlings(said: Any, models: Mapping[str, Any], whose: str = "") -> dict[str, Handling]:
    """By task: a ``Handling``, from one or from its words (``{"load_kg": 8, "grip": "fair", "start": "grasp"}``).

    ``start`` and ``end`` may be names of marks, or shares of a performance.
    Raises one ValueError that lists all mistakes, a line each; TypeError where it is no mapping.
    """
    if said is None:
        return {}
    if not isinstance(said, Mapping):
        raise TypeError(f"{whose}handling: expected a mapping of tasks to Handling, found {shown(said)}")
    mistakes: list[str] = []
    found = {task: _handling(task, one, models, mistakes) for task, one in said.items()}
    if mistakes:
        raise ValueError("\n".join(whose + mistake for mistake in mistakes))
    return found


def _handling(task: Any, one: Any, models: Mapping[str, Any], mistakes: list[str]) -> Handling:
    where = f"handling of {task}"
    if task not in models:
        mistakes.append(f"handling: no task {shown(task)}; {did_you_mean(task, models)}")
        return NOT_SAID
    if not isinstance(one, Mapping | Handling):
        mistakes.append(f"{where}: expected a Handling or its words, found {shown(one)}")
        return NOT_SAID
    known = [field.name for field in fields(Handling)]
    given = dict(one) if isinstance(one, Mapping) else {name: getattr(one, name) for name in known}
    words = {word: value for word, value in given.items() if value is not None}
    wrong = [f"{where}: no {shown(word)}; {did_you_mean(word, known)}" for word in words if word not in known]
    wrong += [f"{where}: {name}: {problem}" for name in known if (problem := _problem(name, words.get(name)))]
    if wrong:
        mistakes.extend(wrong)
        return NOT_SAID
    names = tuple(getattr(models[task], "mark_names", ()))
    try:
        moments = {name: _moment(words[name], names) for name in ("start", "end") if name in words}
    except ValueError as error:
        mistakes.append(f"{where}: {error}")
        return NOT_SAID
    return replace(NOT_SAID, **{**words, **moments})


def _problem(name: str, value: Any) -> str:
    """What is wrong with one word; nothing where nothing is."""
    if value is None:
        return ""
    if name in WORDS and value not in WORDS[name]:
        return f"no {shown(value)}; {did_you_mean(value, WORDS[name])}"
    if name in FLAGS and not isinstance(value, bool):
        return f"found {shown(value)}, expected True or False"
    if name == "load_kg" and not (_number(value) and isfinite(value) and value >= 0):
        return f"found {shown(value)}, expected kilograms from 0"
    if name in ("start", "end") and not isinstance(value, Moment | str) and not (_number(value) and 0 <= value <= 1):
        return f"found {shown(value)}, expected the name of a mark, or a share from 0 to 1"
    return ""


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _moment(said: Any, names: tuple[str, ...]) -> Moment:
    return said if isinstance(said, Moment) else moment_of(said if isinstance(said, str) else float(said), names)
