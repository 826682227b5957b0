import numpy as np
import pytest

from opsim.engine.fast_engine.streams import blocks, generators
from opsim.engine.fast_engine.streams.blocks import durations
from opsim.engine.fast_engine.streams.generators import ManyBlocks
from opsim.engine.fast_engine.streams.seeds import BLOCK_HASHES
from opsim.streams import BLOCK, _key
from opsim.tasks import Exponential, Lognormal, Recorded, Weibull

WORDS = np.frombuffer(_key(1, 2, ("duration", "a", "b")), np.uint32)


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
    trusted = durations(model, None)(WORDS, 3, 4)
    request.getfixturevalue("_untrusted")
    assert durations(model, None)(WORDS, 3, 4).tobytes() == trusted.tobytes()


@pytest.mark.usefixtures("_untrusted")
def test_without_trust_nothing_compiled_is_asked(monkeypatch):
    monkeypatch.setattr(generators, "first_states", None)
    plain = blocks.blocks_of(WORDS, 0, 2)
    assert plain.random(2 * BLOCK).size == 2 * BLOCK and durations(Exponential(3.0), None)(WORDS, 0, 2).size == 128


def test_numpys_generators_are_those_of_the_states():
    states = ManyBlocks(WORDS, 0, 2).states.tolist()
    found = [rng.bit_generator.state["state"] for rng in blocks.numpys_generators(WORDS, 0, 2)]
    assert [one["state"] for one in found] == [high << 64 | low for high, low, *_ in states]
    assert len(BLOCK_HASHES.of(0, 2)) == 2
