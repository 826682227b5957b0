"""Whether this machine's compiled numbers are those of the numpy that is installed here: looked at once a process.

Another numpy may draw in another way, another C library may round a logarithm in another way, and another compiler may
fuse a product with a sum. Then blocks are drawn by numpy, one after the other, and nothing but the time differs.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numba import config

from opsim.engine.fast_engine.luck.many_blocks import ManyBlocks
from opsim.streams import BLOCK, _generator, _hashed, _key

_LOOKED_AT = (*range(10), 1500, 99_999)
_NAME = ("trust",)
_DRAWN: tuple[tuple[int, str, tuple[float, ...]], ...] = (
    (1000, "standard_exponential", ()),
    (1000, "standard_normal", ()),
    (300, "standard_gamma", (1.7,)),
    (50, "uniform", (2.1, 5.3)),
    (50, "triangular", (1.1, 2.3, 7.9)),
)
"""(blocks, method, what it is given). NOTE: of a thousand blocks some ten normals lie beyond the last layer of the
ziggurat, where a logarithm is taken."""


def blocks_of(words: np.ndarray, first: int, n: int) -> ManyBlocks:
    """The generators of n blocks of the stream of a key; numpy's own where what is compiled is not to be trusted."""
    return ManyBlocks(words, first, n, None if is_trusted() else numpys_generators(words, first, n))


def numpys_generators(words: np.ndarray, first: int, n: int) -> list[np.random.Generator]:
    """The generators of n blocks as ``opsim.streams`` makes them."""
    key = words.tobytes()
    return [_generator(key + _hashed(block)) for block in range(first, first + n)]


@cache
def is_trusted() -> bool:
    """Whether what is compiled gives numpy's numbers, and numpy finishes long arrays as it finishes short ones."""
    if getattr(config, "DISABLE_JIT", 0):  # Python's numbers do not end at 64 bits
        return False
    try:
        return _seeds_agree() and all(_agrees(*one) for one in _DRAWN) and _finished_alike()
    except (ImportError, AttributeError):  # numba keeps its tables elsewhere
        return False


def _seeds_agree() -> bool:
    """Keys of several lengths, against numpy's own way from a seed."""
    return all(
        np.array_equal(ManyBlocks(words, block, 1).random(BLOCK), numpys_generators(words, block, 1)[0].random(BLOCK))
        for words in (_words(0, 0), _words(2**32 - 1, 2**40), _words(2**200, 7))
        for block in _LOOKED_AT
    )


def _agrees(n: int, name: str, said: tuple[float, ...]) -> bool:
    """One stream of n blocks against numpy's generators in the same states."""
    ours = getattr(_many(n), name)(*said, n * BLOCK)
    theirs = [getattr(one, name)(*said, BLOCK) for one in _many(n).generators]
    return np.array_equal(ours, np.concatenate(theirs))


def _finished_alike() -> bool:
    """Exponentials in numpy take many numbers at once: the last of an array must not come out otherwise, nor one."""
    x = _many(9).standard_normal(9 * BLOCK)
    whole = np.exp(x)
    by_block = np.concatenate([np.exp(one) for one in x.reshape(9, BLOCK)])
    return np.array_equal(whole, by_block) and np.array_equal(whole, [np.exp(one) for one in x.tolist()])


def _many(n: int) -> ManyBlocks:
    return ManyBlocks(_words(1, 0), 0, n)


def _words(seed: int, replication: int) -> np.ndarray:
    return np.frombuffer(_key(seed, replication, _NAME), np.uint32)
