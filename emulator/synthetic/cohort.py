"""A made cohort: people whose bodies, sex and pace change posture and duration by known linear effects.

The bodies are like those of Baydal-Bertomeu et al., table 1: nine men and nine women, 21 to 44 years old, chosen to
differ in height and body mass index, each at several paces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from emulator.covariates.body import Body
from emulator.geometry.warps import from_clr
from emulator.motion import Motion, MotionSet, motion_from_positions
from emulator.skeleton import standard_skeleton
from emulator.synthetic import choreography
from emulator.synthetic.choreography import TASKS, Choreography, pose_at
from emulator.synthetic.tasks import LICENCE, MARK_SPREAD, N_LATENTS, RATE_HZ, SOURCE, WARP_SPREAD

COVARIATES = ("height_m", "mass_kg", "age_years", "pace", "sex")
CENTRE = np.array([1.727, 80.7, 31.25, 0.0, 0.5])
SPREAD = np.array([0.10, 18.0, 7.0, 0.12, 0.5])
"""Height, mass, age, log pace and female (1 or 0): what an effect's unit of one is."""
OUTCOMES = ("how deep", "sideways", "trunk", "other side", "log duration")
EFFECTS = np.array(
    [
        [0.8, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.6, 0.0, 0.2],
        [0.0, 0.0, -0.5, 0.0, 0.4],
        [0.0, 0.0, 0.0, 0.7, 0.0],
        [0.0, 0.8, 0.0, 0.0, 0.0],
    ]
)
"""(covariates, outcomes): latents 0 to 3, then log duration in units of the task's spread; besides, a pace divides the
duration by itself."""
BETWEEN, WITHIN = 0.15, 0.10
"""Variances of an outcome between people of one body, and between repetitions of one person."""
_TRAITS = {
    "m": ((1.779, 0.086, 1.63, 1.91), (27.263, 4.118, 21.914, 33.412), (32.0, 5.1, 26.0, 40.0)),
    "f": ((1.675, 0.087, 1.55, 1.78), (26.362, 4.747, 19.257, 34.473), (30.5, 8.472, 21.0, 44.0)),
}
"""Height, body mass index, age: mean, standard deviation, least and greatest. Source: their table 1."""
_CLOCK = np.linspace(0.0, 1.0, 201)
_KNOTS = (np.arange(40) + 0.5) / 40


@dataclass(frozen=True, eq=False)
class CohortTruth:
    """What was put in: W bodies; of N repetitions the worker, pace, outcomes (N, 5), warps (N, 201), marks (N, E).

    outcomes : latents 0 to 3, and log duration in seconds; worker_outcomes (W, 5) : of each person at his usual pace
    """

    task: str
    bodies: tuple[Body, ...]
    worker_index: np.ndarray
    pace: np.ndarray
    outcomes: np.ndarray
    worker_outcomes: np.ndarray
    warps: np.ndarray
    mark_clock: np.ndarray
    effects: np.ndarray

    @property
    def numeric(self) -> np.ndarray:
        """(N, 4) height, mass, age of each repetition's worker, and its pace."""
        traits = np.array([(body.height_m, body.mass_kg, body.age_years) for body in self.bodies], float)
        return np.column_stack([traits[self.worker_index], self.pace])

    @property
    def sexes(self) -> list[str | None]:
        """(N,) sex of each repetition's worker."""
        return [self.bodies[w].sex for w in self.worker_index]

    @property
    def log_duration(self) -> np.ndarray:
        """(N,) log seconds."""
        return np.asarray(self.outcomes[:, -1])


def make_cohort(
    task: str = "lift",
    n_bodies: int = 18,
    n_repetitions: int = 6,
    *,
    seed: int = 0,
    effects: np.ndarray = EFFECTS,
    pace_spread: float = 0.15,
    size: float = 2.0,
) -> tuple[MotionSet, CohortTruth]:
    """``n_bodies`` times ``n_repetitions`` made repetitions with ``cov_height_m`` and so on, and the truth.

    effects     : (5, 5) of ``COVARIATES`` on ``OUTCOMES``, in the units of ``SPREAD``
    pace_spread : each person goes through paces from exp(-pace_spread) to exp(pace_spread) of his own; 0: his own only
    size        : how far a latent of one moves the posture, against the tasks of ``synthetic``
    Raises ValueError for an unknown task, with the nearest known, or effects of another shape.
    """
    if task not in TASKS:
        near = get_close_matches(task, TASKS, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(TASKS)}"
        raise ValueError(f"no task {task!r}; {hint}")
    if np.shape(effects) != EFFECTS.shape:
        raise ValueError(f"effects: found {np.shape(effects)}, expected {EFFECTS.shape}")
    rng = np.random.default_rng([seed, 4])
    truth = draw_cohort(task, n_bodies, n_repetitions, rng, effects, pace_spread)
    limbs = 1.0 + 0.02 * rng.standard_normal((n_bodies, 2))
    motions = [
        _motion(truth, i, limbs[w], f"r{i % n_repetitions + 1}", size)
        for i, w in enumerate(truth.worker_index.tolist())
    ]
    return MotionSet(task, tuple(motions), TASKS[task].mark_names, SOURCE, LICENCE), truth


