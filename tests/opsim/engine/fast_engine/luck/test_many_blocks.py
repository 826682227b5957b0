import numpy as np
import pytest

from opsim.engine.fast_engine.streams.blocks import numpys_generators
from opsim.engine.fast_engine.streams.generators import ManyBlocks
from opsim.streams import BLOCK, _key

WORDS = np.frombuffer(_key(9, 4, ("duration", "lift", "ana")), np.uint32)
ASKED = [
    ("random",),
    ("standard_exponential",),
    ("standard_normal",),
    ("standard_gamma", 3.5),
    ("standard_gamma", 1),
    ("standard_gamma", 1.0),
    ("standard_gamma", 0.4),
    ("exponential", 12.3),
    ("gamma", 2, 7.5),
    ("gamma", 0.25, 80.0),
    ("normal", 0.0, 0.3),
    ("uniform", 2.3, 9.1),
    ("triangular", 1.2, 3.4, 7.9),
    ("triangular", 0.0, 0.0, 60.0),
    ("triangular", 3.0, 8.0, 8.0),
    ("weibull", 1.4),
    ("beta", 2.0, 3.5),
    ("geometric", 0.2),
    ("integers", 7),
    ("integers", 3, 9),
]


def same(ours, theirs, *asked, **more):
    name, *said = asked
    wanted = np.concatenate([getattr(rng, name)(*said, size=BLOCK, **more) for rng in theirs])
    found = getattr(ours, name)(*said, size=len(theirs) * BLOCK, **more)
    return found.dtype == wanted.dtype and np.array_equal(found, wanted)


@pytest.mark.parametrize("n", [1, 2, 7, 40])
@pytest.mark.parametrize("asked", ASKED, ids=str)
def test_every_method_gives_what_the_generators_of_the_blocks_give(asked, n):
    assert same(ManyBlocks(WORDS, 5, n), numpys_generators(WORDS, 5, n), *asked)


def test_whole_numbers_up_to_and_with_the_highest():
    assert same(ManyBlocks(WORDS, 0, 3), numpys_generators(WORDS, 0, 3), "integers", 1, 6, endpoint=True)


@pytest.mark.parametrize("seed", range(6))
def test_methods_in_any_order_go_on_where_the_last_one_ended(seed):
    """Compiled ones before and after such that need real generators."""
    order = np.random.default_rng(seed).permutation(len(ASKED))
    ours, theirs = ManyBlocks(WORDS, 2, 3), numpys_generators(WORDS, 2, 3)
    assert all(same(ours, theirs, *ASKED[i]) for i in order)


@pytest.mark.parametrize("asked", ASKED, ids=str)
def test_another_number_than_64_a_block_is_refused(asked):
    name, *said = asked
    with pytest.raises(ValueError, match="2 blocks give 128 numbers at once, found 64"):
        getattr(ManyBlocks(WORDS, 0, 2), name)(*said, size=BLOCK)
