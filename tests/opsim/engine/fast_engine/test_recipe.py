"""Numbers that are drawn ahead, in the table where the engine looks for them, against each stream alone."""

import ctypes

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from opsim.engine.fast_engine import numbers as made
from opsim.engine.fast_engine.numbers import Recipe, wanted
from opsim.engine.fast_engine.random_numbers import DATA, DATA_2, END, ID, USED, place_of
from opsim.engine.fast_engine.streams.blocks import (
    HeldStream,
    Stream,
    drawn_ranks,
    durations,
    exponentials,
    held,
    uniforms,
)
from opsim.streams import BLOCK, _hashed, _key
from opsim.subjects.tools.plan import HoldPlan, Moment
from opsim.tasks import Exponential, Fixed, Gamma, Lognormal, TimePerformances

HOLD = HoldPlan(0, Moment(share=0.25), Moment(share=0.5))
SHARED = Lognormal(20.0, 0.4, 0.3), Gamma(9.0, 0.4, 0.3)
DRAWN = [
    *(durations(model, effect) for model in SHARED for effect in (None, 0.1, -0.7)),
    *(durations(Lognormal(mean_s, 0.2), None) for mean_s in (4.0, 5.0)),
    *(durations(Exponential(mean_s), None) for mean_s in (4.0, 4.0, 5.0)),
    *(durations(Fixed(3.0), None), exponentials(2.0), exponentials(6.0), uniforms, uniforms),
    drawn_ranks((3, 7, 8), (0.2, 0.9)),
    *(held(HOLD, model, None) for model in (*SHARED, Fixed(4.0))),
]


def begun(replication):
    return np.frombuffer(_key(2**130, replication, ()), np.uint32)


def name(stream):
    return np.frombuffer(_hashed("of") + _hashed(stream), np.uint32)


def alone(stream, drawn, n, replication):
    kind = HeldStream if isinstance(drawn, type(DRAWN[-1])) else Stream
    return kind(begun(replication).tobytes() + name(stream).tobytes(), drawn).fill(0, n)


def row_of(table, stream):
    """As the engine finds it."""
    mask = len(table) - 1
    at = place_of(stream, mask)
    while table[at, ID] not in (stream, 0):
        at = (at + 1) & mask
    return table[at]


def numbers(address, n):
    return np.array((ctypes.c_double * n).from_address(int(address)))


def a_recipe():
    return Recipe([(wanted(1 + i, name(1 + i), drawn), 1 + i % 4) for i, drawn in enumerate(DRAWN)])


def test_all_numbers_are_those_of_each_stream_alone_in_any_order_of_replications():
    recipe = a_recipe()
    for replication in (3, 0, 2**40, 3):
        recipe.draw(begun(replication))
        for i, drawn in enumerate(DRAWN):
            n, row, columns = 1 + i % 4, row_of(recipe.table, 1 + i), alone(1 + i, drawn, 1 + i % 4, replication)
            columns = columns if isinstance(columns, tuple) else (columns,)
            assert row[END] == n * BLOCK and recipe.blocks[1 + i] == n
            for at, column in zip((DATA, DATA_2, DATA_2 + 1), columns):
                assert numbers(row[at], n * BLOCK).tobytes() == column.astype(float).tobytes(), (i, at)


@given(st.sets(st.integers(1, 2**52), max_size=60), st.integers(1, 2**52))
def test_every_stream_is_found_and_no_other_is(streams, other):
    recipe = Recipe([(wanted(stream, name(stream), uniforms), 1) for stream in streams])
    assert {stream: row_of(recipe.table, stream)[END] for stream in streams} == dict.fromkeys(streams, BLOCK)
    assert (other in streams) == (row_of(recipe.table, other)[END] > 0)
    assert np.count_nonzero(recipe.table[:, ID]) * 2 <= len(recipe.table)


def test_streams_of_a_plan_lie_near_where_they_are_looked_for():
    ids = [purpose << 48 | one << 32 | two << 16 for purpose in (1, 7) for one in range(100) for two in range(20)]
    table, places = made._places(ids)
    mask = len(table) - 1
    assert np.mean([(places[stream] - place_of(stream, mask)) & mask for stream in ids]) < 1.0


def test_what_was_used_is_told_in_blocks():
    recipe = a_recipe()
    recipe.table[recipe.table[:, ID] == 4, USED] = 2 * BLOCK
    assert recipe.used() == {1 + i: 2 * (i == 3) for i in range(len(DRAWN))}


class Own:
    def sample(self, n, rng, *, worker=None, condition=None):
        return TimePerformances(1.0 + np.cumsum(rng.random(n)))


def test_what_is_drawn_block_by_block_is_not_drawn_together():
    assert wanted(1, name(1), durations(Own(), None)) is None and wanted(1, name(1), held(HOLD, Own(), None)) is None


def test_nothing_is_drawn_together_where_what_is_compiled_is_not_trusted(monkeypatch):
    monkeypatch.setattr(made, "is_trusted", lambda: False)
    assert wanted(1, name(1), uniforms) is None
