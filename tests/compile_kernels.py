"""Compiles the loops of movements once, before each test process would: ``make tests`` runs it first."""

import numpy as np

from emulator import MotionEmulator
from emulator.synthetic.tasks import make

if __name__ == "__main__":
    emulator = MotionEmulator.fit(make("lift", 3, 4, seed=4)[0])
    drawn = emulator.sample(4, np.random.default_rng(1))
    drawn.positions_m()
    drawn.positions_m(dtype=np.float32)
