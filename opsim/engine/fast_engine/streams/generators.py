"""The next 64 numbers of each of n generators, by numpy's algorithms.

Each kernel takes ``states`` (n, 4) uint64, which it moves on, and fills ``out`` (n * 64,) float64, block after block.
``ManyBlocks`` looks like a numpy Generator, so that a model of times can be asked for many blocks in one call.

Sources: numpy/random/src/distributions/distributions.c and ziggurat_constants.h; Marsaglia & Tsang (2000),
doi:10.18637/jss.v005.i08. What stands in the same order there stands so here: another order of sums would be another
last bit.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from opsim.engine.fast_engine.streams.seeds import BLOCK_HASHES, first_states, stepped, word_of
from opsim.ergonomics.kernels.compiled import compiled
from opsim.streams import BLOCK

_inlined = compiled(nogil=True, forceinline=True)
"""NOTE: left to itself LLVM does not inline the normal, and a state that goes through memory costs 6 ns a number."""

_EXPONENTIAL_END = 7.69711747013104972
_NORMAL_END, _ONE_OVER_NORMAL_END = 3.6541528853610088, 0.27366123732975828
_SMALLEST = 1.0 / 9007199254740992.0
_MANTISSA, _LAYER = np.uint64(0x000FFFFFFFFFFFFF), np.uint64(0xFF)
_0, _1, _3, _8, _9, _11 = (np.uint64(n) for n in (0, 1, 3, 8, 9, 11))


@_inlined
def uniform(high, low, inc_high, inc_low):
    """In [0, 1)."""
    high, low = stepped(high, low, inc_high, inc_low)
    return (word_of(high, low) >> _11) * _SMALLEST, high, low


@_inlined
def standard_exponential(high, low, inc_high, inc_low, k, w, f):
    """Of mean 1; k, w, f: its tables."""
    while True:
        high, low = stepped(high, low, inc_high, inc_low)
        word = word_of(high, low) >> _3
        layer, word = word & _LAYER, word >> _8
        x = word * w[layer]
        if word < k[layer]:
            return x, high, low
        u, high, low = uniform(high, low, inc_high, inc_low)
        if layer == _0:
            return _EXPONENTIAL_END - math.log1p(-u), high, low
        if (f[layer - _1] - f[layer]) * u + f[layer] < math.exp(-x):
            return x, high, low


@_inlined
def standard_normal(high, low, inc_high, inc_low, k, w, f):
    """Of mean 0 and variance 1; k, w, f: its tables."""
    while True:
        high, low = stepped(high, low, inc_high, inc_low)
        word = word_of(high, low)
        layer, size = word & _LAYER, (word >> _9) & _MANTISSA
        x = size * w[layer] * (1.0 - 2.0 * ((word >> _8) & _1))
        if size < k[layer]:
            return x, high, low
        if layer == _0:
            return _beyond(high, low, inc_high, inc_low, size)
        u, high, low = uniform(high, low, inc_high, inc_low)
        if (f[layer - _1] - f[layer]) * u + f[layer] < math.exp(-0.5 * x * x):
            return x, high, low


@compiled(nogil=True)
def _beyond(high, low, inc_high, inc_low, size):
    """A normal number in the tails; the side is in the bits of ``size``."""
    while True:
        u, high, low = uniform(high, low, inc_high, inc_low)
        x = -_ONE_OVER_NORMAL_END * math.log1p(-u)
        u, high, low = uniform(high, low, inc_high, inc_low)
        y = -math.log1p(-u)
        if y + y > x * x:
            x = _NORMAL_END + x
            return (-x if (size >> _8) & _1 else x), high, low


@_inlined
def standard_gamma(high, low, inc_high, inc_low, shape, k, w, f):
    """Of scale 1 and a shape above 1; k, w, f: the tables of the normal. Source: Marsaglia & Tsang (2000), as numpy."""
    b = shape - 1.0 / 3.0
    c = 1.0 / math.sqrt(9 * b)
    while True:
        v = 0.0
        while v <= 0.0:
            x, high, low = standard_normal(high, low, inc_high, inc_low, k, w, f)
            v = 1.0 + c * x
        v = v * v * v
        u, high, low = uniform(high, low, inc_high, inc_low)
        if u < 1.0 - 0.0331 * (x * x) * (x * x):
            return b * v, high, low
        if math.log(u) < 0.5 * x * x + b * (1.0 - v + math.log(v)):
            return b * v, high, low


_uniform = uniform
_standard_exponential = standard_exponential
_standard_normal = standard_normal
_standard_gamma = standard_gamma


@compiled(nogil=True)
def uniforms(states, out):
    """In [0, 1), as ``Generator.random``."""
    for b in range(len(states)):
        high, low, inc_high, inc_low = states[b]
        for i in range(b * BLOCK, (b + 1) * BLOCK):
            out[i], high, low = _uniform(high, low, inc_high, inc_low)
        states[b, 0], states[b, 1] = high, low


@compiled(nogil=True)
def exponentials(states, out, k, w, f):
    """As ``Generator.standard_exponential``; k, w, f: the tables of its ziggurat."""
    for b in range(len(states)):
        high, low, inc_high, inc_low = states[b]
        for i in range(b * BLOCK, (b + 1) * BLOCK):
            out[i], high, low = _standard_exponential(high, low, inc_high, inc_low, k, w, f)
        states[b, 0], states[b, 1] = high, low


@compiled(nogil=True)
def normals(states, out, k, w, f):
    """As ``Generator.standard_normal``; k, w, f: the tables of its ziggurat."""
    for b in range(len(states)):
        high, low, inc_high, inc_low = states[b]
        for i in range(b * BLOCK, (b + 1) * BLOCK):
            out[i], high, low = _standard_normal(high, low, inc_high, inc_low, k, w, f)
        states[b, 0], states[b, 1] = high, low


@compiled(nogil=True)
def gammas(states, out, shape, k, w, f):
    """As ``Generator.standard_gamma`` of a shape above 1; k, w, f: the tables of the normal's ziggurat."""
    for b in range(len(states)):
        high, low, inc_high, inc_low = states[b]
        for i in range(b * BLOCK, (b + 1) * BLOCK):
            out[i], high, low = _standard_gamma(high, low, inc_high, inc_low, shape, k, w, f)
        states[b, 0], states[b, 1] = high, low


