"""Workers: where they start, how fast they walk, what they can do."""

from dataclasses import dataclass

from opsim.bodies import BODY_KEYS
from opsim.names import natural_key
from opsim.plan.calendar import Duty, plan_duties
from opsim.plan.crews import kept_from
from opsim.plan.ranks import Ranks


@dataclass(frozen=True, slots=True)
class Body:
    """What is known of a worker's body, by the names of ``opsim.bodies.BODY_KEYS``; None where it is not known.

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


def plan_workers(scenario, ranks: Ranks) -> tuple[WorkerPlan, ...]:
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


def start_place(worker, scenario) -> str:
    """The name of the place where a worker stands at the start."""
    if worker.home is not None:
        return worker.home
    first = min(worker.skills or scenario.stations, key=natural_key)
    return scenario.stations[first].at
