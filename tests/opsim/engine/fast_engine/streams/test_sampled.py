"""Blocks of every kind of model against those the SimPy engine draws, to the bit."""

import numpy as np
import pytest

from opsim.engine.draws import _held, _performed
from opsim.engine.fast_engine.streams.blocks import durations, held, in_one_call
from opsim.streams import BLOCK, Items, _key
from opsim.subjects.tasks.model import UniformCount
from opsim.subjects.tasks.variability import switched
from opsim.subjects.tools.plan import HoldPlan, Moment
from opsim.tasks import Fixed, Gamma, Lognormal, Recorded, TimePerformances
from tests.opsim.subjects.tasks.models import MODELS as TIMES

TRACE = Recorded(tuple(np.linspace(1.0, 9.0, 37)), by_index=True)
MODELS = [*TIMES, UniformCount(2, 9), TRACE]
SWITCHES = ("full", "within_only", "between_only", "none", "shuffled")
SEED, REPLICATION, NAME = 2**130 + 5, 2**33, ("duration", "lift", "ana")
WORDS = np.frombuffer(_key(SEED, REPLICATION, NAME), np.uint32)
HOLD = HoldPlan(0, Moment(share=0.6), Moment(share=0.2))


def kind(one):
    return type(one).__name__


class Own:
    """A plug-in's model: its numbers lean on those beside them, so blocks must be drawn one by one."""

    def sample(self, n, rng, *, worker=None, condition=None):
        rng.spawn(1)
        return TimePerformances(1.0 + np.cumsum(rng.random(n)).astype(np.float32) + (worker or 0.0))


class OwnTrace(Own):
    by_index = True

    def at(self, k):
        return (k % 11) + 1


class Marked(Own):
    """With two marks of each performance, in no order."""

    def sample(self, n, rng, *, worker=None, condition=None):
        from types import SimpleNamespace

        duration_s = rng.gamma(3.0, 2.0, n)
        return SimpleNamespace(duration_s=duration_s, mark_s=duration_s[:, None] * (rng.random((n, 2)) * 1.4 - 0.2))


class Child(Lognormal):
    def _draw_s(self, n, rng, worker):
        return np.sort(super()._draw_s(n, rng, worker))


def items(draw):
    return Items(SEED, REPLICATION, NAME, draw)


def engines(model, effect, first, n):
    stream = items(_performed(model, effect))
    return np.array([second for block in range(first, first + n) for second in stream.block(block)], float)


def effects(model):
    """Nobody, and somebody where workers differ."""
    drawn = model.draw_worker(np.random.default_rng(3)) if hasattr(model, "draw_worker") else 0.25
    return [None] if drawn is None else [None, drawn]


@pytest.mark.parametrize("variability", SWITCHES)
@pytest.mark.parametrize("model", MODELS, ids=kind)
def test_every_model_of_times_gives_the_blocks_of_the_engine(model, variability):
    model = switched(model, variability)
    for effect in effects(model):
        drawn = durations(model, effect)
        for first, n in ((0, 1), (3, 5), (254, 3)):
            found = drawn(WORDS, first, n)
            assert found.dtype == float and found.tobytes() == engines(model, effect, first, n).tobytes()


def test_many_blocks_at_once_are_the_blocks_one_by_one():
    model = Lognormal(20.0, 0.4, 0.3)
    drawn = durations(model, 0.21)
    whole = drawn(WORDS, 0, 500)
    assert whole.tobytes() == b"".join(drawn(WORDS, block, 1).tobytes() for block in range(500))
    assert whole.tobytes() == engines(model, 0.21, 0, 500).tobytes()


def test_models_of_times_are_drawn_in_one_call_and_others_are_not():
    assert all(in_one_call(switched(model, word)) for model in TIMES for word in SWITCHES)
    assert not any(in_one_call(model) for model in (Own(), Child(3.0, 0.4), switched(Child(3.0, 0.4), "within_only")))


@pytest.mark.parametrize("model", [Own(), OwnTrace(), Marked(), Child(3.0, 0.4), switched(Own(), "shuffled")], ids=kind)
def test_models_of_others_are_asked_block_by_block(model):
    for effect in (None, 0.25):
        assert durations(model, effect)(WORDS, 2, 3).tobytes() == engines(model, effect, 2, 3).tobytes()


@pytest.mark.parametrize(
    ("model", "hold"),
    [
        (Fixed(4.0), HOLD),
        (Gamma(9.0, 0.4, 0.3), HOLD),
        (TRACE, HOLD),
        (OwnTrace(), HOLD),
        (Own(), HOLD),
        (Marked(), HOLD),
        (Marked(), HoldPlan(0, Moment(mark=0), Moment(mark=1))),
        (Marked(), HoldPlan(0, Moment(mark=1), Moment(share=0.7))),
    ],
    ids=kind,
)
def test_times_that_hold_a_tool_have_the_moments_of_the_engine(model, hold):
    stream = items(_held(hold, model, 0.1))
    wanted = np.array([row for block in (4, 5, 6) for row in stream.block(block)])
    found = held(hold, model, 0.1)(WORDS, 4, 3)
    assert np.stack(found, axis=1).tobytes() == wanted.tobytes()
    assert all(column.shape == (3 * BLOCK,) for column in found)
