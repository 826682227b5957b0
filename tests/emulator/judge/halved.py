"""Made recordings in halves, small, dealt out and judged once a run."""

from functools import cache

from emulator.judge.held_out import drawer, in_halves
from emulator.judge.held_out_table import Unseen, judge_held_out
from emulator.synthetic.tasks import make

SMALL = {"n_times": 31, "n_drawn": 60}


@cache
def made():
    """Four people, six lifts each."""
    return make("lift", 4, 6, seed=1)[0]


@cache
def halves():
    return in_halves(made(), 3, SMALL["n_times"])


@cache
def unseen():
    return Unseen.of(halves(), SMALL["n_drawn"])


@cache
def drawn_by(name):
    """Who draws, fitted to the first half."""
    return drawer(name, halves())


@cache
def judged():
    """The usual two schemes on one split."""
    return judge_held_out(made(), n_splits=1, **SMALL)
