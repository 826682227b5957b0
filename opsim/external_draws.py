"""A worker's own draws, by the names of ``engine/draws.py``: the same luck in any model.

What becomes of a worker in somebody's own model, in the words of a scenario's ``human:``, checked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import Any

import numpy as np

from opsim.performance import Drawn, OfBlock
from opsim.problems import did_you_mean, natural_key, shown
from opsim.streams import BLOCK, Items, stream
from opsim.subjects.human.plan import EFFECTS, NO_EFFECTS, HumanPlan, parameters
from opsim.task_model import takes_shift
from opsim.threads import one_blas_thread
from opsim.worker_effects import worker_effect


class OwnLuck:
    """The performances of one worker: the k-th of a task is the same however the model is built around him.

    workforce : the number his own effects are keyed by: who he is, whatever the replication
    handling  : by task, what his hands hold, for who looks at his postures
    named     : by task, the name in which it is drawn, where that is another one
    """

    def __init__(
        self,
        worker: str,
        models: Mapping[str, Any],
        seed: int,
        replication: int,
        workforce: int = 0,
        body: Any = None,
        across_tasks: str = "as_recorded",
        named: Mapping[str, str] | None = None,
    ):
        self.models = dict(models)
        self.worker, self.seed, self.replication, self.body = worker, seed, replication, body
        self.workforce, self.across_tasks = workforce, across_tasks
        self._items: dict[str, Items] = {}
        self._effects: dict[str, Any] = {}
        self.handling: dict[str, Any] = {}
        self._named = {} if named is None else dict(named)
        self._last: tuple[tuple[str, int, float], Any] | None = None

    def __getstate__(self) -> dict[str, Any]:
        """Without what is drawn: it can be drawn again."""
        return {**vars(self), "_items": {}, "_last": None}

    def performance(self, task: str, k: int) -> Drawn:
        """The k-th performance of a task, at rating 1. Raises ValueError where the model draws what is no time."""
        if task not in self._items:
            name = ("duration", self._named.get(task, task), self.worker)
            self._items[task] = Items(self.seed, self.replication, name, self._draw(task))
        return self._items[task][k]

    def slowed(self, task: str, number: int, shift: np.ndarray) -> Any:
        """Block ``number`` of a task from the same noise, with log durations shifted by (BLOCK,) and the postures that
        go with it; where the model takes no shift (``takes_shift``), or there is none, the block as it is drawn.
        """
        model = self.models[task]
        if not np.any(shift) or not takes_shift(model):
            return self.performance(task, number * BLOCK).block
        rng = stream(self.seed, self.replication, "duration", self._named.get(task, task), self.worker, number)
        with one_blas_thread():
            condition = {"log_duration_shift": np.asarray(shift, dtype=float)}
            return model.sample(BLOCK, rng, worker=self._effect(task), condition=condition)

    def as_slow(self, drawn: Drawn, task: str, k: int, shift: float) -> Drawn | Slowed:
        """The k-th performance of a task as postures follow a shift of its log time, where they can."""
        return Slowed(self, task, k, shift) if shift and takes_shift(self.models[task]) else drawn

    def slowed_one(self, task: str, k: int, shift: float) -> Any:
        """The block with the k-th performance of a task so slowed; the last one is kept."""
        if self._last is None or self._last[0] != (task, k, shift):
            shifts = np.zeros(BLOCK)
            shifts[k % BLOCK] = shift
            self._last = (task, k, shift), self.slowed(task, k // BLOCK, shifts)
        return self._last[1]

    def _effect(self, task: str) -> Any:
        """The worker's own effect in a task."""
        if task not in self._effects:
            who = (self.worker, self.seed, self.workforce, self.body, self.across_tasks)
            with one_blas_thread():
                self._effects[task] = worker_effect(self.models[task], self._named.get(task, task), *who)
        return self._effects[task]

    def _draw(self, task: str) -> Callable[[np.random.Generator, int], list[Drawn]]:
        model, effect = self.models[task], self._effect(task)

        def draw(rng: np.random.Generator, number: int) -> list[Drawn]:
            with one_blas_thread():
                block = _trace(model, number) or model.sample(BLOCK, rng, worker=effect)
            _check_times(block, task, model)
            return [Drawn(block, row, self) for row in range(BLOCK)]

        return draw


@dataclass(frozen=True)
class Slowed(OfBlock):
    """The k-th performance of a task with its log time shifted, drawn when somebody asks for its body."""

    luck: OwnLuck = field(repr=False, compare=False)
    task: str
    k: int
    shift: float

    @property
    def block(self) -> Any:  # type: ignore[override]
        """Of the same noise, as ``OwnLuck.slowed`` draws it."""
        return self.luck.slowed_one(self.task, self.k, self.shift)

    @property
    def row(self) -> int:  # type: ignore[override]
        return self.k % BLOCK


def _trace(model: Any, number: int) -> Any:
    """The block of a model that knows its times by index, else None."""
    from opsim.tasks import TimePerformances

    if not getattr(model, "by_index", False):
        return None
    return TimePerformances(np.asarray(model.at(np.arange(number * BLOCK, (number + 1) * BLOCK))))


def _check_times(block: Any, task: str, model: Any) -> None:
    times_s = np.asarray(block.duration_s)
    if times_s.shape != (BLOCK,) or not np.all(np.isfinite(times_s) & (times_s > 0)):
        found = f"shape {times_s.shape}" if times_s.shape != (BLOCK,) else f"{times_s.min():g} to {times_s.max():g} s"
        expected = f"{BLOCK} positive durations in seconds"
        raise ValueError(f"task {task}: {type(model).__name__}.sample gave {found}, expected {expected}")


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

    from opsim.subjects.human.catalogue import made
    from opsim.subjects.human.words import Human

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
    from opsim.scenario.messages import schema_problems
    from opsim.scenario.tree import Node, Place, Source

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
