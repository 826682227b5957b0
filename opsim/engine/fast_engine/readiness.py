"""What a Plan needs before its first row: compiled steps, and what numba compiles and keeps itself to draw numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import partial

import numpy as np

from opsim.engine.fast_engine.luck.of_plan import luck_of
from opsim.engine.fast_engine.luck.trust import is_trusted
from opsim.engine.fast_engine.machine import complete, needed
from opsim.engine.fast_engine.machine.sharing_out import WORTH_HELP, Told, n_helpers
from opsim.engine.fast_engine.machine.steps import Step
from opsim.engine.fast_engine.machine.store import folder, is_marked, mark
from opsim.engine.fast_engine.machine.table import lacking
from opsim.plan import Plan

STEP_S, LUCK_S, EMULATED_S = 0.07, 12.0, 3.0
"""About so many CPU seconds are compiled for a step, what draws numbers and every floor's steps, emulators."""
LUCK, EMULATED = "luck", "emulated"
"""Noted on disk by these names when it was compiled. NOTE: to find out otherwise takes as long as to run it."""


def compiling_s(plan: Plan) -> float:
    """About how long ``ready`` compiles for a Plan, by the clock; 0: it is compiled, here or on disk."""
    from opsim.engine.fast_engine.build import Build

    n_steps = sum(1 for _ in lacking(needed(Build(plan).steps.values())))
    cpu_s = n_steps * STEP_S
    if _luck():
        cpu_s += LUCK_S
    if _emulated(plan) and not is_marked(EMULATED):
        cpu_s += EMULATED_S
    return cpu_s / (1 + n_helpers() if n_steps >= WORTH_HELP else 1)


def is_kept() -> bool:
    """Whether there is a place on disk for what is compiled."""
    return folder() is not None


def ready(plan: Plan, told: Told | None = None) -> None:
    """Compile what a Plan needs and is not compiled yet; ``told(done, total)`` says how far it is."""
    from opsim.engine.fast_engine.build import Build

    emulated = [] if is_marked(EMULATED) else _emulated(plan)
    ready_for(needed(Build(plan).steps.values()), told, [partial(_draw, plan, emulated)] if emulated else [])


def ready_for(steps: Iterable[Step], told: Told | None = None, only_here: Iterable[Callable[[], object]] = ()) -> None:
    """The same for some steps, and for what draws numbers; ``only_here``: what no other process knows of."""
    luck = _luck()
    complete(steps, told, luck, only_here)
    if luck:
        mark(LUCK)


def _luck() -> list[Callable[[], object]]:
    """What compiles all that draws numbers, where that is not done: the look at it that a first run takes anyway."""
    return [] if is_marked(LUCK) or is_trusted.cache_info().currsize else [is_trusted]


def _emulated(plan: Plan) -> list[int]:
    """A task of each kind of the emulator's models, by rank: of others nothing is compiled."""
    kinds = {type(task.model): rank for rank, task in enumerate(plan.tasks) if plan.workers}
    return [rank for kind, rank in kinds.items() if kind.__module__.startswith("emulator.")]


def _draw(plan: Plan, tasks: Iterable[int]) -> None:
    """Performances of some tasks. NOTE: what a model has to say against it is raised by the run, where it belongs."""
    luck, workforce = luck_of(plan), plan.workforce_of(0)
    with suppress(Exception):
        for task in tasks:
            luck.of_worker(task, 0, workforce)(np.zeros(6, np.uint32), 0, 1)
        mark(EMULATED)
