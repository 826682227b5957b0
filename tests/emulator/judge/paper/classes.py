"""Small classes of made recordings, prepared once a run, and classes that draw what a test wants."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from emulator.judge.paper import PaperClass, prepared
from emulator.synthetic.tasks import make


@cache
def lifts():
    """Fifteen lifts of three people on 301 points."""
    return prepared(make("lift", 3, 5, seed=2)[0], seed=1)


@cache
def short():
    """The same on every tenth point, for what looks at no part of the clock."""
    return replace(lifts(), aligned=lifts().aligned[:, ::10])


def shuffled(c):
    """The class with its repetitions in another order."""
    return replace(c, aligned=c.aligned[np.random.default_rng(5).permutation(len(c.aligned))])


@dataclass(frozen=True, eq=False)
class Drawing(PaperClass):
    """A class whose every scheme draws ``drawn``, again and again."""

    drawn: np.ndarray

    def draw(self, name, n, span=slice(None), dims=None, again=0):
        return self.drawn[np.arange(n) % len(self.drawn)][:, span]


def drawing(c, drawn):
    return Drawing(c.motions, c.aligned, c.emulator, c.seed, drawn)


def still(c):
    """Everybody in the first posture for all time."""
    return np.repeat(c.aligned[:, :1], c.aligned.shape[1], axis=1)
