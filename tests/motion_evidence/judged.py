"""One split judged: how far what each drawer gives is from the half that nobody has seen."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from motion_evidence.drawers import REAL, Drawer, drawers
from motion_evidence.halves import N_TIMES, Halves, halves
from threadpoolctl import threadpool_limits

from emulator.geometry.alignment import resample
from emulator.judge import (
    Comparison,
    compare,
    joint_reconstruction,
    reconstruction_error,
    roughness,
)
from emulator.judge.held_out import HeldOutRow, draw_alike, emulated_rows, resampled_rows
from emulator.model.emulator import MotionEmulator
from emulator.schemes import Scheme

N_OWN_TIME = 200
PAPER_SCHEME = "SIEM/SequentialPCA/MVG"


@dataclass(frozen=True)
class Split:
    """All figures of one split. ``compared`` has one entry a drawer; errors are those of ``reconstruction_error``.

    roughness_own_time : of ours, emulated over recorded in own time
    """

    task: str
    split: int
    compared: dict[str, Comparison]
    roughness_own_time: float
    n_components: int
    error: float
    paper_error: float
    emulated_times: tuple[HeldOutRow, ...]
    resampled_times: tuple[HeldOutRow, ...]


def judge_split(task: str, split: int, n_draws: int = 1000) -> Split:
    """Halves made, models fitted on the first, judged on the second; one BLAS thread."""
    with threadpool_limits(1, user_api="blas"):
        made = halves(task, split)
        emulator = MotionEmulator.fit(made.fitted, n_times=N_TIMES, seed=split)
        paper = Scheme.fit(made.a, PAPER_SCHEME, dims=(10, 30))
        rng = np.random.default_rng([split, 1])
        return Split(
            task,
            split,
            {name: _compared(made, name, draw, n_draws) for name, draw in drawers(made, emulator, paper).items()},
            _roughness_own_time(made, emulator, rng),
            emulator.posture.n_components,
            reconstruction_error(made.b, joint_reconstruction(emulator.flatten, emulator.posture, made.b)),
            reconstruction_error(made.b, paper.reconstruct(made.b)),
            tuple(emulated_rows(emulator, len(made.fitted), made.held, rng)),
            tuple(resampled_rows(made.fitted, made.held, rng)),
        )


def _compared(made: Halves, name: str, draw: Drawer, n_draws: int) -> Comparison:
    rng = np.random.default_rng([made.split, 0])
    people = made.fitted.worker_index if name == REAL else None
    judge = partial(compare, training=made.a, unseen=made.b, strata=made.held.worker_index, drawn_strata=people)
    return judge(draw(n_draws, rng), draw(len(made.b), rng), rng=rng)


def _roughness_own_time(made: Halves, emulator: MotionEmulator, rng: np.random.Generator) -> float:
    """Emulated over recorded, each in its own time on as many points."""
    own = np.stack([resample(m.directions, np.linspace(0, 1, N_TIMES)) for m in made.held.motions])
    drawn = draw_alike(emulator, made.fitted, N_OWN_TIME, rng).directions(n_times=N_TIMES)
    return roughness(drawn) / roughness(own)
