"""Errors by fatigue on the floor: which share of his work somebody who is so tired leaves good."""

from __future__ import annotations

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Worker


def share_of_good_by(floor: Floor, worker: Worker) -> float:
    """Of what he begins now; 1.0 where errors have nothing to do with fatigue, or nobody tires."""
    errors = floor.plan.human.errors
    if errors is None or worker.human is None:
        return 1.0
    return errors.share_of_good(worker.human.level(floor.now))
