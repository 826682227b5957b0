"""Worker: one of our people in somebody's own SimPy model.

>>> import simpy
>>> from opsim import Worker
>>> from opsim.tasks import Fixed
>>> def shift(ana):
...     done = yield ana.perform("fold")
...     print(f"{done.task} until {done.end_s:g} s")
>>> env = simpy.Environment()
>>> _ = env.process(shift(Worker(env, "ana", {"fold": Fixed(12.0)})))
>>> env.run()
fold until 12 s
"""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import replace
from typing import Any

import simpy

from opsim.clock import on_grid
from opsim.ergonomics.shift.said import handlings
from opsim.human_said import human_of
from opsim.own_human import OwnHuman
from opsim.own_luck import OwnLuck
from opsim.performance import Performance
from opsim.problems import did_you_mean, shown
from opsim.task_models import task_models
from opsim.worker_arguments import check_arguments, known_body, log_or_new
from opsim.worker_log import WorkerLog


class WorkerBusy(RuntimeError):
    """A worker who does one thing was asked to begin another."""


class Worker:
    """A person who performs tasks, one at a time, each with a time (and a body) of its own draw.

    env     : your SimPy environment; it may be a RealtimeEnvironment and start at any time
    name    : with ``seed`` and ``replication`` it decides the luck: the same three give the same times in every model,
              and in an opsim scenario whose worker and tasks have these names
    tasks   : name -> TaskModel (an emulator, ``opsim.tasks``, your own), or the text "library/task", where library is
              the path of a motion library or the name of a shipped one; a MotionLibrary is such a mapping
    workforce : number that decides who the worker is; pass the replication to have other people in each
    across_tasks : "as_recorded", or "same_pace": who is slow in one task is as slow in all
    rating  : 1.1 means that every duration is divided by 1.1
    body    : what is known of the body: something with any of ``height_m``, ``mass_kg``, ``age_years``, ``sex``,
              ``pace`` and ``person``, the name of a recorded one (attributes or keys), or None
    log     : the WorkerLog to write into; each worker has one of its own otherwise, found as ``worker.log``
    handling : by task, what the hands hold and what carries the body: a ``Handling`` or its words; ``exposure_of`` asks
    human   : what becomes of him as he works, in the words of a scenario: ``{"fatigue": {"model": "lffrm"}}``, or a
              HumanPlan: learning, forgetting, fatigue and the time of day; between performances he rests
    experience : by task, repetitions behind him, where he learns
    start_s : when on the clock the environment's 0 is, in seconds after Monday 00:00
    turns   : a plain ``simpy.Resource`` of capacity 1 for models in which several processes want the same worker

    Raises TypeError or ValueError for arguments that make no sense.
    """

    def __init__(
        self,
        env: simpy.Environment,
        name: str,
        tasks: Mapping[str, Any],
        *,
        seed: int = 0,
        replication: int = 0,
        workforce: int = 0,
        across_tasks: str = "as_recorded",
        rating: float = 1.0,
        body: Any = None,
        log: WorkerLog | None = None,
        handling: Mapping[str, Any] | None = None,
        human: Any = None,
        experience: Mapping[str, float] | None = None,
        start_s: float = 0.0,
    ):
        check_arguments(env, name, rating, across_tasks, seed=seed, replication=replication, workforce=workforce)
        self.env, self.name, self.rating = env, name, rating
        self.log = log_or_new(name, log)
        self.turns = simpy.Resource(env, capacity=1)
        models = task_models(tasks)
        self.luck = OwnLuck(name, models, seed, replication, workforce, known_body(name, body, models), across_tasks)
        self.luck.handling = handlings(handling, models, f"worker {name}: ")
        effects = human_of(name, human, experience, models, start_s)
        self._human = OwnHuman(env, self.luck, effects) if effects.any else None
        self._next_k = dict.fromkeys(self.luck.models, 0)
        self._doing: Performance | None = None
        self._halted: dict[tuple[str, int], Performance] = {}
        self.log.join(name, env, replication, self.luck)

    @property
    def tasks(self) -> tuple[str, ...]:
        """The tasks this worker can perform."""
        return tuple(self.luck.models)

    @property
    def fatigue(self) -> float:
        """How tired he is now, 0 (fresh, or where nobody tires) to 1."""
        return 0.0 if self._human is None else self._human.level

    @property
    def busy(self) -> bool:
        """Whether a performance is under way."""
        return self._doing is not None

    def request(self) -> simpy.resources.resource.Request:
        """A turn with this worker, first come, first served: ``with worker.request() as turn: yield turn``."""
        return self.turns.request()

    def perform(self, task: str) -> simpy.Process:
        """Begin the next performance of a task now; the process's value is its ``Performance``.

        ``process.interrupt()`` stops it: the process then ends well at once, its value is the piece done so far, with
        ``finished == False``; ``resume`` goes on with it. An interrupt in the very instant of its end changes nothing.
        Raises ValueError for an unknown task, WorkerBusy while another performance is under way.
        """
        if task not in self._next_k:
            raise ValueError(f"worker {self.name}: no task {shown(task)}; {did_you_mean(task, self._next_k)}")
        self._must_be_free(f"perform {task}")
        k, now_s = self._next_k[task], self.env.now
        drawn = self.luck.performance(task, k)
        self._next_k[task] = k + 1
        time_s, shift = (drawn.duration_s, 0.0) if self._human is None else self._human.drawn(task, k, drawn.duration_s)
        duration_s = on_grid(time_s / self.rating)
        mark_s = tuple((drawn.mark_s * (duration_s / drawn.duration_s)).tolist())
        number, body = self.log.next_number(), self.luck.as_slow(drawn, task, k, shift)
        return self._begin(
            Performance(self.name, task, k, now_s, now_s, duration_s, mark_s, 0.0, 0.0, number, body, shift)
        )

    def resume(self, performance: Performance) -> simpy.Process:
        """Go on with an interrupted performance where it stopped, with the same k and the same draw.

        Raises ValueError where it is not the last piece of an unfinished performance of this worker, WorkerBusy while
        another one is under way.
        """
        if not isinstance(performance, Performance):
            raise TypeError(f"worker {self.name}: expected a Performance to resume, found {shown(performance)}")
        self._must_be_free(f"resume {performance.task}")
        if self._halted.get((performance.task, performance.k)) != performance:
            raise ValueError(f"worker {self.name}: cannot resume {self._why_not(performance)}")
        return self._begin(performance.next_piece(self.env.now))

    def _begin(self, piece: Performance) -> simpy.Process:
        self._doing = piece
        self.log.begin(piece)
        if self._human is not None:
            self._human.works(piece.task, piece.k, self.env.now + piece.left_s, piece.progress_from)
        return self.env.process(self._spend(piece))

    def _spend(self, piece: Performance) -> Generator[simpy.Event, None, Performance]:
        try:
            yield self.env.timeout(piece.left_s)
            done = replace(piece, end_s=self.env.now, progress_to=1.0)
        except simpy.Interrupt:
            done = piece.until(self.env.now)
            if self._human is not None:
                self._human.stops()
        self._doing = None
        self._halted.pop((done.task, done.k), None)
        if not done.finished:
            self._halted[done.task, done.k] = done
        self.log.end(done)
        return done

    def _must_be_free(self, wanted: str) -> None:
        if self._doing is not None:
            until_s = self._doing.start_s + self._doing.left_s
            raise WorkerBusy(
                f"worker {self.name}: cannot {wanted} at {self.env.now:g} s, is busy with {self._doing.task} until "
                f"{until_s:g} s; yield that first, or take turns: 'with worker.request() as turn: yield turn'"
            )

    def _why_not(self, performance: Performance) -> str:
        what = f"{performance.task}, performance {performance.k}"
        if performance.worker != self.name:
            return f"{what}: it is {performance.worker}'s"
        if performance.finished:
            return f"{what}: it is finished"
        latest = self._halted.get((performance.task, performance.k))
        if latest is None:
            return f"{what}, from {performance.progress_to:.0%}: it has been finished since"
        return f"{what}, from {performance.progress_to:.0%}: it has gone on to {latest.progress_to:.0%} since"
