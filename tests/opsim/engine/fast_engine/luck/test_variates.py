"""Base variates against numpy's generators in the same states, to the bit, far into the tails."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.engine.fast_engine.streams import generators as tables
from opsim.engine.fast_engine.streams import generators as variates
from opsim.engine.fast_engine.streams.seeds import STATE_WORDS
from opsim.streams import BLOCK

EXPONENTIAL, NORMAL = tables.exponential(), tables.normal()
KINDS = {
    "random": (variates.uniforms, lambda rng, n: rng.random(n)),
    "exponential": (
        lambda states, out: variates.exponentials(states, out, *EXPONENTIAL),
        lambda rng, n: rng.standard_exponential(n),
    ),
    "normal": (lambda states, out: variates.normals(states, out, *NORMAL), lambda rng, n: rng.standard_normal(n)),
} | {
    f"gamma {shape}": (
        partial(lambda shape, states, out: variates.gammas(states, out, shape, *NORMAL), shape),
        partial(lambda shape, rng, n: rng.standard_gamma(shape, n), shape),
    )
    for shape in (1.0000001, 1.7, 4.0, 123.0)
}
N_LONG = 25_000


def state_of(bits):
    state = bits.state["state"]
    return [half for number in (state["state"], state["inc"]) for half in (number >> 64, number & (2**64 - 1))]


def one_row(bits):
    return np.array([state_of(bits)], np.uint64).reshape(1, STATE_WORDS)


@pytest.fixture(params=KINDS)
def kind(request):
    return KINDS[request.param]


@settings(max_examples=60)
@given(st.lists(st.integers(0, 2**64), min_size=1, max_size=5), st.sampled_from(sorted(KINDS)), st.integers(1, 3))
def test_each_block_is_numpys_and_its_state_moves_on_as_numpys(seeds, name, times):
    fill, numpys = KINDS[name]
    generators = [np.random.Generator(np.random.PCG64(seed)) for seed in seeds]
    states = np.concatenate([one_row(rng.bit_generator) for rng in generators])
    out = np.empty(len(seeds) * BLOCK)
    for _ in range(times):
        fill(states, out)
        assert out.tobytes() == b"".join(numpys(rng, BLOCK).tobytes() for rng in generators)
        assert states.tolist() == [state_of(rng.bit_generator) for rng in generators]


def test_millions_of_numbers_are_numpys_to_the_bit(kind):
    """One generator goes on through all blocks: 1.6 million numbers, so every layer and both tails come up."""
    fill, numpys = kind
    rng = np.random.Generator(np.random.PCG64(11))
    states, ours = one_row(rng.bit_generator), np.empty(N_LONG * BLOCK)
    for first in range(0, len(ours), BLOCK):
        fill(states, ours[first : first + BLOCK])
    theirs = numpys(rng, len(ours))
    assert np.array_equal(ours, theirs)


def test_the_long_row_reaches_beyond_the_last_layer_of_both_ziggurats():
    rng = np.random.Generator(np.random.PCG64(11))
    normals = rng.standard_normal(N_LONG * BLOCK)
    exponentials = np.random.Generator(np.random.PCG64(11)).standard_exponential(N_LONG * BLOCK)
    assert (normals > 3.6541528853610088).sum() > 100 and (normals < -3.6541528853610088).sum() > 100
    assert (exponentials > 7.69711747013104972).sum() > 300


@pytest.mark.parametrize(
    ("fill", "table"), [(variates.exponentials, EXPONENTIAL), (variates.normals, NORMAL)], ids=["exponential", "normal"]
)
@pytest.mark.parametrize("part", ["k", "w", "f"])
def test_a_fault_in_one_entry_of_a_table_is_seen(fill, table, part):
    wrong = getattr(table, part).copy()
    wrong[100] = wrong[100] * 0.9 if part != "k" else 0
    faulty = table._replace(**{part: wrong})
    bits = np.random.PCG64(5)
    rows = [np.repeat(one_row(bits), 1, axis=0) for _ in range(2)]
    ours, theirs = np.empty((2, BLOCK)), np.empty((2, BLOCK))
    seen = 0
    for _ in range(3000):
        fill(rows[0], ours[0], *table)
        fill(rows[1], theirs[0], *faulty)
        seen += not np.array_equal(ours[0], theirs[0])
        rows[1][:] = rows[0]
    assert seen > 0
