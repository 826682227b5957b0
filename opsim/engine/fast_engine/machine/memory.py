"""Memory for structs and lists while the engine runs: from the end of a chunk, or from what was given back."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types

from opsim.engine.fast_engine.machine.compiling import inlined, intrinsic
from opsim.engine.fast_engine.machine.structs import I64, POINTER, Array, Pointer, cast, size_of, struct

SMALL, CLASSES = 128, 192
"""Sizes below SMALL x 16 bytes have a list of their own of what was given back; larger ones one for each power of 2,
to which they are rounded up."""


@struct
class Memory:
    """at, end : what is left of the last chunk; more : address of the function that makes another one

    free : by class of size, the first of what was given back, each leading to the next
    """

    at: int
    end: int
    more: int
    free: Array[int]


@intrinsic
def call_out(_typingctx: Any, address: Any, one: Any, other: Any) -> Any:
    """The answer of a C function at an address, ``int64 f(int64, int64)``.

    NOTE: where Python fails in it before its first ``try``, that is printed and lost, and the answer is anything: who
    calls looks at what should have been done.
    """

    def codegen(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        kind = ir.FunctionType(I64, [I64, I64])
        return builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])

    return types.int64(types.int64, types.int64, types.int64), codegen


@intrinsic
def words_at(_typingctx: Any, address: Any) -> Any:
    """The words at an address."""
    array = Pointer("int", "array")
    return array(types.int64), lambda _c, builder, _s, args: builder.inttoptr(args[0], POINTER)


@inlined
def class_of(n_bytes: int) -> int:
    """The class of a size, which is a multiple of 16."""
    if n_bytes < 16 * SMALL:
        return n_bytes // 16
    found, room = SMALL, 16 * SMALL
    while room < n_bytes:
        room <<= 1
        found += 1
    return found


@inlined
def room_of(which: int) -> int:
    """Bytes of a class."""
    return 16 * which if which < SMALL else (16 * SMALL) << (which - SMALL)


@inlined
def take_bytes(memory: Memory, n_bytes: int) -> int:
    """Address of so many bytes, a multiple of 16, all 0. Raises MemoryError."""
    which = class_of(n_bytes)
    at = memory.free[which]
    if at:
        memory.free[which] = words_at(at)[0]
    else:
        room = room_of(which)
        if memory.at + room > memory.end:
            call_out(memory.more, 0, room)
            if memory.at + room > memory.end:
                raise MemoryError
        at = memory.at
        memory.at = at + room
    words = words_at(at)
    for i in range(n_bytes >> 3):
        words[i] = 0
    return at


@inlined
def give_bytes_back(memory: Memory, at: int, n_bytes: int) -> None:
    """They can be taken again, for something as large."""
    which = class_of(n_bytes)
    words_at(at)[0] = memory.free[which]
    memory.free[which] = at


def fresh(struct_of: Any) -> Any:
    """A compiled function of the floor that gives a new struct, all its fields 0 or nothing."""
    n_bytes, made = size_of(struct_of), cast(struct_of)

    @inlined
    def new(floor):
        return made(take_bytes(floor.memory, n_bytes))

    return new


def give_back(struct_of: Any) -> Any:
    """A compiled function of the floor and a struct that nobody refers to any more."""
    from opsim.engine.fast_engine.machine.structs import address_of

    n_bytes = size_of(struct_of)

    @inlined
    def give(floor, one):
        give_bytes_back(floor.memory, address_of(one), n_bytes)

    return give
