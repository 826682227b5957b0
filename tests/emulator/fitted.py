"""Emulators that several test files need, fitted once a run."""

from functools import cache

from emulator.model.emulator import MotionEmulator
from emulator.model.library import MotionLibrary
from emulator.recordings import read_motions
from emulator.synthetic.tasks import make
from opsim.shipped import shipped_folder
from tests.recordings import recording


@cache
def motions_of(task):
    """A made task: five workers, eight repetitions each."""
    return make(task, 5, 8, seed=4)[0]


@cache
def made(task):
    """(motions, emulator) of a made task. A fit takes seconds: ask for lifts unless another task is the claim."""
    return motions_of(task), MotionEmulator.fit(motions_of(task))


@cache
def shipped(task):
    """The emulator of a made task of the shipped library, where nothing is asked of its recordings."""
    return MotionLibrary.load(shipped_folder() / "libraries" / "bench_work.npz")[task]


@cache
def recorded(name):
    """The correct repetitions of a recorded class."""
    return read_motions(recording(f"uiprmd_{name}"), where="cov_correct==1")
