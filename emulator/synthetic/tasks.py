"""Made tasks with known truth: postures by kinematics, known warps, known worker effects, known marks.

``python -m emulator.synthetic -o bench_work.npz`` fits the library of bench work that the scenarios use.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from emulator.motion import Motion, MotionSet, motion_from_positions
from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import TASKS, Body, Choreography, joints_m, pose_at

if TYPE_CHECKING:
    from emulator.model.library import MotionLibrary

SOURCE = "synthetic, made by this project"
LICENCE = "MIT"
RATE_HZ = 50.0
N_LATENTS = 4
WARP_SPREAD = 0.18
MARK_SPREAD = 0.012
_CLOCK = np.linspace(0.0, 1.0, 201)


@dataclass(frozen=True)
class Truth:
    """What was put into the made repetitions, and the population they were drawn from.

    warps (N, 201): common clock -> own unit time, on 201 even clock times; mark_clock (N, E) marks on the common clock,
    scattered about the key posture by ``MARK_SPREAD`` as a hand-set label is;
    latents (N, 4) posture latents, standard normal in the population; log_duration (N,) log seconds; worker_index (N,)
    duration_mean_s, duration_cv, between_share (of the variance of log duration), posture_duration_correlation and
    pace_duration_correlation (of latent 0 and of the first wave of the warps with log duration): of the population
    """

    warps: np.ndarray
    mark_clock: np.ndarray
    latents: np.ndarray
    log_duration: np.ndarray
    worker_index: np.ndarray
    duration_mean_s: float
    duration_cv: float
    between_share: float
    posture_duration_correlation: float
    pace_duration_correlation: float

    @property
    def mark_s(self) -> np.ndarray:
        """(N, E) seconds at which the marks come."""
        share = [np.interp(at, _CLOCK, gamma) for at, gamma in zip(self.mark_clock, self.warps)]
        return np.exp(self.log_duration)[:, None] * np.stack(share)


def make(
    task: str,
    n_workers: int = 6,
    n_repetitions: int = 10,
    *,
    seed: int = 0,
    rng: np.random.Generator | None = None,
    between_share: float = 0.5,
    correlation: float = 0.6,
    pace_correlation: float = 0.0,
    duration_cv: float | None = None,
    bodies: Sequence[Body] | None = None,
) -> tuple[MotionSet, Truth]:
    """``n_workers`` times ``n_repetitions`` made repetitions of a task, and the truth about them.

    between_share : share of the variance of log duration, of posture and of pace that lies between workers
    correlation, pace_correlation : of the first posture latent, and of the first wave of the warps (with it the way to
                    the middle of the task takes longer), with log duration, between workers and within alike
    duration_cv   : coefficient of variation of the duration; None: the task's own
    bodies        : one a worker; None draws them, 1.72 m tall on average
    Raises ValueError for an unknown task (with the nearest known), a share outside [0, 1], a negative cv, or
    correlations that no numbers have.
    """
    if task not in TASKS:
        near = get_close_matches(task, TASKS, n=1)
        raise ValueError(
            f"no task {task!r}; " + (f"did you mean {near[0]!r}?" if near else f"known: {', '.join(TASKS)}")
        )
    if not (0 <= between_share <= 1 and correlation**2 + pace_correlation**2 <= 1):
        raise ValueError(
            f"between_share {between_share} must be in [0, 1], the squares of correlation {correlation} and "
            f"pace_correlation {pace_correlation} must add to 1 at most"
        )
    if duration_cv is not None and not duration_cv >= 0:
        raise ValueError(f"duration_cv: found {duration_cv}, expected a number from 0")
    rng = np.random.default_rng(seed) if rng is None else rng
    dance = TASKS[task] if duration_cv is None else replace(TASKS[task], cv=duration_cv)
    index = np.repeat(np.arange(n_workers), n_repetitions)
    z = _two_level(rng, index, N_LATENTS + 4, between_share)
    drawn = draw_bodies(n_workers, rng)
    bodies = drawn if bodies is None else bodies
    mark_clock = np.array(dance.mark_clock) + MARK_SPREAD * rng.standard_normal((len(index), len(dance.mark_clock)))
    truth = _truth(dance, z, mark_clock, index, between_share, correlation, pace_correlation)
    motions = [
        _motion(dance, truth, i, bodies[w], f"w{w + 1}", f"r{i % n_repetitions + 1}")
        for i, w in enumerate(index.tolist())
    ]
    return MotionSet(task, tuple(motions), dance.mark_names, SOURCE, LICENCE), truth


def draw_bodies(n: int, rng: np.random.Generator) -> list[Body]:
    """n people: stature 1.72 m with 0.09 m standard deviation, arms and legs with 2 % on their own."""
    return [Body(1.72 + 0.09 * r[0], 1 + 0.02 * r[1], 1 + 0.02 * r[2]) for r in rng.standard_normal((n, 3))]


def bench_work_library(
    seed: int = 0,
    n_workers: int = 12,
    n_repetitions: int = 8,
    progress: Callable[[int, int, str], None] | None = None,
    command: str = "python -m emulator.synthetic",
) -> MotionLibrary:
    """The library of made bench work: all tasks by the same ``n_workers`` bodies, each task with its own stream."""
    from emulator.model.emulator import MotionEmulator
    from emulator.model.library import MotionLibrary

    crew = draw_bodies(n_workers, np.random.default_rng([seed, 0]))
    library = MotionLibrary.of(command=command, notes=(SOURCE,))
    for number, task in enumerate(TASKS):
        rng = np.random.default_rng([seed, 1 + number])
        motions, _ = make(task, n_workers, n_repetitions, rng=rng, bodies=crew)
        library = library.add(MotionEmulator.fit(motions, command=command, seed=seed))
        if progress is not None:
            progress(number + 1, len(TASKS), task)
    return library


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the library of bench work and say what was fitted."""
    write_library("python -m emulator.synthetic", main.__doc__, bench_work_library, arguments)


