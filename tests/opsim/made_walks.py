"""A walking emulator by arithmetic: steps of one length, a trunk that leans by one angle a walk, feet that stay."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from emulator.skeleton import standard_skeleton
from opsim.ergonomics.angles import CANONICAL
from opsim.subjects.people.plan import WalkingPlan
from tests.opsim.ergonomics.made_work import leaning

SKELETON = standard_skeleton()
ORDER = [CANONICAL.index(name) for name in SKELETON.names]
FEET = [[SKELETON.names.index(f"{side}_{joint}") for joint in ("ankle", "toe")] for side in ("left", "right")]
CONDITION = ("distance_m", "speed_m_per_s")


@dataclass(frozen=True, eq=False)
class MadeWalks:
    """Walk i goes ``distance_m[i]`` in ``n_steps[i]`` even steps, the right foot first, leaning by ``lean_deg[i]``."""

    distance_m: np.ndarray
    duration_s: np.ndarray
    n_steps: np.ndarray
    lean_deg: np.ndarray
    skeleton = SKELETON

    def __getitem__(self, rows):
        some = slice(rows, rows + 1 or None) if isinstance(rows, int) else rows
        return type(self)(*(values[some] for values in vars(self).values()))

    @property
    def mark_s(self):
        return np.empty((len(self.duration_s), 0))

    def contact(self, n_times):
        """(n, T, 2) whether the left and the right foot bear: all the time but in their own steps."""
        return np.stack([~self._foot(side, n_times)[1] for side in (0, 1)], axis=-1)

    def positions_m(self, n_times):
        bodies = np.array([leaning(np.full(n_times, lean)) for lean in self.lean_deg])[:, :, ORDER]
        bodies[..., 0] += (np.linspace(0, 1, n_times) * self.distance_m[:, None])[..., None]
        for side, joints in enumerate(FEET):
            bodies[..., joints, 0] = self._foot(side, n_times)[0][..., None]
        return bodies

    def _foot(self, side, n_times):
        """(n, T) where a foot (0 left, 1 right) is along the way, and whether it swings; the right one goes first."""
        steps = np.linspace(0, 1, n_times) * self.n_steps[:, None]
        now = np.minimum(np.floor(steps), self.n_steps[:, None] - 1)
        swings = ((now + side) % 2 == 1) & (steps < self.n_steps[:, None]) & (steps > now)
        landed = np.maximum(2 * ((now + side) // 2) - side, 0)
        at = np.where((now + side) % 2 == 1, landed + (now + 1 - landed) * (steps - now), landed)
        return at * (self.distance_m / self.n_steps)[:, None], swings


@dataclass(frozen=True)
class Walk:
    """Draws walks: steps of 0.5 m at 1 m/s and 0.1 m more for each m/s; ``lean_deg`` for everybody and 2 a spread."""

    lean_deg: float = 5.0
    shortest_m: float = 0.5
    body_keys = ("height_m", "person")
    workers = ()

    @property
    def report(self):
        return Report()

    def mean_duration_s(self, worker=None):
        return 1.0

    def draw_worker(self, rng, body=None):
        return float(rng.standard_normal())

    def sample(self, n, rng, *, worker=None, condition=None):
        factor, lean = rng.standard_normal((2, n))
        distance_m, speed = (
            np.broadcast_to(condition[key], n).astype(float) for key in ("distance_m", "speed_m_per_s")
        )
        n_steps = np.maximum(1, np.rint(distance_m / (0.4 + 0.1 * speed)))
        duration_s = distance_m / speed * np.exp(0.05 * factor - 0.05**2 / 2)
        return MadeWalks(distance_m, duration_s, n_steps, self.lean_deg + (worker or 0.0) + 2.0 * lean)


def walking(plan, model=None):
    """A plan whose workers walk so."""
    return replace(plan, walking=WalkingPlan("made/walk", Walk() if model is None else model))


class Report(NamedTuple):
    """What an emulator tells of its training."""

    source: str = "synthetic: made walks"
    licence: str = "free"
    n_sequences: int = 12
    n_workers: int = 3


def made_library(folder, monkeypatch, model=None, name="made.npz"):
    """A library file with a task ``walk`` and a header as a library of walking has it; loading it gives ``model``."""
    from emulator.archive import write_archive

    model = Walk() if model is None else model
    folder.mkdir(parents=True, exist_ok=True)
    crank = {"kind": "cyclic", "pace": {"steps": False}, "workers": []}
    header = {"tasks": {"walk": {**crank, "pace": {"steps": True}}, "lift": {}, "crank": crank}}
    write_archive(folder / name, header, {})
    monkeypatch.setattr("opsim.libraries.load_library", lambda path: {"walk": model})
    return folder / name
