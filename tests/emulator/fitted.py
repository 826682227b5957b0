"""Emulators that several test files need, fitted once a run."""

from functools import cache

from emulator.model.emulator import MotionEmulator
from emulator.recordings import read_motions
from emulator.synthetic.tasks import make
from tests.recordings import recording


@cache
def made(task):
    """(motions, truth, emulator) of a made task: five workers, eight repetitions each."""
    motions, truth = make(task, 5, 8, seed=4)
    return motions, truth, MotionEmulator.fit(motions)


@cache
def recorded(name):
    """The correct repetitions of a recorded class."""
    return read_motions(recording(f"uiprmd_{name}"), where="cov_correct==1")