def write_library(
    program: str, purpose: str | None, made: Callable[..., MotionLibrary], arguments: Sequence[str] | None
) -> None:
    """Write the library that ``made(seed, command=...)`` makes to ``-o``, and say what was fitted."""
    parser = argparse.ArgumentParser(prog=program, description=purpose)
    parser.add_argument("-o", "--output", type=Path, required=True, help="the library to write (.npz)")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)
    command = f"{program} -o {options.output.name} --seed {options.seed}"
    library = made(options.seed, command=command)
    library.save(options.output)
    for task, emulator in library.items():
        print(task, "; ".join(f"{label}: {text}" for label, text in emulator.report.rows()), sep=": ")
    print(f"{options.output}: {options.output.stat().st_size / 1000:.0f} kB")


def _two_level(rng: np.random.Generator, index: np.ndarray, k: int, share: float) -> np.ndarray:
    """(N, k) standard normal numbers of which the share of variance is common to a worker."""
    between = rng.standard_normal((index.max() + 1, k))
    return np.sqrt(share) * between[index] + np.sqrt(1 - share) * rng.standard_normal((len(index), k))


def _truth(
    dance: Choreography,
    z: np.ndarray,
    mark_clock: np.ndarray,
    index: np.ndarray,
    share: float,
    by_posture: float,
    by_pace: float,
) -> Truth:
    spread = np.sqrt(np.log1p(dance.cv**2))
    pace, own = z[:, N_LATENTS : N_LATENTS + 3], z[:, -1]
    of_its_own = np.sqrt(1 - by_posture**2 - by_pace**2)
    log_duration = np.log(dance.mean_s) - spread**2 / 2
    log_duration = log_duration + spread * (by_posture * z[:, 0] + by_pace * pace[:, 0] + of_its_own * own)
    latents = z[:, :N_LATENTS]
    return Truth(
        warps_of(pace), mark_clock, latents, log_duration, index, dance.mean_s, dance.cv, share, by_posture, by_pace
    )


def warps_of(pace: np.ndarray) -> np.ndarray:
    """(N, 201) warps whose log slope is a sum of three waves with coefficients ``pace`` (N, 3)."""
    waves = np.stack([np.sin(2 * np.pi * _CLOCK), np.cos(2 * np.pi * _CLOCK), np.sin(4 * np.pi * _CLOCK)])
    slope = np.exp(WARP_SPREAD * (pace @ waves))
    steps = np.cumsum((slope[:, 1:] + slope[:, :-1]) / 2, axis=1)
    return np.concatenate([np.zeros((len(pace), 1)), steps / steps[:, -1:]], axis=1)


def _motion(dance: Choreography, truth: Truth, i: int, body: Body, worker: str, trial: str) -> Motion:
    duration_s = float(np.exp(truth.log_duration[i]))
    n_times = max(round(duration_s * RATE_HZ) + 1, 20)
    clock = np.interp(np.linspace(0, 1, n_times), truth.warps[i], _CLOCK)
    pose = pose_at(dance, clock, truth.latents[i])
    mark_s = duration_s * np.interp(truth.mark_clock[i], _CLOCK, truth.warps[i])
    return motion_from_positions(
        standard_skeleton(),
        joints_m(pose, body),
        (n_times - 1) / duration_s,
        worker=worker,
        trial=trial,
        mark_s=mark_s,
        covariates={"stature_m": body.stature_m},
    )
