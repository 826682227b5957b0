"""Errors by fatigue on the floor: which share of his work somebody who is so tired leaves good."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.state import Floor, Station, Worker
from opsim.engine.floor.parts.tiring import level
from opsim.human.errors import ErrorsByFatigue

_share_of_good: Any = inlined(ErrorsByFatigue.share_of_good)


def install(build: Any, effects: Any) -> None:
    """Whoever asks finds it by the floor, where errors have to do with fatigue."""
    if build.plan.human.errors is not None:
        build.floor.errors_line = build.line(share_of_good_by)


@step
def share_of_good_by(floor: Floor, worker: Worker, station: Station) -> None:
    """Of what he begins now, in ``floor.asked_s``."""
    human = worker.human
    floor.asked_s = _share_of_good(human.effects.errors, level(floor, human))
