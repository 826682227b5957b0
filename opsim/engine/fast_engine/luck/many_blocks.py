"""One that looks like a numpy Generator, and is those of many blocks of one stream: asked for n * 64 numbers, the
generator of each block gives its 64.

So a model of times can be asked for many blocks in one call, and finishes the numbers in its own way.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from opsim.engine.fast_engine.luck import tables, variates
from opsim.engine.fast_engine.luck.block_hashes import BLOCK_HASHES
from opsim.engine.fast_engine.luck.seeds import first_states
from opsim.streams import BLOCK

_NO_WORDS = np.empty(0, np.uint32)
exponential_table = cache(tables.exponential)
normal_table = cache(tables.normal)


class ManyBlocks:
    """``words``: the key of a stream, uint32; blocks ``first`` to ``first + n_blocks - 1``; their generators, if made.

    What is compiled moves the states of the blocks on; for all else real generators are made, which then stay. Each
    method is as that of numpy's Generator; a size other than 64 a block raises ValueError.
    """

    __slots__ = ("_first", "_generators", "_n_blocks", "_states", "_words")

    def __init__(
        self, words: np.ndarray, first: int, n_blocks: int, generators: list[np.random.Generator] | None = None
    ):
        self._words, self._first, self._n_blocks = words, first, n_blocks
        self._states: np.ndarray | None = None
        self._generators = generators

    @classmethod
    def in_states(cls, states: np.ndarray) -> ManyBlocks:
        """Blocks of any streams, by the states (n_blocks, 4) of their generators, which are moved on."""
        made = cls(_NO_WORDS, 0, len(states))
        made._states = states
        return made

    @property
    def states(self) -> np.ndarray:
        """(n_blocks, 4) uint64, made when first wanted: a fixed time wants none."""
        if self._states is None:
            self._states = first_states(self._words, BLOCK_HASHES.of(self._first, self._n_blocks))
        return self._states

    @property
    def generators(self) -> list[np.random.Generator]:
        """One for each block, where its state has come to."""
        if self._generators is None:
            self._generators = [_generator(state) for state in self.states.tolist()]
        return self._generators

    def random(self, size: int) -> np.ndarray:
        if self._generators is not None:
            return self._each(size, "random")
        out = self._room(size)
        variates.uniforms(self.states, out)
        return out

    def standard_exponential(self, size: int) -> np.ndarray:
        if self._generators is not None:
            return self._each(size, "standard_exponential")
        out = self._room(size)
        variates.exponentials(self.states, out, *exponential_table())
        return out

    def standard_normal(self, size: int) -> np.ndarray:
        if self._generators is not None:
            return self._each(size, "standard_normal")
        out = self._room(size)
        variates.normals(self.states, out, *normal_table())
        return out

    def standard_gamma(self, shape: float, size: int) -> np.ndarray:
        if shape == 1:
            return self.standard_exponential(size)
        if self._generators is not None or shape < 1:
            return self._each(size, "standard_gamma", shape)
        out = self._room(size)
        variates.gammas(self.states, out, float(shape), *normal_table())
        return out

    def exponential(self, scale: float, size: int) -> np.ndarray:
        return scale * self.standard_exponential(size)

    def gamma(self, shape: float, scale: float, size: int) -> np.ndarray:
        return scale * self.standard_gamma(shape, size)

    def normal(self, loc: float, scale: float, size: int) -> np.ndarray:
        return loc + scale * self.standard_normal(size)

    def uniform(self, low: float, high: float, size: int) -> np.ndarray:
        return low + (high - low) * self.random(size)

    def triangular(self, left: float, mode: float, right: float, size: int) -> np.ndarray:
        out = self.random(size)
        variates.bent(out, float(left), float(mode), float(right))
        return out

    def weibull(self, a: float, size: int) -> np.ndarray:
        return self._each(size, "weibull", a)

    def beta(self, a: float, b: float, size: int) -> np.ndarray:
        return self._each(size, "beta", a, b)

    def geometric(self, p: float, size: int) -> np.ndarray:
        return self._each(size, "geometric", p)

    def integers(self, low: int, high: int | None = None, size: int = 0, *, endpoint: bool = False) -> np.ndarray:
        return self._each(size, "integers", low, high, endpoint=endpoint)

    def _room(self, size: int) -> np.ndarray:
        if size != self._n_blocks * BLOCK:
            raise ValueError(f"{self._n_blocks} blocks give {self._n_blocks * BLOCK} numbers at once, found {size}")
        return np.empty(size)

    def _each(self, size: int, name: str, *said: Any, **more: Any) -> np.ndarray:
        self._room(size)
        return np.concatenate([getattr(one, name)(*said, size=BLOCK, **more) for one in self.generators])


def _generator(state: list[int]) -> np.random.Generator:
    """The numpy generator in a state; 2 us, where making it of a seed takes 7."""
    high, low, inc_high, inc_low = state
    bits = np.random.PCG64(_ANY)
    bits.state = {
        "bit_generator": "PCG64",
        "state": {"state": high << 64 | low, "inc": inc_high << 64 | inc_low},
        "has_uint32": 0,
        "uinteger": 0,
    }
    return np.random.Generator(bits)


class _Any:
    """A seed sequence that has nothing to find out: the state is set afterwards."""

    def generate_state(self, n_words: int, dtype: Any = np.uint64) -> np.ndarray:
        return np.zeros(n_words, dtype)


np.random.bit_generator.ISeedSequence.register(_Any)
_ANY: Any = _Any()
