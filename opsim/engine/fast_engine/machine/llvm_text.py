"""The text of one function in LLVM's language: what is put down line by line, and values with their kinds."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

from opsim.engine.fast_engine.machine.structs import BOOL, FLOAT, INT, NONE, Kind

Value = tuple[str, Kind]
"""Its text in LLVM's language, and what it is."""


class NotSo(SyntaxError):
    """Something in a step that cannot be compiled; it says the file and the line."""


class Text:
    """Lines of a function under way. ``open`` : whether the block at hand, ``at``, has no end yet

    answer : None where it is to be found; fails : whether a failure is answered too
    """

    def __init__(self, answer: Kind | None, *, fails: bool):
        self.answer, self.fails = answer, fails
        self.begin_anew()

    def begin_anew(self) -> None:
        """Nothing is put down yet."""
        self.n, self.at, self.open = 0, "entry", True
        self.lines: list[Any] = []

    def put(self, line: str) -> None:
        """A line."""
        self.lines.append(line)

    def op(self, line: str) -> str:
        """A line with a value, and the name of that."""
        self.n += 1
        self.lines.append(f"%x{self.n} = {line}")
        return f"%x{self.n}"

    def label(self) -> str:
        """Of a block to come."""
        self.n += 1
        return f"l{self.n}"

    def end(self, line: str) -> None:
        """The line that ends a block."""
        self.put(line)
        self.open = False

    def give(self, text: str) -> None:
        """Return a value."""
        self.lines.append((0, text))
        self.open = False

    def give_up(self, text: str) -> None:
        """Return the number of a failure."""
        self.lines.append((1, text))
        self.open, self.fails = False, True

    def go(self, label: str) -> None:
        """To a block, from wherever this one has no end yet."""
        if self.open:
            self.end(f"br label %{label}")

    def begin(self, label: str) -> None:
        """A block."""
        self.go(label)
        self.put(f"{label}:")
        self.at, self.open = label, True

    @property
    def returned(self) -> str:
        """LLVM's word for what is answered: where it may fail, beside 0 or a failure's number."""
        assert self.answer is not None
        if not self.fails:
            return "void" if self.answer == NONE else self.answer.llvm
        return f"{{{'i64' if self.answer == NONE else self.answer.llvm}, i64}}"

    def ended(self, number: int, at: int, text: str) -> str:
        """A way out of it: with the answer (at 0), or a failure's number (at 1)."""
        assert self.answer is not None
        if not self.fails:
            return "ret void" if self.answer == NONE else f"ret {self.answer.llvm} {text}"
        kind = "i64" if self.answer == NONE else self.answer.llvm
        empty = f"{{{kind}, i64}} {{{kind} poison, i64 0}}"
        given = f"i64 {text}" if at else f"{kind} {text}"
        return f"%r{number} = insertvalue {empty}, {given}, {at}\nret {self.returned} %r{number}"

    def cast(self, value: Value, kind: Kind) -> str:
        """A value as one of another kind. Raises TypeError."""
        text, found = value
        if found == kind or (found.is_pointer and kind.is_pointer):
            return text
        if kind == FLOAT and found in (INT, BOOL):
            if text.lstrip("-").isdigit():
                return float_text(float(text))
            return self.op(f"{'si' if found == INT else 'ui'}tofp {found.llvm} {text} to double")
        if kind == INT and found == BOOL:
            return {"true": "1", "false": "0"}.get(text) or self.op(f"zext i1 {text} to i64")
        if kind == INT and found == FLOAT:
            return self.op(f"fptosi double {text} to i64")
        if kind == BOOL:
            return self.truth(value)
        if kind.kind == found.kind == "tuple":
            return self.tuple_of([(self.cast(v, k), k) for v, k in zip(self.items(value), kind.items)])[0]
        raise TypeError(f"{found.said}, expected {kind.said}")

    def truth(self, value: Value) -> str:
        """Whether it is there, is not 0, or has items."""
        text, kind = value
        if kind == BOOL:
            return text
        if kind == NONE:
            return "false"
        if kind == FLOAT:
            return self.op(f"fcmp une double {text}, 0.0")
        if kind.kind == "list":
            text, kind = self.length(value), INT
        return self.op(f"icmp ne {kind.llvm} {text}, {zero(kind)}")

    def items(self, value: Value) -> list[Value]:
        """Of a tuple."""
        text, kind = value
        return [(self.op(f"extractvalue {kind.llvm} {text}, {i}"), one) for i, one in enumerate(kind.items)]

    def tuple_of(self, values: list[Value]) -> Value:
        """Some values as one."""
        kind, made = Kind("tuple", "", tuple(one[1] for one in values)), "undef"
        for i, (text, item) in enumerate(values):
            made = self.op(f"insertvalue {kind.llvm} {made}, {item.llvm} {text}, {i}")
        return made, kind

    def length(self, items: Value) -> str:
        """How many a list has: its word 2."""
        return self.op(f"load i64, ptr {self.op(f'getelementptr inbounds i64, ptr {items[0]}, i64 2')}")

    def load(self, at: str, kind: Kind) -> Value:
        """What stands at an address; a list is where it stands."""
        return (at if kind.kind == "list" else self.op(f"load {kind.llvm}, ptr {at}")), kind

    def either(self, test: Callable[[str, str], None], parts: tuple[Callable[[], Value], Callable[[], Value]]) -> Value:
        """The one value or the other."""
        labels, after = (self.label(), self.label()), self.label()
        test(*labels)
        ends = []
        for label, part in zip(labels, parts):
            self.begin(label)
            value = part()
            ends.append((value, self.at, len(self.lines)))
            self.open = False
        (one, _, first), (other, _, _) = ends
        kind = common(one[1], other[1])
        found = [self.cast(other, kind)]
        ends[1] = other, self.at, 0
        self.put(f"br label %{after}")
        rest, self.lines = self.lines[first:], self.lines[:first]
        found.insert(0, self.cast(one, kind))
        self.put(f"br label %{after}")
        self.lines += [*rest, f"{after}:"]
        self.at, self.open = after, True
        ways = ", ".join(f"[ {text}, %{at} ]" for text, (_, at, _) in zip(found, ends))
        return self.op(f"phi {kind.llvm} {ways}"), kind


def common(one: Kind, other: Kind) -> Kind:
    """The kind that two values have in one place. Raises TypeError."""
    if one == other:
        return one
    if one.is_pointer and other.is_pointer:
        return other if one == NONE or one.of == "Any" else one
    if one.kind == other.kind == "tuple" and len(one.items) == len(other.items):
        return Kind("tuple", "", tuple(map(common, one.items, other.items)))
    if {one.kind, other.kind} <= {"int", "float", "bool"}:
        return FLOAT if FLOAT in (one, other) else INT
    raise TypeError(f"{one.said} and {other.said} in one place")


def zero(kind: Kind) -> str:
    """Nothing of a kind."""
    if kind.kind == "tuple":
        return "zeroinitializer"
    return {"int": "0", "float": "0.0", "bool": "false"}.get(kind.kind, "null")


def float_text(value: float) -> str:
    """All of its bits."""
    return f"0x{int.from_bytes(struct.pack('>d', value), 'big'):016X}"
