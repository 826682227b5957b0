"""Who draws: the emulator, the paper's scheme, two controls, and the training half itself."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from motion_evidence.halves import Halves

from emulator.judge import jittered_resampler, resampler
from emulator.judge.held_out import draw_alike
from emulator.model.emulator import MotionEmulator
from emulator.schemes import Scheme

Drawer = Callable[[int, np.random.Generator], np.ndarray]
OURS, PAPER, COPIER, SHAKER, REAL = "ours", "paper 10x30", "resampler", "jittered", "real half"


def drawers(halves: Halves, emulator: MotionEmulator, paper: Scheme) -> dict[str, Drawer]:
    """Name -> draw(n, rng) -> (n, T, B, 3) on the common clock."""

    def ours(n: int, rng: np.random.Generator) -> np.ndarray:
        return emulator.aligned_directions(draw_alike(emulator, halves.fitted, n, rng).scores)

    return {
        OURS: ours,
        PAPER: paper.sample,
        COPIER: lambda n, rng: resampler(halves.a, n, rng),
        SHAKER: lambda n, rng: jittered_resampler(halves.a, n, rng),
        REAL: lambda n, rng: halves.a,
    }
