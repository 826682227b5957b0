"""Workers: where they start, how fast they walk, what they can do.

How workers walk: the emulator behind their walks, where the scenario names one.

Job rotation: who is at which post, and what makes people change.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from opsim.engine.rules import in_turn
from opsim.layout import given_out, turns_away
from opsim.plan.ranks import Ranks
from opsim.problems import natural_key
from opsim.subjects.lines.plan import kept_from
from opsim.subjects.shifts.plan import Duty, plan_duties
from opsim.task_model import BODY_KEYS

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


@dataclass(frozen=True, slots=True)
class Body:
    """What is known of a worker's body, by the names of ``opsim.task_model.BODY_KEYS``; None where it is not known.

    walk_m_per_s : how fast he walks, for walks inside a task; not what is said of a body
    """

    height_m: float | None = None
    mass_kg: float | None = None
    age_years: float | None = None
    sex: str | None = None
    pace: float | None = None
    person: str | None = None
    walk_m_per_s: float | None = None

    @property
    def said(self) -> tuple[str, ...]:
        """The names of what is known."""
        return tuple(key for key in BODY_KEYS if getattr(self, key) is not None)


@dataclass(frozen=True, slots=True)
class WorkerPlan:
    """rating : (S,) performance rating at each station, 0 where the worker lacks the skill, or a crew keeps him away

    place  : where he starts and is at home
    patrol : ranks of the stations of his round, empty where he makes none
    most_load_kg : what he carries at once; None: anything
    duties : his shifts within the run, in order; None where he is always there; absence : share of them he misses
    zone : ranks of his own stations, in natural order; empty: all are; floater : goes only where nobody else is free
    quality : (S,) share of his operations that leave no defect, at each station; empty: all of them
    """

    name: str
    place: int
    walk_m_per_s: float
    rating: tuple[float, ...]
    body: Body
    patrol: tuple[int, ...] = ()
    most_load_kg: float | None = None
    duties: tuple[Duty, ...] | None = None
    absence: float = 0.0
    zone: tuple[int, ...] = ()
    floater: bool = False
    quality: tuple[float, ...] = ()


def plan_workers(scenario: Scenario, ranks: Ranks) -> tuple[WorkerPlan, ...]:
    """Workers in natural order. Who has no ``home`` starts at the first of his stations in natural order."""
    duties = plan_duties(scenario, ranks)
    return tuple(
        WorkerPlan(
            name,
            ranks.places[start_place(worker, scenario)],
            worker.walk_m_per_s,
            _ratings(worker, ranks.stations, kept_from(name, scenario)),
            Body(**{key: getattr(worker, key) for key in BODY_KEYS}, walk_m_per_s=worker.walk_m_per_s),
            tuple(ranks.stations[name] for name in worker.patrol or ()),
            worker.most_load_kg,
            duties[name],
            _absence(worker, scenario.human.absence),
            zone=tuple(sorted(ranks.stations[name] for name in worker.zone or ())),
            floater=worker.floater,
            quality=_qualities(worker, ranks.stations),
        )
        for name, worker in sorted(scenario.workers.items(), key=lambda item: natural_key(item[0]))
    )


def _absence(worker, of_all: float | None) -> float:
    """His own, else what is said of everybody with a shift."""
    if worker.absence is not None:
        return worker.absence
    return of_all if of_all is not None and worker.shift is not None else 0.0


def _ratings(worker, ranks: dict[str, int], kept_away: set[str]) -> tuple[float, ...]:
    ratings = [0.0] * len(ranks)
    for station, skill in worker.skills.items():
        if station not in kept_away:
            ratings[ranks[station]] = skill if isinstance(skill, int | float) else skill.pace
    return tuple(ratings)


def _qualities(worker, ranks: dict[str, int]) -> tuple[float, ...]:
    """(S,), or nothing where all of his work is good."""
    qualities = [1.0] * len(ranks)
    for station, skill in worker.skills.items():
        qualities[ranks[station]] = 1.0 if isinstance(skill, int | float) else skill.quality
    return tuple(qualities) if min(qualities) < 1 else ()


def start_place(worker, scenario: Scenario) -> str:
    """The name of the place where a worker stands at the start."""
    if worker.home is not None:
        return worker.home
    first = min(worker.skills or scenario.stations, key=natural_key)
    return scenario.stations[first].at


@dataclass(frozen=True, slots=True)
class WalkingPlan:
    """name : ``library/task`` as the scenario says it; model : its emulator.

    The model draws walks of given lengths: ``sample(n, rng, worker=effect, condition={"distance_m": (n,),
    "speed_m_per_s": (n,)})``, each row knowing nothing of the lengths of the others. No rule and no time of a run asks
    it anything: it is asked for postures, by figures and reports.
    """

    name: str
    model: Any


def plan_walking(loaded: Any) -> WalkingPlan | None:
    """The emulator of ``walking:``, or None where a scenario has none."""
    from opsim.libraries import load_library, resolve_library

    walking = loaded.scenario.walking
    if walking is None:
        return None
    file = resolve_library(loaded.scenario.libraries[walking.library], loaded.folder)
    return WalkingPlan(walking.emulator, load_library(file)[walking.library_task])


IN_TURN = "in_turn"


@dataclass(frozen=True, slots=True)
class RotationPlan:
    """workers : ranks in the order of the list; posts : ranks of the stations of each post, in the order of the list

    every_s : changes by the clock; after : by so many operations at one of the posts; None where not so
    rule    : who takes which post, one of ``opsim.engine.rules.ROTATION_RULES`` or a plug-in's
    """

    name: str
    workers: tuple[int, ...]
    posts: tuple[tuple[int, ...], ...]
    every_s: float | None = None
    after: int | None = None
    rule: str = IN_TURN

    @property
    def stations(self) -> int:
        """The stations of all posts, as bits of their ranks."""
        return sum(1 << rank for rank in {rank for post in self.posts for rank in post})

    def leaves(self, post: int, all_stations: int) -> int:
        """The stations where somebody at a post may work, as bits: those of the post, and those in no post."""
        return (all_stations & ~self.stations) | sum(1 << rank for rank in set(self.posts[post]))

    def can(self, workers: Sequence[WorkerPlan]) -> Callable[[int, int], bool]:
        """Whether a member, by his number in the list, can be at a post: with a skill for it, or where none is."""
        able = [[_able(workers[rank], post) for post in self.posts] for rank in self.workers]
        return lambda member, post: able[member][post]

    def by_turns(self, there: Sequence[int], turn: int, can: Callable[[int, int], bool]) -> dict[int, int]:
        """{member: post} of those who are there, after so many changes, by turns."""
        away = self.turns_away(there, turn)
        return given_out(
            len(self.posts), there, can, lambda member, slot: in_turn(away(member, slot), 0.0, 0.0, member)
        )

    def turns_away(self, there: Sequence[int], turn: int) -> Callable[[int, int], int]:
        """Of a member who is there and a slot: after how many changes more it is his."""
        position, n_slots = {member: n for n, member in enumerate(there)}, max(len(there), len(self.posts))
        return lambda member, slot: turns_away(position[member], turn, slot, n_slots)


def _able(worker: WorkerPlan, post: Sequence[int]) -> bool:
    return not post or any(worker.rating[station] > 0 for station in post)


def plan_rotations(scenario: Scenario, ranks) -> tuple[RotationPlan, ...]:
    """All rotations in natural order of names."""
    numbers = {name: rank for rank, name in enumerate(sorted(scenario.workers, key=natural_key))}
    return tuple(
        RotationPlan(
            name,
            tuple(numbers[worker] for worker in made.workers),
            tuple(tuple(ranks.stations[station] for station in post) for post in made.posts),
            made.every_s,
            made.after if made.every_s is not None or made.after is not None else 1,
            made.rule,
        )
        for name, made in sorted(scenario.rotations.items(), key=lambda item: natural_key(item[0]))
    )
