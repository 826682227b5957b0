"""What becomes of a worker in somebody's own model, in the words of a scenario's ``human:``, checked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import isfinite
from typing import Any

from opsim.names import natural_key
from opsim.plan.human import EFFECTS, NO_EFFECTS, HumanPlan, parameters
from opsim.problems import did_you_mean, shown

NEEDS_A_FLOOR = {
    "state_pace": "it looks at the buffers of a scenario's stations",
    "rest": "who sends your workers is your model: look at worker.fatigue and let them wait",
    "errors": "what is good or bad is your model's: look at worker.fatigue",
    "absence": "who comes is your model's",
}
"""What means something only where the engine runs the floor."""
_KEYS = (*(effect for effect in EFFECTS if effect not in NEEDS_A_FLOOR), "acts_on")
"""What a worker in somebody's own model may be told."""


def human_of(name: str, said: Any, experience: Any, models: Mapping[str, Any], start_s: Any) -> HumanPlan:
    """The effects on one worker; NO_EFFECTS where nothing is said.

    said       : a HumanPlan, or a mapping as under ``human:`` of a scenario, times with their units
    experience : by task, repetitions behind him
    Raises one ValueError with all mistakes, a line each; TypeError where something is no mapping at all.
    """
    where = f"worker {name}: human"
    if not isinstance(start_s, int | float) or isinstance(start_s, bool) or not isfinite(start_s):
        raise ValueError(f"worker {name}: start_s must be seconds after Monday 00:00, found {shown(start_s)}")
    behind = _experience(name, experience, models)
    if said is None:
        plan = NO_EFFECTS
    elif isinstance(said, HumanPlan):
        plan = _refused(where, said)
    elif isinstance(said, Mapping):
        plan = _read(where, dict(said))
    else:
        raise TypeError(f"{where}: expected a mapping of effects or a HumanPlan, found {shown(said)}")
    if behind and plan.learning is None:
        raise ValueError(f"worker {name}: experience changes nothing where nobody learns; add 'learning'")
    if not plan.any:
        return plan
    return replace(plan, experience=(behind,) if behind else (), start_s=float(start_s) or plan.start_s)


def _refused(where: str, plan: HumanPlan) -> HumanPlan:
    wrong = [_not_here(where, effect) for effect in NEEDS_A_FLOOR if getattr(plan, effect, None) is not None]
    if plan.experience:
        wrong.append(f"{where}.experience: is by rank of a scenario's workers; give the Worker experience={{task: n}}")
    if wrong:
        raise ValueError("\n".join(wrong))
    return plan


def _not_here(where: str, effect: str) -> str:
    return f"{where}.{effect}: not in a model of your own; {NEEDS_A_FLOOR[effect]}"


def _read(where: str, words: dict[str, Any]) -> HumanPlan:
    from pydantic import ValidationError

    from opsim.human.catalogue import made
    from opsim.scenario.schema.human import Human

    wrong = [_not_here(where, effect) for effect in NEEDS_A_FLOOR if words.pop(effect, None) is not None]
    try:
        read = Human.model_validate(words)
    except ValidationError as error:
        raise ValueError("\n".join([*wrong, *_in_words(where, error, words)])) from None
    if wrong:
        raise ValueError("\n".join(wrong))
    blocks = {effect: getattr(read, effect) for effect in EFFECTS if getattr(read, effect) is not None}
    if "forgetting" in blocks and "learning" not in blocks:
        raise ValueError(f"{where}.forgetting: nothing is forgotten where nobody learns; add 'learning'")
    models = {
        effect: made(effect, getattr(block, "model", effect), parameters(block)) for effect, block in blocks.items()
    }
    return HumanPlan(**models, acts_on=read.acts_on)


def _in_words(where: str, error: Any, words: dict[str, Any]) -> Iterator[str]:
    """As for a scenario's file, without the lines of one."""
    from opsim.scenario.plain_words import schema_problems
    from opsim.scenario.positions import Node, Place, Source

    nowhere = Place(Source("", ()), 0, 0)
    unknown = {key for key in map(str, words) if key not in (*_KEYS, *NEEDS_A_FLOOR)}

    def node(value: Any) -> Node:
        below = {key: node(one) for key, one in value.items()} if isinstance(value, Mapping) else value
        return Node(below, nowhere)

    for one in schema_problems(_Under("human", error), node({"human": words})):  # type: ignore[arg-type]
        path = where + one.path.removeprefix("human")
        key = one.path.removeprefix("human.")
        hint = did_you_mean(key, _KEYS, otherwise="here are") if key in unknown else one.hint
        yield f"{path}: {one.message}" + (f"; {hint}" if hint else "")


class _Under:
    """The errors of a block as those of the file it would stand in."""

    def __init__(self, block: str, error: Any):
        self._block, self._error = block, error

    def errors(self, **how: Any) -> list[dict[str, Any]]:
        return [{**one, "loc": (self._block, *one["loc"])} for one in self._error.errors(**how)]


def _experience(name: str, said: Any, models: Mapping[str, Any]) -> tuple[float, ...]:
    if said is None:
        return ()
    where = f"worker {name}: experience"
    if not isinstance(said, Mapping):
        raise TypeError(f"{where}: expected a mapping of tasks to repetitions, found {shown(said)}")
    wrong = [f"{where}: no task {shown(task)}; {did_you_mean(task, models)}" for task in said if task not in models]
    for task, n in said.items():
        if isinstance(n, bool) or not isinstance(n, int | float) or not 0 <= n < float("inf"):
            wrong.append(f"{where} of {task}: found {shown(n)}, expected repetitions from 0")
    if wrong:
        raise ValueError("\n".join(wrong))
    behind = tuple(float(said.get(task, 0.0)) for task in sorted(models, key=natural_key))
    return behind if any(behind) else ()
