"""Base variates against numpy's generators in the same states, to the bit, far into the tails.

Streams that are drawn together against each alone, to the bit.
"""

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.engine.fast_engine.streams import blocks, generators
from opsim.engine.fast_engine.streams import generators as tables
from opsim.engine.fast_engine.streams import generators as variates
from opsim.engine.fast_engine.streams.blocks import (
    NoLuck,
    OfAKind,
    drawn_ranks,
    durations,
    exponentials,
    numpys_generators,
    of_model,
    uniforms,
)
from opsim.engine.fast_engine.streams.generators import ManyBlocks
from opsim.engine.fast_engine.streams.seeds import BLOCK_HASHES, STATE_WORDS
from opsim.streams import BLOCK, _key
from opsim.subjects.tasks.variability import switched
from opsim.tasks import Exponential, Fixed, Gamma, Lognormal, Recorded, Uniform, Weibull
from tests.opsim.subjects.tasks.models import MODELS, SHARED

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


SECONDS = st.floats(0.01, 1e5)
EFFECTS = st.none() | st.floats(-3.0, 3.0)
FAMILIES = {
    "exponential": st.builds(Exponential, SECONDS),
    "uniform": st.builds(Uniform, st.floats(0, 5), st.floats(5, 1e4)),
    "lognormal": st.builds(Lognormal, SECONDS, st.floats(0, 3), st.floats(0, 1)),
}
WORDS = np.frombuffer(_key(5, 1, ("duration", "lift", "ana")), np.uint32)


def together(alike, sizes):
    """What streams of one kind give in one call, each its own blocks."""
    states = [ManyBlocks(WORDS, 3 * i, n).states for i, n in enumerate(sizes)]
    numbers = [np.repeat(column, np.array(sizes) * BLOCK) for column in zip(*(one.numbers for one in alike))]
    return alike[0].draw(sum(sizes) * BLOCK, ManyBlocks.in_states(np.concatenate(states)), *numbers)


def alone(alike, sizes):
    return np.concatenate([one(WORDS, 3 * i, n) for i, (one, n) in enumerate(zip(alike, sizes))])


@pytest.mark.parametrize("family", FAMILIES)
@settings(max_examples=40)
@given(st.data())
def test_streams_of_a_family_together_are_each_alone(family, data):
    models = data.draw(st.lists(FAMILIES[family], min_size=1, max_size=6))
    alike = [of_model(model, data.draw(EFFECTS)) for model in models]
    sizes = [data.draw(st.integers(1, 3)) for _ in alike]
    assert len({one.kind for one in alike}) == 1
    assert together(alike, sizes).tobytes() == alone(alike, sizes).tobytes()


@pytest.mark.parametrize("model", [model for model in SHARED if not isinstance(model, Lognormal)], ids=repr)
@settings(max_examples=15)
@given(st.lists(st.tuples(st.floats(-3.0, 3.0), st.integers(1, 3)), min_size=1, max_size=5))
def test_workers_who_differ_in_a_model_together_are_each_alone(model, drawn):
    alike, sizes = [of_model(model, effect) for effect, _ in drawn], [n for _, n in drawn]
    assert len({one.kind for one in alike}) == 1
    assert together(alike, sizes).tobytes() == alone(alike, sizes).tobytes()


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_stations_of_a_model_together_are_each_alone_and_as_numpy_draws_them(model):
    alike, sizes = [of_model(model, None)] * 3, [2, 1, 3]
    numpys = [rng for i, n in enumerate(sizes) for rng in numpys_generators(WORDS, 3 * i, n)]
    wanted = np.concatenate([model.sample(BLOCK, rng).duration_s for rng in numpys]).astype(float)
    assert alone(alike, sizes).tobytes() == wanted.tobytes()
    if isinstance(alike[0], OfAKind):
        assert together(alike, sizes).astype(float).tobytes() == wanted.tobytes()


def test_gaps_of_many_sources_and_chances_together_are_each_alone():
    sizes = [1, 3, 2]
    for alike in (
        [exponentials(mean_s) for mean_s in (2.0, 7.5, 0.1)],
        [uniforms] * 3,
        [drawn_ranks((4, 9), (0.3,))] * 3,
    ):
        assert together(alike, sizes).tobytes() == alone(alike, sizes).tobytes()


