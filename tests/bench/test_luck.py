"""Random numbers of the fast engine against the same numbers, item by item, of the SimPy engine: bits are asserted
first, then what a number costs in one process, in turn."""

from functools import partial
from itertools import islice

import numpy as np
import pytest
from bench.cpu import best_s

from opsim.engine.draws import _performed, _uniform
from opsim.engine.fast_engine.streams.blocks import Stream, durations, uniforms
from opsim.streams import BLOCK, Items, _key
from opsim.tasks import Erlang, Exponential, Lognormal, Triangular, Weibull

N_BLOCKS, AT_ONCE = 2000, 8
NAME = ("duration", "lift", "ana")


def by_items(draw):
    return list(islice(iter(Items(7, 0, NAME, draw)), N_BLOCKS * BLOCK))


def by_blocks(draw, at_once):
    stream = Stream(_key(7, 0, NAME), draw)
    return np.concatenate([stream.fill(first, at_once) for first in range(0, N_BLOCKS, at_once)])


@pytest.mark.parametrize(
    ("model", "at_least"),
    [
        ("uniform", 12),
        (Exponential(20.0), 8),
        (Lognormal(20.0, 0.3, 0.5), 7),
        (Erlang(20.0, 4), 7),
        (Triangular(1.0, 2.0, 6.0), 10),
        (Weibull(20.0, 0.3), 1.5),
    ],
    ids=lambda one: one if isinstance(one, str) else type(one).__name__,
)
def test_a_number_costs_a_fraction_of_what_it_costs_item_by_item(model, at_least):
    draws = (_uniform, uniforms) if model == "uniform" else (_performed(model, 0.2), durations(model, 0.2))
    assert by_blocks(draws[1], 1).tolist() == by_blocks(draws[1], AT_ONCE).tolist() == by_items(draws[0])
    taken = best_s(partial(by_items, draws[0]), partial(by_blocks, draws[1], 1), partial(by_blocks, draws[1], AT_ONCE))
    items, one, many = (seconds / N_BLOCKS / BLOCK * 1e9 for seconds in taken)
    print(
        f"\n{model}: {items:.0f} ns a number item by item; {one:.1f} ns a block at a time (x {items / one:.0f}), "
        f"{many:.1f} ns {AT_ONCE} at a time (x {items / many:.0f}, target {at_least})"
    )
    assert items / many > at_least