@compiled(nogil=True)
def bent(out, left, mode, right):
    """Uniforms in [0, 1) become triangular times, as ``Generator.triangular`` finds them. Source: distributions.c."""
    base, to_mode = right - left, mode - left
    share, rising, falling = to_mode / base, to_mode * base, (right - mode) * base
    for i in range(len(out)):
        if out[i] <= share:
            out[i] = left + math.sqrt(out[i] * rising)
        else:
            out[i] = right - math.sqrt((1.0 - out[i]) * falling)


class Ziggurat(NamedTuple):
    """256 layers; the names are numpy's.

    k    : (256,) uint64, below which a whole number lies within a layer for certain
    w    : (256,) width of a layer over the range of that number
    f    : (256,) density at the edge of a layer
    """

    k: Any
    w: Any
    f: Any


def exponential() -> Ziggurat:
    """Of the standard exponential. Raises ImportError or AttributeError where numba keeps no such tables."""
    from numba.np.random import _constants as numpys

    return Ziggurat(numpys.ke_double, numpys.we_double, numpys.fe_double)


def normal() -> Ziggurat:
    """Of the standard normal. Raises as ``exponential``."""
    from numba.np.random import _constants as numpys

    return Ziggurat(numpys.ki_double, numpys.wi_double, numpys.fi_double)


_NO_WORDS = np.empty(0, np.uint32)
exponential_table = cache(exponential)
normal_table = cache(normal)


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
        uniforms(self.states, out)
        return out

    def standard_exponential(self, size: int) -> np.ndarray:
        if self._generators is not None:
            return self._each(size, "standard_exponential")
        out = self._room(size)
        exponentials(self.states, out, *exponential_table())
        return out

    def standard_normal(self, size: int) -> np.ndarray:
        if self._generators is not None:
            return self._each(size, "standard_normal")
        out = self._room(size)
        normals(self.states, out, *normal_table())
        return out

    def standard_gamma(self, shape: float, size: int) -> np.ndarray:
        if shape == 1:
            return self.standard_exponential(size)
        if self._generators is not None or shape < 1:
            return self._each(size, "standard_gamma", shape)
        out = self._room(size)
        gammas(self.states, out, float(shape), *normal_table())
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
        bent(out, float(left), float(mode), float(right))
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
