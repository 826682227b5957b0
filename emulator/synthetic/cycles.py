"""Made work in cycles: hammering (swing up, strike, a short rest) and cranking, any number of cycles, feet planted."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from emulator.recordings.take import Recording, Take
from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import REST, Body, joints_m
from emulator.synthetic.tasks import LICENCE, SOURCE, draw_bodies

CYCLE_S = {"hammer": 0.9, "crank": 1.3}
"""Mean seconds of a cycle."""
RATE_HZ = 60.0
CYCLE_CV, BETWEEN_CV = 0.05, 0.12
_LEAD_S = 0.6


@dataclass(frozen=True, eq=False)
class CycleTruth:
    """beat_s : of each take, (cycles + 1,) when cycles begin; mean_s (W,) each worker's own mean cycle."""

    beat_s: tuple[np.ndarray, ...]
    mean_s: np.ndarray


def make_cycles(
    task: str, n_workers: int = 5, n_takes: int = 4, *, seed: int = 0, n_cycles: tuple[int, ...] = (6, 7, 8)
) -> tuple[Recording, CycleTruth]:
    """Takes of ``hammer`` or ``crank``, each from standing at the work, several cycles, and back, and the truth.

    Raises ValueError for an unknown task, with the nearest known, and for no workers or takes.
    """
    if task not in CYCLE_S:
        near = get_close_matches(task, CYCLE_S, n=1)
        raise ValueError(
            f"no task {task!r}; " + (f"did you mean {near[0]!r}?" if near else f"known: {', '.join(CYCLE_S)}")
        )
    if min(n_workers, n_takes) < 1:
        raise ValueError(f"found {n_workers} workers and {n_takes} takes, expected one or more")
    rng = np.random.default_rng([seed, len(task)])
    bodies, mean_s = draw_bodies(n_workers, rng), CYCLE_S[task] * np.exp(BETWEEN_CV * rng.standard_normal(n_workers))
    takes, beats = [], []
    for worker in range(n_workers):
        style = np.clip(rng.standard_normal(4), -2, 2)
        for k in range(n_takes):
            count = int(rng.choice(n_cycles))
            cycle_s = mean_s[worker] * (1 + CYCLE_CV * rng.standard_normal(count))
            beat_s = _LEAD_S + np.concatenate([[0.0], np.cumsum(cycle_s)])
            takes.append(_take(task, bodies[worker], beat_s, style, rng, f"w{worker + 1}", f"r{k + 1}"))
            beats.append(beat_s)
    return Recording(tuple(takes), SOURCE, LICENCE), CycleTruth(tuple(beats), mean_s)


def _take(
    task: str, body: Body, beat_s: np.ndarray, style: np.ndarray, rng: np.random.Generator, worker: str, trial: str
) -> Take:
    time_s = np.arange(round((beat_s[-1] + _LEAD_S) * RATE_HZ) + 1) / RATE_HZ
    phase = np.interp(time_s, beat_s, np.arange(len(beat_s)), left=0.0, right=len(beat_s) - 1)
    busy = np.clip(np.minimum(time_s / _LEAD_S, (time_s[-1] - time_s) / _LEAD_S), 0, 1)
    busy = (busy**2 * (3 - 2 * busy))[:, None]
    pose = {name: np.broadcast_to(rest, (len(time_s), len(rest))).copy() for name, rest in REST.items()}
    at, trunk = _HANDS[task](phase, style)
    swell = 1 + 0.03 * np.interp(time_s, np.linspace(0, time_s[-1], 6), rng.standard_normal(6))[:, None]
    middle = at.mean(axis=0)
    pose["right_wrist"] += busy * (middle + swell * (at - middle) - REST["right_wrist"])
    pose["left_wrist"] += busy * (np.array([0.34, 0.16, 1.02]) - REST["left_wrist"])
    pose["pitch"] += busy * (0.16 + trunk[:, None])
    pose["twist"] += busy * (0.6 * trunk[:, None])
    pose["nod"] += 0.25 * busy
    skeleton = standard_skeleton()
    return Take(
        skeleton.names,
        skeleton.parents,
        joints_m(pose, body),
        RATE_HZ,
        worker=worker,
        trial=trial,
        covariates={"cov_height_m": body.stature_m},
        contact=np.ones((len(time_s), 2), bool),
    )


def _hammered(phase: np.ndarray, style: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Up over half of a cycle, down in a fifth, and a rest on the work."""
    u = phase % 1.0
    up, down = np.clip(u / 0.5, 0, 1), np.clip((u - 0.52) / 0.2, 0, 1)
    height = up**2 * (3 - 2 * up) * (1 - down**2)
    wrist = np.stack([0.44 - 0.16 * height, -0.12 - 0.05 * height, 1.0 + (0.40 + 0.03 * style[0]) * height], axis=-1)
    return wrist, 0.10 * (1 - height) + 0.01 * style[1]


def _cranked(phase: np.ndarray, style: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A circle 15 cm wide about a handle before the body."""
    turn, radius = 2 * np.pi * phase, 0.15 + 0.01 * style[0]
    wrist = np.stack([0.40 + radius * np.cos(turn), -0.14 + 0 * turn, 1.10 + radius * np.sin(turn)], axis=-1)
    return wrist, 0.05 * np.cos(turn) + 0.01 * style[1]


_HANDS = {"hammer": _hammered, "crank": _cranked}
