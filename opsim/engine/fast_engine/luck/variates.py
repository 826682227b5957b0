"""The next 64 numbers of each of n generators.

Each kernel takes ``states`` (n, 4) uint64, which it moves on, and fills ``out`` (n * 64,) float64, block after block.
"""

from __future__ import annotations

import math

from opsim.engine.fast_engine.luck import ziggurats
from opsim.ergonomics.kernels.compiled import compiled
from opsim.streams import BLOCK

_uniform = ziggurats.uniform
_standard_exponential = ziggurats.standard_exponential
_standard_normal = ziggurats.standard_normal
_standard_gamma = ziggurats.standard_gamma


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
