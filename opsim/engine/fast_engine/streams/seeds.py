"""From the key of a stream to the state of the generator of each of its blocks, as numpy finds it.

Sources: numpy/random/bit_generator.pyx (SeedSequence) and numpy/random/src/pcg64 (PCG64: XSL-RR 128/64).
A state is a row of four words of 64 bits: the number's upper and lower half, then those of its increment.
"""

from __future__ import annotations

from threading import Lock
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from opsim.ergonomics.kernels.compiled import compiled
from opsim.streams import _hashed as _hashed_streams


def _product_high(_typing: Any, one: Any, other: Any) -> Any:
    """The upper 64 of the 128 bits of ``one * other``, both uint64."""

    def emit(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        wide = ir.IntType(128)
        product = builder.mul(*(builder.zext(value, wide) for value in values))
        return builder.trunc(builder.lshr(product, ir.Constant(wide, 64)), ir.IntType(64))

    return types.uint64(types.uint64, types.uint64), emit


product_high: Any = intrinsic(_product_high)


POOL = 4
STATE_WORDS = 4
_INIT_A, _MULT_A = np.uint64(0x43B0D7E5), np.uint64(0x931E8875)
_INIT_B, _MULT_B = np.uint64(0x8B51F9DD), np.uint64(0x58F38DED)
_MIX_LEFT, _MIX_RIGHT = np.uint64(0xCA01F9DD), np.uint64(0x4973F715)
_WORD = np.uint64(0xFFFFFFFF)
_PCG_HIGH, _PCG_LOW = np.uint64(2549297995355413924), np.uint64(4865540595714422341)
_1, _16, _32, _58, _63, _64 = (np.uint64(n) for n in (1, 16, 32, 58, 63, 64))


@compiled(nogil=True)
def _hashed(value, multiplier):
    """A word of 32 bits and the next multiplier. NOTE: words are kept in 64 bits, where their products fit."""
    after = (multiplier * _MULT_A) & _WORD
    value = ((value ^ multiplier) * after) & _WORD
    return value ^ (value >> _16), after


@compiled(nogil=True)
def _mixed(one, other):
    mixed = (_MIX_LEFT * one - _MIX_RIGHT * other) & _WORD
    return mixed ^ (mixed >> _16)


@compiled(nogil=True)
def _stir_in(pool, value, multiplier):
    """One word of entropy goes into every word of the pool; the next multiplier."""
    for i in range(POOL):
        hashed, multiplier = _hashed(value, multiplier)
        pool[i] = _mixed(pool[i], hashed)
    return multiplier


@compiled(nogil=True)
def _pool_of(words, pool):
    """What every block of a stream has in common: the pool after the words of its key; the next multiplier."""
    multiplier = _INIT_A
    for i in range(POOL):
        pool[i], multiplier = _hashed(np.uint64(words[i]), multiplier)
    for i in range(POOL):
        for j in range(POOL):
            if i != j:
                hashed, multiplier = _hashed(pool[i], multiplier)
                pool[j] = _mixed(pool[j], hashed)
    for i in range(POOL, len(words)):
        multiplier = _stir_in(pool, np.uint64(words[i]), multiplier)
    return multiplier


@compiled(nogil=True)
def _drawn_from(pool, words):
    """``words`` become the words of 64 bits that a seed sequence gives out, the lower half of each first."""
    multiplier = _INIT_B
    for i in range(STATE_WORDS):
        pair = np.uint64(0)
        for half in range(2):
            value = pool[(2 * i + half) % POOL] ^ multiplier
            multiplier = (multiplier * _MULT_B) & _WORD
            value = (value * multiplier) & _WORD
            value ^= value >> _16
            pair |= value << (_32 * np.uint64(half))
        words[i] = pair


@compiled(nogil=True)
def stepped(high, low, inc_high, inc_low):
    """The next state of PCG64: the state times a constant, plus its increment, in 128 bits."""
    grown = low * _PCG_LOW
    next_low = grown + inc_low
    carry = np.uint64(next_low < grown)
    next_high = product_high(low, _PCG_LOW) + high * _PCG_LOW + low * _PCG_HIGH + inc_high + carry
    return next_high, next_low


@compiled(nogil=True)
def word_of(high, low):
    """The 64 random bits of a state: the halves across each other, turned by the topmost six bits."""
    both, turn = high ^ low, high >> _58
    return (both >> turn) | (both << ((_64 - turn) & _63))


@compiled(nogil=True)
def _begun(words, state):
    """The first state of PCG64 from the words of its seed sequence: number, then the stream it is on."""
    inc_high, inc_low = (words[2] << _1) | (words[3] >> _63), (words[3] << _1) | _1
    low = inc_low + words[1]
    high = inc_high + words[0] + np.uint64(low < inc_low)
    state[0], state[1] = stepped(high, low, inc_high, inc_low)
    state[2], state[3] = inc_high, inc_low


@compiled(nogil=True)
def _states(begun, names, ends, n_blocks, hashes, states):
    """``states`` of the first blocks of many streams, one stream after the other; see ``states_of``."""
    whole, shared = np.empty(POOL, np.uint64), np.empty(POOL, np.uint64)
    pool, drawn = np.empty(POOL, np.uint64), np.empty(STATE_WORDS, np.uint64)
    of_whole, at, row = _pool_of(begun, whole), 0, 0
    for stream in range(len(ends)):
        multiplier = of_whole
        for i in range(POOL):  # NOTE: pool[:] = shared would cost 1.7 s of compiling, for the words of its errors
            shared[i] = whole[i]
        while at < ends[stream]:
            multiplier = _stir_in(shared, np.uint64(names[at]), multiplier)
            at += 1
        for b in range(n_blocks[stream]):
            for i in range(POOL):
                pool[i] = shared[i]
            after = _stir_in(pool, np.uint64(hashes[b, 0]), multiplier)
            _stir_in(pool, np.uint64(hashes[b, 1]), after)
            _drawn_from(pool, drawn)
            _begun(drawn, states[row])
            row += 1


def states_of(begun, names, ends, n_blocks, hashes):
    """(N, 4) the states of the generators of the first blocks of many streams, one stream after the other.

    begun    : (at least 4,) uint32, read-only: what all keys begin with
    names    : uint32, what follows in each; ends : where it ends
    n_blocks : of each stream, N in all; hashes : (most of them, 2) uint32, the hashes of the block numbers
    """
    states = np.empty((int(n_blocks.sum()), STATE_WORDS), np.uint64)
    _states(begun, names, ends, n_blocks, hashes, states)
    return states


_NO_NAME, _NO_END = np.empty(0, np.uint32), np.zeros(1, np.int64)


def first_states(words, hashes):
    """(n, 4) the states of the generators of n blocks.

    words  : (at least 4,) uint32, read-only: the key of a stream as ``opsim.streams._key`` makes it
    hashes : (n, 2) uint32, the hashes of the block numbers
    """
    return states_of(words, _NO_NAME, _NO_END, np.array([len(hashes)]), hashes)


MOST_KEPT = 1 << 20
"""Of 64 items each. Blocks beyond are hashed each time they are asked for."""
_FIRST = 256


class BlockHashes:
    """A table that grows to twice its length where it ends; far beyond its end, blocks are hashed without it.

    NOTE: it is replaced whole, so who reads needs no lock.
    """

    def __init__(self) -> None:
        self._rows = np.empty((0, 2), np.uint32)
        self._lock = Lock()

    def of(self, first: int, n: int) -> np.ndarray:
        """(n, 2) uint32, C-contiguous: the hashes of blocks ``first`` and after."""
        rows = self._rows
        if first + n > len(rows):
            if first > 2 * max(len(rows), _FIRST) or first + n > MOST_KEPT:
                return _rows(first, first + n)
            rows = self._grown(first + n)
        return rows[first : first + n]

    def _grown(self, n: int) -> np.ndarray:
        with self._lock:
            known = self._rows
            if n > len(known):
                least = max(_FIRST, 1 << (n - 1).bit_length())
                self._rows = np.concatenate([known, _rows(len(known), least)])
            return self._rows


def _rows(first: int, end: int) -> np.ndarray:
    words = b"".join(map(_hashed_streams, range(first, end)))
    return np.frombuffer(words, np.uint32).reshape(-1, 2).copy()


BLOCK_HASHES = BlockHashes()
