"""What steps may call besides each other: helpers, and what LLVM has words of its own for, such as casts."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from opsim.engine.fast_engine.machine.llvm_text import common
from opsim.engine.fast_engine.machine.structs import BOOL, FLOAT, INT, NONE, Kind

Emit = Callable[..., tuple[str, Kind]]


class Intrinsic:
    """What is told in LLVM's words: a function of the text under way and of values (text, kind), that gives one."""

    def __init__(self, emit: Emit):
        self.emit = emit

    def __call__(self, *_: Any) -> Any:
        raise TypeError("it is compiled, and not called from Python")


class Helper:
    """A function that is compiled into those that call it where it is small; ``how`` : LLVM's words where they differ.

    From Python it is called as it is written.
    """

    def __init__(self, function: Callable, how: str = ""):
        self.function: Any = function
        self.how = how

    def __call__(self, *given: Any) -> Any:
        return self.function(*given)


def cast(struct: Any) -> Any:
    """A compiled function that takes a reference to anything, or an address, for one to a struct."""
    return taken_for(Kind("ref", struct.__name__))


def array_at(of: str) -> Any:
    """A compiled function that takes an address for that of an array: of ``int``, ``float`` or structs of a name."""
    return taken_for(Kind("array", of))


def taken_for(wanted: Kind) -> Any:
    """A compiled function that takes a reference or an address for one of another kind."""

    def emit(body: Any, value: Any) -> Any:
        return (body.op(f"inttoptr i64 {value[0]} to ptr") if value[1] == INT else value[0]), wanted

    return Intrinsic(emit)


words_at = array_at("int")


def _address_of(body: Any, value: Any) -> Any:
    return body.op(f"ptrtoint ptr {value[0]} to i64"), INT


def _word_at(body: Any, value: Any, index: Any) -> str:
    return str(body.op(f"getelementptr i64, ptr {value[0]}, i64 {index[0]}"))


def _word(body: Any, value: Any, index: Any) -> Any:
    return body.op(f"load i64, ptr {_word_at(body, value, index)}"), INT


def _set_word(body: Any, value: Any, index: Any, new: Any) -> Any:
    body.put(f"store i64 {new[0]}, ptr {_word_at(body, value, index)}")
    return "null", NONE


def _call_out(body: Any, address: Any, one: Any, other: Any) -> Any:
    function, one, other = (body.cast(value, INT) for value in (address, one, other))
    at = body.op(f"inttoptr i64 {function} to ptr")
    return body.op(f"call i64 {at}(i64 {one}, i64 {other})"), INT


def _call_floats(body: Any, address: Any, *values: Any) -> Any:
    at = body.op(f"inttoptr i64 {address[0]} to ptr")
    return body.op(f"call double {at}({', '.join(f'{kind.llvm} {text}' for text, kind in values)})"), FLOAT


def _set(bits: int) -> Emit:
    def emit(body: Any, address: Any, item: Any, value: Any) -> Any:
        at = body.op(f"inttoptr i64 {address[0]} to ptr")
        at = body.op(f"getelementptr i{bits}, ptr {at}, i64 {item[0]}")
        body.put(f"store i{bits} {body.op(f'trunc i64 {value[0]} to i{bits}')}, ptr {at}")
        return "null", NONE

    return emit


def _of_floats(name: str) -> Emit:
    """A function of C's library, or LLVM's name for it."""

    def emit(body: Any, *values: Any) -> Any:
        given = ["double"] * len(values)
        body.module.declare(f"declare double @{name}({', '.join(given)})")
        return body.op(f"call double @{name}({', '.join(f'double {body.cast(one, FLOAT)}' for one in values)})"), FLOAT

    return emit


def _lowest_bit(body: Any, bits: Any) -> Any:
    body.module.declare("declare i64 @llvm.cttz.i64(i64, i1)")
    return body.op(f"call i64 @llvm.cttz.i64(i64 {bits[0]}, i1 false)"), INT


def _smallest(sign: str) -> Emit:
    """``min`` or ``max``: of those alike the first, as Python has it."""

    def emit(body: Any, first: Any, *more: Any) -> Any:
        for one in more:
            kind = common(first[1], one[1])
            a, b = body.cast(first, kind), body.cast(one, kind)
            compare = f"fcmp o{sign} double" if kind == FLOAT else f"icmp s{sign} i64"
            better = body.op(f"{compare} {b}, {a}")
            first = body.op(f"select i1 {better}, {kind.llvm} {b}, {kind.llvm} {a}"), kind
        return first

    return emit


def _int(body: Any, value: Any) -> Any:
    return (body.op(f"fptosi double {value[0]} to i64") if value[1] == FLOAT else body.cast(value, INT)), INT


def _abs(body: Any, value: Any) -> Any:
    if value[1] == FLOAT:
        return _of_floats("llvm.fabs.f64")(body, value)
    less = body.op(f"icmp slt i64 {value[0]}, 0")
    return body.op(f"select i1 {less}, i64 {body.op(f'sub i64 0, {value[0]}')}, i64 {value[0]}"), INT


address_of, word, set_word = Intrinsic(_address_of), Intrinsic(_word), Intrinsic(_set_word)
call_out = Intrinsic(_call_out)
"""Ask Python: a function at an address is called with two numbers or addresses, and answers one."""
call_floats = Intrinsic(_call_floats)
"""The answer of a C function at an address, of numbers and floats as they are given."""
set_byte, set_half = Intrinsic(_set(8)), Intrinsic(_set(32))
"""``set_half(address, item, value)``: item of an array of int32 at an address; of int8."""
rounded = Intrinsic(_of_floats("llvm.rint.f64"))
lowest_bit = Intrinsic(_lowest_bit)
BUILTINS: dict[Any, Emit] = {
    len: lambda body, items: (body.length(items), INT),
    min: _smallest("lt"),
    max: _smallest("gt"),
    abs: _abs,
    int: _int,
    float: lambda body, value: (body.cast(value, FLOAT), FLOAT),
    bool: lambda body, value: (body.truth(value), BOOL),
    math.exp: _of_floats("llvm.exp.f64"),
    math.log: _of_floats("llvm.log.f64"),
    math.log2: _of_floats("llvm.log2.f64"),
    math.cos: _of_floats("llvm.cos.f64"),
    math.sin: _of_floats("llvm.sin.f64"),
    math.sqrt: _of_floats("llvm.sqrt.f64"),
    math.log1p: _of_floats("log1p"),
    math.fmod: _of_floats("fmod"),
    math.copysign: _of_floats("llvm.copysign.f64"),
}
POWER = _of_floats("llvm.pow.f64")
float_floor = Intrinsic(_of_floats("llvm.floor.f64"))
divided = Intrinsic(lambda body, a, b: (body.op(f"sdiv i64 {a[0]}, {b[0]}"), INT))
remainder = Intrinsic(lambda body, a, b: (body.op(f"srem i64 {a[0]}, {b[0]}"), INT))
