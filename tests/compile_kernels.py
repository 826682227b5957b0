"""Compiles the loops of movements and bodies once, before each test process would: ``make tests`` runs it first."""

from tempfile import TemporaryDirectory

import numpy as np

from emulator import MotionEmulator
from emulator.cyclic.model import CyclicEmulator
from emulator.synthetic.tasks import make
from emulator.synthetic.walking import make_walks
from opsim.cli.run import command as run


def movements() -> None:
    """Fitted and decoded: lifts, and walks of any length."""
    drawn = MotionEmulator.fit(make("lift", 3, 4, seed=4)[0]).sample(4, np.random.default_rng(1))
    drawn.positions_m()
    drawn.positions_m(dtype=np.float32)
    walks = CyclicEmulator.fit(make_walks(3, 4, seed=5)[0], points=60)
    walked = walks.sample(2, np.random.default_rng(0), condition={"distance_m": 3.0})
    walked.positions_m(walked.duration_s[:, None])


def bodies() -> None:
    """Scored and tired, in a run."""
    with TemporaryDirectory() as folder:
        asked = ["--scenario", "tiring", "--replications", "1", "--horizon"]
        run.main(["shelf_heights", *asked, "20 min", "-o", f"{folder}/run"], standalone_mode=False)


if __name__ == "__main__":
    movements()
    bodies()
