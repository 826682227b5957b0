"""One class of recordings, ready to be judged as the paper does: on one clock, with everything that draws from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from emulator.fit_settings import FitSettings
from emulator.judge.alike import draw_alike
from emulator.judge.streams import stream
from emulator.model import SCHEME, MotionEmulator
from emulator.motion import MotionSet
from emulator.registered import registered
from emulator.schemes import Scheme

N_TIMES, N_KNOTS = 301, 20
OURS = f"ours ({SCHEME})"
IS_TVF, SIEM, PWI, VAR = "IS-TVF/SequentialPCA/MVG", "SIEM/SequentialPCA/MVG", "PWI", "IS-TVF/SpatialPCA/VAR"


@dataclass(frozen=True, eq=False)
class PaperClass:
    """A class of N repetitions, their postures on the common clock (N, 301, B, 3), and our emulator of them."""

    motions: MotionSet
    aligned: np.ndarray
    emulator: MotionEmulator
    seed: int

    @property
    def task(self) -> str:
        return self.motions.task

    def draw(
        self, name: str, n: int, span: slice = slice(None), dims: tuple[int, int] | None = None, again: int = 0
    ) -> np.ndarray:
        """n sequences of a scheme fitted to the part ``span`` of the clock, or of ours, of which the part is taken.

        Our emulator draws the people of the recordings, each as often as there. An exploding VAR is drawn all the
        same; functions of time are cut to what the recordings span. ``again`` : other draws of the same law.
        """
        rng = stream(self.seed, self.task, name, str(span.start), str(n), *([str(again)] if again else []))
        if name == OURS:
            scores = draw_alike(self.emulator, self.motions, n, rng).scores
            return self.emulator.aligned_directions(scores)[:, span]
        least = None if dims is None else (dims[0], min(dims[1], len(self.aligned) - 1))
        return Scheme.fit(self.aligned[:, span], name, least, seed=self.seed).sample(n, rng, allow_unstable=True)


def prepared(motions: MotionSet, seed: int = 0, progress: Callable[[int, int, str], None] | None = None) -> PaperClass:
    """The class on 301 points, aligned without a penalty as in the paper, and fitted so."""
    settings = FitSettings(SCHEME, None, N_TIMES, N_KNOTS, landmarks=0.0, seed=seed, command="", penalty=0.0)
    emulator = MotionEmulator.fit(motions, n_times=N_TIMES, n_knots=N_KNOTS, penalty=0.0, seed=seed, progress=progress)
    return PaperClass(motions, registered(motions, settings, None).directions, emulator, seed)
