"""What a worker has behind him of each task. See ``opsim.human.memory``."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.curves import work_of
from opsim.engine.floor.parts.humans import Human
from opsim.engine.floor.parts.memories import memory_passes
from opsim.engine.floor.parts.state import Floor
from opsim.human.forgetting import LearnForgetCurve

_remembered_of: Any = inlined(LearnForgetCurve.remembered)


@step
def begins(floor: Floor, human: Human, task: int, k: int) -> float:
    """Which repetition of a task his k-th is if he begins it now: what he remembers, and one."""
    memory_passes(floor, human)
    behind = human.units[task]
    last_s = human.last_s[task]
    if last_s == last_s:  # not NaN
        behind = _remembered(human, task, behind, floor.now - last_s)
    human.asked, human.asked_task, human.asked_k, human.asked_units = 1, task, k, behind + 1.0
    human.busy = 0
    return behind + 1.0


@inlined
def _remembered(human: Human, task: int, behind: float, pause_s: float) -> float:
    effects = human.effects
    if pause_s < effects.forgetting.least_pause_s or behind <= 0.0:
        return behind
    worked_s = effects.first_s[task] * work_of(effects.learning, behind)
    return _remembered_of(effects.forgetting, behind, pause_s, worked_s)
