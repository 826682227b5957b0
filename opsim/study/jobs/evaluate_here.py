"""A job done in whatever process it was sent to: first it is made sure that this process would answer as others do."""

from __future__ import annotations

import json
from threading import Lock
from typing import Any

from opsim.engine.choice import SIMPY
from opsim.one_thread import one_blas_thread
from opsim.problems import ScenarioError
from opsim.study.jobs.answer import Answer
from opsim.study.jobs.decides import decided_by, made_from
from opsim.study.jobs.evaluate import evaluate
from opsim.study.jobs.job import Job
from opsim.study.jobs.source import Source

_one_at_a_time = Lock()
"""Threads of one process share what was planned, and one after the other they are no slower: they share Python too."""


class OtherProcess(Exception):
    """A process with other versions or other files; ``made`` is the JSON text of what its answers are made from."""

    def __init__(self, made: str):
        super().__init__(made)
        self.made: dict[str, Any] = json.loads(made)


class NotThere(Exception):
    """A process that cannot read the scenario or one of its files; the text says which."""


def answer(source: Source, job: Job, engine: str = SIMPY) -> Answer:
    """The answer to a job, on one BLAS thread. Raises as ``evaluate``."""
    with _one_at_a_time, one_blas_thread():
        return Answer.of(evaluate(source, job, engine))


def answer_far_away(source: Source, job: Job, decided: str, engine: str = SIMPY) -> Answer:
    """As ``answer``, in a process of which nothing is known.

    decided : what decides the answer, as who asks knows it. Raises OtherProcess where that is not the same here,
        NotThere.
    """
    try:
        with _one_at_a_time:
            same = decided_by(source, job.point) == decided
    except (ScenarioError, OSError) as error:
        raise NotThere(str(error)) from None
    if not same:
        raise OtherProcess(json.dumps(made_from(source, job.point.variant)))
    return answer(source, job, engine)
