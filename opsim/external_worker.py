"""What a Worker is made from, checked on the way in.

Human effects on one worker in somebody's own model: those of a floor with nobody else on it.

What a modeller gives for a task -> its TaskModel: a model as it is, or the text "library/task".

Worker: one of our people in somebody's own SimPy model.

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

import math
from collections.abc import Generator, Mapping
from dataclasses import replace
from numbers import Integral, Real
from pathlib import Path
from typing import Any

import simpy

from opsim.clock import on_grid
from opsim.external_draws import OwnLuck, human_of
from opsim.external_log import WorkerLog
from opsim.libraries import library_tasks, load_library
from opsim.performance import Performance
from opsim.problems import did_you_mean, natural_key, shown
from opsim.shipped import shipped_folder
from opsim.subjects.human.plan import HumanPlan
from opsim.task_model import BODY_KEYS, BODY_RANGES
from opsim.worker_effects import ACROSS_TASKS


def check_arguments(env: Any, name: Any, rating: Any, across_tasks: Any, **whole: Any) -> None:
    """Raises TypeError or ValueError for an environment, a name, a rating, a word or a whole number that is none."""
    if not isinstance(env, simpy.Environment):
        raise TypeError(f"worker: expected a simpy.Environment first, found {shown(env)}")
    if not isinstance(name, str) or not name.strip():
        raise TypeError(f"worker: expected a name as text, found {shown(name)}")
    for word, number in whole.items():
        if isinstance(number, bool) or not isinstance(number, Integral) or number < 0:
            raise ValueError(f"worker {name}: {word} must be a whole number from 0, found {shown(number)}")
    if across_tasks not in ACROSS_TASKS:
        known = did_you_mean(str(across_tasks), ACROSS_TASKS)
        raise ValueError(f"worker {name}: across_tasks: no {shown(across_tasks)}; {known}")
    if isinstance(rating, bool) or not isinstance(rating, int | float) or not 0 < rating < math.inf:
        raise ValueError(f"worker {name}: rating must be a number above 0, found {shown(rating)}")


def log_or_new(name: str, log: Any) -> WorkerLog:
    """The log given, or a new one. Raises TypeError."""
    if log is None:
        return WorkerLog()
    if not isinstance(log, WorkerLog):
        raise TypeError(f"worker {name}: log must be a WorkerLog, found {shown(log)}")
    return log


def known_body(name: str, body: Any, models: Mapping[str, Any]) -> Any:
    """The body as it was given, where it says something that is read. Raises TypeError or ValueError."""
    said = list(body) if isinstance(body, Mapping) else [key for key in BODY_KEYS if hasattr(body, key)]
    if body is not None and not said:
        raise TypeError(f"worker {name}: body must have one of {', '.join(BODY_KEYS)}, found {shown(body)}")
    for key in said:
        if key not in BODY_KEYS:
            raise ValueError(f"worker {name}: body: no {shown(key)}; {did_you_mean(key, BODY_KEYS)}")
        value = body[key] if isinstance(body, Mapping) else getattr(body, key)
        if value is not None:
            _plausible(name, key, value, models)
    return body


def _plausible(name: str, key: str, value: Any, models: Mapping[str, Any]) -> None:
    if key in BODY_RANGES:
        _number(name, key, value, *BODY_RANGES[key])
    elif not isinstance(value, str):
        raise TypeError(f"worker {name}: body: {key} must be text, found {shown(value)}")
    elif key == "person":
        people = {one for model in models.values() for one in getattr(model, "workers", ())}
        if value not in people:
            hint = did_you_mean(value, people, otherwise="recorded") or "none of them is emulated"
            raise ValueError(f"worker {name}: body: no person {shown(value)} was recorded in these tasks; {hint}")
    elif value not in ("f", "m"):
        raise ValueError(f"worker {name}: body: sex must be 'f' or 'm', found {shown(value)}")


def _number(name: str, key: str, value: Any, low: float, high: float) -> None:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"worker {name}: body: {key} must be a number, found {shown(value)}")
    if not low <= float(value) <= high:
        raise ValueError(f"worker {name}: body: {key} must lie between {low:g} and {high:g}, found {shown(value)}")


class OwnHuman:
    """A floor with one worker; times are those of the environment. Between performances he rests, whatever he does."""

    def __init__(self, env: simpy.Environment, luck: OwnLuck, human: HumanPlan):
        from opsim.engine.in_model import human_side_of
        from opsim.ergonomics.shift.external import plan_of

        self._env = env
        self.plan = replace(plan_of({luck.worker: luck}, [luck.worker], luck.handling), human=human)
        self._side = human_side_of(self.plan, luck.workforce, env.now)
        self._rank = {task.name: rank for rank, task in enumerate(self.plan.tasks)}

    @property
    def level(self) -> float:
        """How tired he is, 0 to 1."""
        return self._side.level(self._env.now)

    def drawn(self, task: str, k: int, drawn_s: float) -> tuple[float, float]:
        """Seconds of his k-th performance of a task, which begins now; and the shift that postures follow."""
        return self._side.drawn(self._env.now, self._rank[task], k, drawn_s)

    def works(self, task: str, k: int, until_s: float, done: float) -> None:
        """He works on his k-th of a task from now, ``done`` of which is done, until then if nothing comes between."""
        self._side.works(self._env.now, self._rank[task], k, until_s, done)

    def stops(self) -> None:
        """He is broken off."""
        self._side.stops(self._env.now)


SEAM = ("mean_duration_s", "draw_worker", "sample")


def task_models(tasks: Any) -> dict[str, Any]:
    """name -> TaskModel. Raises TypeError or ValueError, naming the task that is wrong and what was expected."""
    if not isinstance(tasks, Mapping):
        raise TypeError(f"tasks: expected a mapping of names to task models, found {shown(tasks)}")
    if not tasks:
        raise ValueError("tasks: expected at least one, found an empty mapping")
    return {_name(task): _model(task, given) for task, given in tasks.items()}


def library_model(text: str) -> Any:
    """The emulator of "library/task": library is the path of a file, ``.npz`` or not, or the name of a shipped one.

    Raises ValueError where there is no such library or task, with the nearest that there is.
    """
    library, slash, task = text.rpartition("/")
    if not (library and slash and task):
        raise ValueError(f"expected library/task, found {shown(text)}, such as 'public_movements/deep_squat'")
    file = _file(library)
    if task not in (known := library_tasks(file)):
        raise ValueError(f"no task {shown(task)} in {file.name}; {did_you_mean(task, known, otherwise='tasks in it')}")
    return load_library(file)[task]


def _name(task: Any) -> str:
    if not isinstance(task, str):
        raise TypeError(f"tasks: expected names as text, found {shown(task)}")
    return task


def _model(task: str, given: Any) -> Any:
    if isinstance(given, str):
        try:
            return library_model(given)
        except ValueError as error:
            raise ValueError(f"task {task}: {error}") from None
    missing = [name for name in SEAM if not callable(getattr(given, name, None))]
    if missing or isinstance(given, type):
        found = f"{shown(given)}, a {type(given).__name__} without {', '.join(missing)}" if missing else shown(given)
        raise TypeError(f"task {task}: expected a TaskModel or the text 'library/task', found {found}")
    return given


def _file(library: str) -> Path:
    shipped = shipped_folder() / "libraries"
    name = library if library.endswith(".npz") else f"{library}.npz"
    for path in (Path(library), Path(name), shipped / Path(name).name):
        if path.is_file():
            return path
    known = sorted((path.stem for path in shipped.glob("*.npz")), key=natural_key)
    raise ValueError(f"no library {shown(library)}; {did_you_mean(library, known, otherwise='shipped ones')}")


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
        if handling is not None:
            from opsim.ergonomics.shift.frames import handlings

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
