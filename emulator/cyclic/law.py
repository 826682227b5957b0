"""CyclicLaw: what is known of a cyclic task: its postures and their dynamics, beats, pace and people."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from emulator.cyclic.contacts import Legs, contact_of_state
from emulator.cyclic.latent import Finer, PoseLatent
from emulator.cyclic.pace import Pace
from emulator.cyclic.report import CyclicReport
from emulator.cyclic.switching_dynamics import SwitchingDynamics
from emulator.cyclic.units import Crew, Guide, Unit, turns
from emulator.model.decoding import RootChannel
from emulator.skeleton import Skeleton

if TYPE_CHECKING:
    from emulator.kernels.switching import Manner

SMOOTH_FRAMES = 1.2
"""What the dynamics give is smoothed by a Gaussian of so many frames: neither noise nor switching trembles."""


@dataclass(frozen=True, eq=False)
class CyclicLaw:
    """latent, dynamics : of postures; starts, stops : units from and to standing, entries : recorded beats

    pace, crew : what times, steps and workers are like; control_at, control_by : log step to the dynamics' input
    guide : what recorded beats are like, by the control
    finer : the components of latents beyond those that the dynamics move
    temper : share of the dynamics' predictive spread that draws have: at which they are as rough as recordings,
             since what tells takes apart is no noise from frame to frame
    order : 2 where the dynamics see the latents' rates besides (a hammer goes up and down the same way), else 1
    ankle_legs, toe_legs : heights of a standing ankle and toe in legs
    contact_states : whether the dynamics' states are left + 2 right
    """

    task: str
    skeleton: Skeleton
    rate_hz: float
    latent: PoseLatent
    dynamics: SwitchingDynamics
    finer: Finer
    temper: float
    order: int
    starts: tuple[Unit, ...]
    stops: tuple[Unit, ...]
    entries: tuple[Unit, ...]
    guide: Guide
    pace: Pace
    crew: Crew
    control_at: float
    control_by: float
    ankle_legs: float
    toe_legs: float
    contact_states: bool
    beat_frames: tuple[int, int]
    report: CyclicReport

    @property
    def walks(self) -> bool:
        """Whether its beats are steps of feet that are planted."""
        return self.pace.steps and self.legs is not None

    @property
    def channel(self) -> RootChannel:
        return RootChannel(self.skeleton)

    @cached_property
    def legs(self) -> Legs | None:
        """The legs to be planted, where the skeleton has such."""
        return Legs.of(self.skeleton)

    @cached_property
    def leg_chain(self) -> np.ndarray:
        """(b, 3) the part of the skeleton's chain that the legs hang on."""
        assert self.legs is not None
        return self.legs.chain(self.skeleton)

    @cached_property
    def manner(self) -> Manner:
        """What beats are like and what smooths and completes them, as the kernel of a beat reads it."""
        from emulator.kernels.switching import Manner

        impulse = np.zeros((2 * int(4 * SMOOTH_FRAMES + 0.5) + 1, 1))
        impulse[len(impulse) // 2] = 1.0
        finer, guide = self.finer, self.guide
        points = np.ascontiguousarray((finer.points / finer.length).T)
        taps = np.ascontiguousarray(smoothed(impulse)[:, 0])
        return Manner(
            guide.low,
            guide.high,
            taps,
            points,
            1 / finer.length,
            finer.weight,
            finer.mean,
            self.contact_of(self.dynamics.states),
        )

    def contact_of(self, state: np.ndarray) -> np.ndarray:
        """(T, 2) whether the feet bear in states (T,) of the dynamics; both, where states are of something else."""
        if not self.contact_states:
            return np.ones((*np.shape(state), 2), bool)
        return contact_of_state(state)

    @property
    def n_moved(self) -> int:
        """How many of the latents the dynamics move."""
        return self.dynamics.n_latents // self.order

    def seen(self, z: np.ndarray, before: np.ndarray) -> np.ndarray:
        """(d,) what the dynamics see of latents z (D,) after ``before`` (D,) one frame earlier."""
        now = z[: self.n_moved]
        return now if self.order == 1 else np.append(now, rates(now, before[: self.n_moved], self.beat_frames[1]))

    def whole(self, z: np.ndarray, control: float) -> np.ndarray:
        """All components (T, D) of the latents, from those that the dynamics move (T, d)."""
        known = np.full((len(z), self.dynamics.n_controls), control)
        return np.hstack([z, self.finer.at(np.hstack([z, known]))])

    def turns(self, z: np.ndarray) -> list[int]:
        """Frames of z (T, d) at which a new cycle begins."""
        middle = float(self.guide.usual(-1, 0.0)[0])
        return turns(z, self.rate_hz, (middle, middle - 0.12 * float(self.guide.high[0] - self.guide.low[0])))


def rates(z: np.ndarray, before: np.ndarray, beat_frames: int) -> np.ndarray:
    """Steps of latents from frame to frame, as large as the latents where these go round once a beat."""
    return np.asarray((z - before) * (beat_frames / (2 * np.pi)))


def smoothed(z: np.ndarray) -> np.ndarray:
    """Latents (T, d) as a body moves them."""
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(z, SMOOTH_FRAMES, axis=0, mode="nearest"))
