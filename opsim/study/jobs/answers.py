"""Answers to jobs: computed where they are missing, kept as they come, read figure by figure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from pathlib import Path

import numpy as np

from opsim.results import Key
from opsim.study.jobs.evaluate import evaluate
from opsim.study.jobs.job import Job
from opsim.study.jobs.source import Source

Progress = Callable[[int, int], None]


class Answers:
    """The figures of a study's jobs. A study is a pure function of them: the same answers, the same bytes, whoever
    computed them, in whatever order, and after however many interruptions.
    """

    def __init__(
        self,
        source: Source,
        folder: Path | None = None,
        *,
        processes: int | None = None,
        executor: Executor | None = None,
        progress: Progress | None = None,
    ):
        """folder : where the journal is; None keeps answers in memory only

        processes : here; None takes as many as pay. executor : instead, any that takes picklable functions
        """
        self.source, self.folder, self.progress = source, folder, progress
        self._found: dict[tuple[str, int, int], dict[Key, float]] = {}

    def ensure(self, jobs: Sequence[Job]) -> None:
        """Compute what is missing of some jobs, point by point in their order. Whatever stops it, what is finished is
        kept.
        """
        missing = [job for job in dict.fromkeys(jobs) if job.key not in self._found]
        for done, job in enumerate(missing, 1):
            self._found[job.key] = {figure[:4]: figure.value for figure in evaluate(self.source, job)}
            if self.progress is not None:
                self.progress(done, len(missing))

    def values(self, jobs: Sequence[Job], keys: Sequence[Key]) -> np.ndarray:
        """(J, K) figures of jobs, computed where they are missing; nan where a job has no such figure."""
        self.ensure(jobs)
        return np.array([[self._found[job.key].get(key, np.nan) for key in keys] for job in jobs], dtype=float).reshape(
            len(jobs), len(keys)
        )

    def keys(self, jobs: Sequence[Job]) -> list[Key]:
        """(kpi, subject, part, unit) of every figure that some of the jobs have, in the order of the first ones."""
        self.ensure(jobs)
        return list(dict.fromkeys(key for job in jobs for key in self._found[job.key]))
