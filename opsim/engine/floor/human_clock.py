"""The time of day on the floor: a shift of every log time that a worker draws himself."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.state import Floor, Station, Worker
from opsim.human.circadian import Circadian

_shift: Any = inlined(Circadian.shift)


def install(build: Any, effects: Any) -> None:
    """A shift at every worker, where the time of day counts."""
    if build.plan.human.circadian is not None:
        build.hang(effects.shifts, shifted)


@step
def shifted(floor: Floor, worker: Worker, station: Station) -> None:
    """By how much his log time shifts now."""
    effects = worker.human.effects
    effects.answer = _shift(effects.circadian, floor.start_s + floor.now)
