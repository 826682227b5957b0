"""One number from the state of a generator, by numpy's algorithms: each gives (number, next state's halves).

Source: numpy/random/src/distributions/distributions.c. What stands in the same order there stands so here: another
order of sums would be another last bit.
"""

from __future__ import annotations

import math

import numpy as np

from opsim.engine.fast_engine.luck.seeds import stepped, word_of
from opsim.ergonomics.kernels.compiled import compiled

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