def draw_cohort(
    task: str,
    n_bodies: int,
    n_repetitions: int,
    rng: np.random.Generator,
    effects: np.ndarray = EFFECTS,
    pace_spread: float = 0.15,
) -> CohortTruth:
    """The truth alone, without postures."""
    dance, bodies = TASKS[task], draw_bodies(n_bodies, rng)
    index = np.repeat(np.arange(n_bodies), n_repetitions)
    own_pace = np.array([body.pace for body in bodies], float)
    steps = np.linspace(-1.0, 1.0, n_repetitions) if n_repetitions > 1 else np.zeros(1)
    pace = own_pace[index] * np.exp(pace_spread * np.tile(steps, n_bodies))
    between = np.sqrt(BETWEEN) * rng.standard_normal((n_bodies, len(OUTCOMES)))
    within = np.sqrt(WITHIN) * rng.standard_normal((len(index), len(OUTCOMES)))
    outcomes = expected(dance, [bodies[w] for w in index], pace, effects) + units(dance) * (between[index] + within)
    usual = expected(dance, bodies, own_pace, effects) + units(dance) * between
    mark_clock = np.array(dance.mark_clock) + MARK_SPREAD * rng.standard_normal((len(index), len(dance.mark_clock)))
    return CohortTruth(task, bodies, index, pace, outcomes, usual, _warps(len(index), rng), mark_clock, effects)


def draw_bodies(n: int, rng: np.random.Generator) -> tuple[Body, ...]:
    """n bodies, men and women by turns; pace lognormal with 12 % between people."""
    bodies = []
    for sex in ("m", "f") * ((n + 1) // 2):
        height_m, index, age_years = (_within(trait, rng) for trait in _TRAITS[sex])
        pace = float(np.exp(SPREAD[3] * rng.standard_normal()))
        bodies.append(Body(height_m, index * height_m**2, age_years, sex, pace))
    return tuple(bodies[:n])


def expected(
    dance: Choreography, bodies: Sequence[Body], pace: np.ndarray, effects: np.ndarray = EFFECTS
) -> np.ndarray:
    """(N, 5) outcomes that bodies at paces (N,) have on average."""
    traits = np.array(
        [(b.height_m, b.mass_kg, b.age_years, np.log(p), b.sex == "f") for b, p in zip(bodies, pace)], float
    )
    outcomes = (traits - CENTRE) / SPREAD @ effects * units(dance)
    outcomes[:, -1] += np.log(dance.mean_s) - units(dance)[-1] ** 2 / 2 - np.log(pace)
    return np.asarray(outcomes)


def units(dance: Choreography) -> np.ndarray:
    """(5,) one of each outcome: latents are in standard deviations, log duration in half the task's own spread."""
    return np.append(np.ones(N_LATENTS), 0.5 * np.sqrt(np.log1p(dance.cv**2)))


def _within(trait: tuple[float, float, float, float], rng: np.random.Generator) -> float:
    """A normal number between its least and greatest, drawn again until it is."""
    mean, spread, least, greatest = trait
    while True:
        value = mean + spread * float(rng.standard_normal())
        if least <= value <= greatest:
            return value


def _warps(n: int, rng: np.random.Generator) -> np.ndarray:
    """(n, 201) warps whose log slope is a sum of three waves."""
    waves = np.stack([np.sin(2 * np.pi * _KNOTS), np.cos(2 * np.pi * _KNOTS), np.sin(4 * np.pi * _KNOTS)])
    return from_clr(WARP_SPREAD * rng.standard_normal((n, 3)) @ waves, len(_CLOCK))


def _motion(truth: CohortTruth, i: int, limbs: np.ndarray, trial: str, size: float) -> Motion:
    duration_s, worker = float(np.exp(truth.log_duration[i])), int(truth.worker_index[i])
    body = truth.bodies[worker]
    n_times = max(round(duration_s * RATE_HZ) + 1, 20)
    clock = np.interp(np.linspace(0, 1, n_times), truth.warps[i], _CLOCK)
    pose = pose_at(TASKS[truth.task], clock, size * truth.outcomes[i, :N_LATENTS])
    assert body.height_m is not None
    return motion_from_positions(
        standard_skeleton(),
        choreography.joints_m(pose, choreography.Body(body.height_m, float(limbs[0]), float(limbs[1]))),
        (n_times - 1) / duration_s,
        worker=f"w{worker + 1}",
        trial=trial,
        mark_s=duration_s * np.interp(truth.mark_clock[i], _CLOCK, truth.warps[i]),
        covariates=_covariates(body, float(truth.pace[i])),
    )


def _covariates(body: Body, pace: float) -> dict[str, float | str | None]:
    """As a recording keeps them."""
    return {
        "cov_height_m": body.height_m,
        "cov_mass_kg": body.mass_kg,
        "cov_age_years": body.age_years,
        "cov_sex": body.sex,
        "cov_pace": pace,
    }