def test_what_is_not_drawn_alike_is_not_of_a_kind():
    one, other = Gamma(20.0, 0.3, 0.5), Gamma(20.0, 0.4, 0.5)
    kinds = [of_model(one, 0.1), of_model(other, 0.1), of_model(one, None), of_model(Lognormal(20.0, 0.3), None)]
    kinds += [of_model(Exponential(20.0), None), exponentials(20.0), uniforms]
    kinds += [drawn_ranks(*said) for said in (((1, 2), (0.5,)), ((1, 2), (0.25,)), ((1, 3), (0.5,)))]
    kinds += [of_model(switched(one, "within_only"), effect) for effect in (None, object())]
    assert len({kind.kind for kind in kinds}) == len(kinds)


def test_fixed_times_and_traces_ask_no_luck():
    trace = Recorded(tuple(np.linspace(1.0, 9.0, 37)), by_index=True)
    assert all(isinstance(durations(model, None), NoLuck) for model in (Fixed(3.0), trace))


NAMES = np.frombuffer(_key(1, 2, ("duration", "a", "b")), np.uint32)


def looked_again():
    return blocks.is_trusted.__wrapped__()


@pytest.fixture
def _untrusted(monkeypatch):
    for module in (blocks, __import__("opsim.engine.fast_engine.streams.blocks", fromlist=["sampled"])):
        monkeypatch.setattr(module, "is_trusted", lambda: False)


def test_what_is_compiled_here_is_numpys():
    assert looked_again()


@pytest.mark.parametrize("which", ["exponential_table", "normal_table"])
@pytest.mark.parametrize(("part", "layers"), [("k", slice(100, 101)), ("w", slice(100, 101)), ("f", slice(None))])
def test_a_fault_in_a_table_is_found_out(monkeypatch, which, part, layers):
    table = getattr(generators, which)()
    wrong = getattr(table, part).copy()
    wrong[layers] = wrong[layers] // 2 if part == "k" else wrong[layers] * 0.98
    monkeypatch.setattr(generators, which, lambda: table._replace(**{part: wrong}))
    assert not looked_again()


def test_wrong_seeds_are_found_out(monkeypatch):
    monkeypatch.setattr(generators, "first_states", lambda words, hashes: np.ones((len(hashes), 4), np.uint64))
    assert not looked_again()


def test_without_a_compiler_nothing_is_tried(monkeypatch):
    monkeypatch.setattr("numba.config.DISABLE_JIT", 1)
    monkeypatch.setattr(blocks, "_seeds_agree", lambda: pytest.fail("tried"))
    assert not looked_again()


def test_no_tables_are_no_trust(monkeypatch):
    def none():
        raise AttributeError("ke_double")

    monkeypatch.setattr(generators, "exponential_table", none)
    assert not looked_again()


@pytest.mark.parametrize(
    "model", [Exponential(3.0), Lognormal(3.0, 0.5), Weibull(3.0, 0.5), Recorded((1.0, 2.0, 5.0))], ids=str
)
def test_without_trust_numpy_draws_the_same(model, request):
    trusted = durations(model, None)(NAMES, 3, 4)
    request.getfixturevalue("_untrusted")
    assert durations(model, None)(NAMES, 3, 4).tobytes() == trusted.tobytes()


@pytest.mark.usefixtures("_untrusted")
def test_without_trust_nothing_compiled_is_asked(monkeypatch):
    monkeypatch.setattr(generators, "first_states", None)
    plain = blocks.blocks_of(NAMES, 0, 2)
    assert plain.random(2 * BLOCK).size == 2 * BLOCK and durations(Exponential(3.0), None)(NAMES, 0, 2).size == 128


def test_numpys_generators_are_those_of_the_states():
    states = ManyBlocks(NAMES, 0, 2).states.tolist()
    found = [rng.bit_generator.state["state"] for rng in blocks.numpys_generators(NAMES, 0, 2)]
    assert [one["state"] for one in found] == [high << 64 | low for high, low, *_ in states]
    assert len(BLOCK_HASHES.of(0, 2)) == 2
