"""Steps and what they are made of -> LLVM's text, from their syntax: kinds of values are found on the way, in one pass.

A name of a function has one kind throughout. Where a later line widens it (a number becomes a float, nothing becomes a
reference), the function is gone through once more. A helper without annotations is compiled for the kinds that it is
given, as formulas are.
"""

from __future__ import annotations

import ast
import os
import builtins
import struct
from collections import ChainMap
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from opsim.engine.fast_engine.machine.intrinsics import BUILTINS, POWER, Intrinsic
from opsim.engine.fast_engine.machine.structs import BOOL, FLOAT, INT, LAYOUTS, NONE, Kind, field_kind, said_kind

Value = tuple[str, Kind]
"""Its text in LLVM's language, and what it is."""


class NotSo(SyntaxError):
    """Something in a step that cannot be compiled; it says the file and the line."""


class _Widened(Exception):
    """A name is of a wider kind than was known before."""


class Helper:
    """A function that is compiled into those that call it where it is small; ``how`` : LLVM's word where it differs."""

    def __init__(self, function: Callable, how: str = ""):
        self.function, self.how = function, how

    def __call__(self, *given: Any) -> Any:
        return self.function(*given)


HOT = frozenset(os.environ.get("TRIAL_HOT", "").split())
METHODS: dict[tuple[str, str], Any] = {}
"""What a formula calls of ``self``, by the struct that stands for it and the name."""


@cache
def _functions_of(path: str) -> dict[tuple[int, str], ast.FunctionDef]:
    tree = ast.parse(Path(path).read_text(encoding="utf-8"), path)
    found = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    return {(min([n.lineno, *(one.lineno for one in n.decorator_list)]), n.name): n for n in found}


def syntax_of(function: Callable) -> ast.FunctionDef:
    code = function.__code__
    return _functions_of(code.co_filename)[code.co_firstlineno, code.co_name]


class Module:
    """The text of all functions that some steps need. STEPS know their lines of the table."""

    def __init__(self, steps: dict[int, Any], step_of: Callable[[Any], Any]):
        self.steps, self.step_of = steps, step_of
        self.texts: list[str] = []
        self.declared: dict[str, None] = {}
        self.errors: dict[tuple[Any, str], int] = {}
        self._helpers: dict[Any, Body] = {}

    def whole(self, roots: Iterable[Any]) -> str:
        """NOTE: every step can fail, as who calls by the table does not know which of them it is."""
        for one in roots:
            self.texts.append(
                Body(
                    self, one.function, one.kinds, one.answer, one.symbol, os.environ.get("TRIAL_STEP", ""), fails=True
                ).text()
            )
        return "\n".join([*self.declared, *self.texts])

    def helper(self, function: Any, how: str, kinds: tuple[Kind, ...]) -> Body:
        """A function for some kinds of arguments."""
        key = function, kinds, how
        if key not in self._helpers:
            name = f'@"{function.__qualname__}.{len(self._helpers)}"'
            answer = said_kind(function.__annotations__.get("return", "Any"))
            self._helpers[key] = made = Body(self, function, kinds, answer, name, f"internal {how}")
            self.texts.append(made.text())
        return self._helpers[key]


class Body:
    """Of one function for some kinds of arguments; ``answer``: None where it is to be found."""

    def __init__(
        self,
        module: Module,
        function: Any,
        kinds: Any,
        answer: Kind | None,
        name: str,
        how: str,
        *,
        fails: bool = False,
    ):
        self.module, self.function, self.kinds, self.name, self.how = module, function, kinds, name, how
        self.fails = fails
        self.answer, self.node = answer, syntax_of(function)
        self.names: dict[str, Kind] = {}
        self.widest: Kind | None = answer
        cells = {n: c.cell_contents for n, c in zip(function.__code__.co_freevars, function.__closure__ or ())}
        self.known = ChainMap(cells, function.__globals__, vars(builtins))

    def text(self) -> str:
        while True:
            try:
                return self._text()
            except _Widened:
                continue

    def _text(self) -> str:
        self.passes_on = False
        self.n, self.lines, self.loops, self.at, self.open = 0, list[Any](), list[tuple[str, str]](), "entry", True
        given = self.node.args
        names = [one.arg for one in given.args]
        for number, (name, kind) in enumerate(zip(names, self.kinds)):
            self._assign(name, (f"%a{number}", kind))
        if given.vararg is not None:
            rest = [(f"%a{number}", kind) for number, kind in enumerate(self.kinds)][len(names) :]
            self._assign(given.vararg.arg, self._tuple(rest))
        for name, default in zip(names[len(self.kinds) :], given.defaults[len(self.kinds) - len(names) :]):
            self._assign(name, self.value(default))
        self.body(self.node.body)
        answer = self.answer or self.widest or NONE
        if self.open:
            self.give("0" if answer == NONE else _zero(answer))
        if self.passes_on:
            self.put("failed:")
            self.give_up(self.op("load i64, ptr %state"))
        self.answer = answer
        kinds = ", ".join(f"{kind.llvm} %a{number}" for number, kind in enumerate(self.kinds))
        slots = [f"%v.{name} = alloca {kind.llvm}" for name, kind in self.names.items()]
        slots += ["%state = alloca i64"] if self.passes_on else []
        linkage, _, how = self.how.partition(" ")
        lines = [one if isinstance(one, str) else self._ended(number, *one) for number, one in enumerate(self.lines)]
        head = f"define {linkage} {self.returned} {self.name}({kinds}) nounwind {how} {{"
        return "\n".join([head, "entry:", *slots, *lines, "}", ""])

    @property
    def returned(self) -> str:
        """LLVM's word for what is answered: where it may fail, with 0 for fine, or the number of the failure and 1."""
        assert self.answer is not None
        if not self.fails:
            return "void" if self.answer == NONE else self.answer.llvm
        return f"{{{'i64' if self.answer == NONE else self.answer.llvm}, i64}}"

    def _ended(self, number: int, at: int, text: str) -> str:
        """The end of it: with an answer (at 0), or a failure (at 1)."""
        assert self.answer is not None
        if not self.fails:
            return "ret void" if self.answer == NONE else f"ret {self.answer.llvm} {text}"
        kind = "i64" if self.answer == NONE else self.answer.llvm
        empty = f"{{{kind}, i64}} {{{kind} poison, i64 0}}"
        given = f"i64 {text}" if at else f"{kind} {text}"
        return f"%r{number} = insertvalue {empty}, {given}, {at}\nret {self.returned} %r{number}"

    # ---- what is put down
    def put(self, line: str) -> None:
        self.lines.append(line)

    def op(self, line: str) -> str:
        self.n += 1
        self.lines.append(f"%x{self.n} = {line}")
        return f"%x{self.n}"

    def label(self) -> str:
        self.n += 1
        return f"l{self.n}"

    def end(self, line: str) -> None:
        self.put(line)
        self.open = False

    def give(self, text: str) -> None:
        self.lines.append((0, text))
        self.open = False

    def give_up(self, text: str) -> None:
        self.lines.append((1, text))
        self.open, self.fails = False, True

    def go(self, label: str) -> None:
        if self.open:
            self.end(f"br label %{label}")

    def begin(self, label: str) -> None:
        self.go(label)
        self.put(f"{label}:")
        self.at, self.open = label, True

    def declare(self, line: str) -> None:
        self.module.declared[line] = None

    def wrong(self, node: Any, words: str) -> NotSo:
        where = self.function.__code__.co_filename, node.lineno, node.col_offset + 1, ast.unparse(node)
        return NotSo(words, where)

    # ---- kinds
    def common(self, one: Kind, other: Kind) -> Kind:
        if one == other:
            return one
        if one.is_pointer and other.is_pointer:
            return other if one == NONE or one.of == "Any" else one
        if one.kind == other.kind == "tuple" and len(one.items) == len(other.items):
            return Kind("tuple", "", tuple(map(self.common, one.items, other.items)))
        if {one.kind, other.kind} <= {"int", "float", "bool"}:
            return FLOAT if FLOAT in (one, other) else INT
        raise TypeError(f"{one} and {other} in one place")

    def cast(self, value: Value, kind: Kind) -> str:
        text, found = value
        if found == kind or (found.is_pointer and kind.is_pointer):
            return text
        if kind == FLOAT and found in (INT, BOOL):
            if text.lstrip("-").isdigit():
                return _float(float(text))
            return self.op(f"{'si' if found == INT else 'ui'}tofp {found.llvm} {text} to double")
        if kind == INT and found == BOOL:
            return {"true": "1", "false": "0"}.get(text) or self.op(f"zext i1 {text} to i64")
        if kind == INT and found == FLOAT:
            return self.op(f"fptosi double {text} to i64")
        if kind == BOOL:
            return self.truth(value)
        if kind.kind == found.kind == "tuple":
            return self._tuple([(self.cast(v, k), k) for v, k in zip(self.items(value), kind.items)])[0]
        raise TypeError(f"{found} is no {kind}")

    def truth(self, value: Value) -> str:
        text, kind = value
        if kind == BOOL:
            return text
        if kind == NONE:
            return "false"
        if kind == FLOAT:
            return self.op(f"fcmp une double {text}, 0.0")
        if kind.kind == "list":
            text, kind = BUILTINS[len](self, value)
        return self.op(f"icmp ne {kind.llvm} {text}, {_zero(kind)}")

    def items(self, value: Value) -> list[Value]:
        text, kind = value
        return [(self.op(f"extractvalue {kind.llvm} {text}, {i}"), one) for i, one in enumerate(kind.items)]

    def _tuple(self, values: list[Value]) -> Value:
        kind, made = Kind("tuple", "", tuple(one[1] for one in values)), "undef"
        for i, (text, item) in enumerate(values):
            made = self.op(f"insertvalue {kind.llvm} {made}, {item.llvm} {text}, {i}")
        return made, kind

    # ---- statements
    def body(self, statements: list[ast.stmt]) -> None:
        for node in statements:
            if not self.open:
                return
            try:
                getattr(self, "on_" + type(node).__name__, self._unknown)(node)
            except (TypeError, KeyError, AttributeError, ValueError) as error:
                raise self.wrong(node, f"{type(error).__name__}: {error}") from error

    def _unknown(self, node: Any) -> Any:
        raise self.wrong(node, f"no {type(node).__name__} in a step")

    def _assign(self, name: str, value: Value) -> None:
        before = self.names.get(name)
        kind = value[1] if before is None else self.common(before, value[1])
        self.names[name] = kind
        if before not in (None, kind):
            raise _Widened
        self.put(f"store {kind.llvm} {self.cast(value, kind)}, ptr %v.{name}")

    def on_Pass(self, node: ast.Pass) -> None:
        pass

    def on_Expr(self, node: ast.Expr) -> None:
        if not isinstance(node.value, ast.Constant):
            self.value(node.value, False)

    def on_Assign(self, node: ast.Assign) -> None:
        target, given = node.targets[0], node.value
        if isinstance(target, ast.Tuple) and isinstance(given, ast.Tuple):
            values = [self.value(one) for one in given.elts]
            for one, value in zip(target.elts, values, strict=True):
                self.store(one, value)
            return
        value = self.value(given)
        for one in node.targets:
            self.store(one, value)

    def on_AnnAssign(self, node: ast.AnnAssign) -> None:
        assert node.value is not None
        self.store(node.target, self.value(node.value))

    def on_AugAssign(self, node: ast.AugAssign) -> None:
        before = self.value(_loaded(node.target))
        self.store(node.target, self.binary(type(node.op), before, self.value(node.value), node))

    def store(self, target: ast.expr, value: Value) -> None:
        if isinstance(target, ast.Name):
            self._assign(target.id, value)
        elif isinstance(target, ast.Tuple):
            for one, item in zip(target.elts, self.items(value), strict=True):
                self.store(one, item)
        else:
            at, kind = self.place(target)
            self.put(f"store {kind.llvm} {self.cast(value, kind)}, ptr {at}")

    def place(self, node: Any) -> Value:
        """Where a field or an item is, and its kind."""
        of, kind = self.value(node.value)
        if isinstance(node, ast.Attribute):
            field = LAYOUTS[kind.of].fields[node.attr]
            return self.op(f"getelementptr inbounds i8, ptr {of}, i64 {field.at}"), field_kind(field)
        index = self.cast(self.value(node.slice), INT)
        if kind.kind == "list":
            data, first = self.op(f"load ptr, ptr {of}"), self.op(f"getelementptr inbounds i64, ptr {of}, i64 1")
            of = self.op(f"getelementptr i64, ptr {data}, i64 {self.op(f'load i64, ptr {first}')}")
        elif kind.kind != "array":
            raise TypeError(f"{kind} has no items")
        return self.op(f"getelementptr inbounds i64, ptr {of}, i64 {index}"), kind.item

    def on_Delete(self, node: ast.Delete) -> None:
        of = node.targets[0]
        if len(node.targets) > 1 or not isinstance(of, ast.Subscript):
            raise self.wrong(node, "'del' takes one item out of a list in a step")
        self.machine("drop_at", [self.value(of.value), self.value(of.slice)])

    def on_Return(self, node: ast.Return) -> None:
        value = ("null", NONE) if node.value is None else self.value(node.value)
        if self.answer is None:
            wider = value[1] if self.widest is None else self.common(self.widest, value[1])
            before, self.widest = self.widest, wider
            if before not in (None, wider):
                raise _Widened
        wanted = self.answer or self.widest
        assert wanted is not None
        self.give("0" if wanted == NONE else self.cast(value, wanted))

    def on_Raise(self, node: ast.Raise) -> None:
        said = node.exc
        kind = self.static(said.func if isinstance(said, ast.Call) else said)
        words = said.args[0].value if isinstance(said, ast.Call) else ""  # type: ignore[attr-defined]
        self.fail(kind, words)

    def fail(self, kind: Any, words: str) -> None:
        number = self.module.errors.setdefault((kind, words), len(self.module.errors))
        self.give_up(str(number + 1))

    def on_If(self, node: ast.If) -> None:
        yes, no, after = self.label(), self.label(), self.label()
        self.jump(node.test, yes, no)
        self.begin(yes)
        self.body(node.body)
        self.go(after)
        self.begin(no)
        self.body(node.orelse)
        self.go(after)
        self.begin(after)

    def on_While(self, node: ast.While) -> None:
        if node.orelse:
            self._unknown(node)
        again, inside, after = self.label(), self.label(), self.label()
        self.begin(again)
        self.jump(node.test, inside, after)
        self._loop(node.body, inside, again, after)

    def _loop(self, body: list[ast.stmt], inside: str, again: str, after: str) -> None:
        self.begin(inside)
        self.loops.append((again, after))
        self.body(body)
        self.loops.pop()
        self.go(again)
        self.begin(after)

    def on_Break(self, node: ast.Break) -> None:
        self.go(self.loops[-1][1])

    def on_Continue(self, node: ast.Continue) -> None:
        self.go(self.loops[-1][0])

    def on_For(self, node: ast.For) -> None:
        if node.orelse or not isinstance(node.target, ast.Name):
            raise self.wrong(node, "'for' takes the items of one list, each by a name, and has no 'else' in a step")
        counted = (
            isinstance(node.iter, ast.Call) and isinstance(node.iter.func, ast.Name) and node.iter.func.id == "range"
        )
        if counted:
            given = [self.cast(self.value(one), INT) for one in node.iter.args]  # type: ignore[attr-defined]
            first, last, by = {1: ["0", *given, "1"], 2: [*given, "1"], 3: given}[len(given)]
        else:
            items = self.value(node.iter)
            if items[1].kind != "list":
                raise TypeError("'for' goes through a list")
            first, last, by = "0", "", "1"
        self.n += 1
        counter = f".{self.n}"
        self._assign(counter, (first, INT))
        top, inside, again, after = (self.label() for _ in range(4))
        self.begin(top)
        at = self.op(f"load i64, ptr %v.{counter}")
        goes = last or BUILTINS[len](self, items)[0]
        goes_on = self.op(f"icmp {'sgt' if by.startswith('-') else 'slt'} i64 {at}, {goes}")
        self.end(f"br i1 {goes_on}, label %{inside}, label %{after}")
        self.begin(inside)
        if counted:
            self._assign(node.target.id, (at, INT))
        else:
            self._assign(node.target.id, self.item(items, at))
        self.loops.append((again, after))
        self.body(node.body)
        self.loops.pop()
        self.begin(again)
        following = self.op(f"add i64 {self.op(f'load i64, ptr %v.{counter}')}, {by}")
        self.put(f"store i64 {following}, ptr %v.{counter}")
        self.go(top)
        self.begin(after)

    def item(self, items: Value, at: str) -> Value:
        of, kind = items
        data, first = self.op(f"load ptr, ptr {of}"), self.op(f"getelementptr inbounds i64, ptr {of}, i64 1")
        of = self.op(f"getelementptr i64, ptr {data}, i64 {self.op(f'load i64, ptr {first}')}")
        return self.load(self.op(f"getelementptr inbounds i64, ptr {of}, i64 {at}"), kind.item)

    def load(self, at: str, kind: Kind) -> Value:
        return (at if kind.kind == "list" else self.op(f"load {kind.llvm}, ptr {at}")), kind

    # ---- conditions
    def jump(self, node: ast.expr, yes: str, no: str) -> None:
        """Go one way or the other."""
        if isinstance(node, ast.BoolOp):
            both = isinstance(node.op, ast.And)
            for one in node.values[:-1]:
                more = self.label()
                self.jump(one, *((more, no) if both else (yes, more)))
                self.begin(more)
            self.jump(node.values[-1], yes, no)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            self.jump(node.operand, no, yes)
        else:
            self.end(f"br i1 {self.truth(self.value(node))}, label %{yes}, label %{no}")

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
        kind = self.common(one[1], other[1])
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

    # ---- values
    def value(self, node: ast.expr, wanted: bool = True) -> Value:
        if isinstance(node, ast.Call):
            return self.call(node, wanted)
        return getattr(self, "of_" + type(node).__name__, self._unknown)(node)

    def of_Constant(self, node: ast.Constant) -> Value:
        return self.constant(node.value)

    def constant(self, value: Any) -> Value:
        if isinstance(value, bool):
            return str(value).lower(), BOOL
        if isinstance(value, int):
            return str(int(value)), INT
        if isinstance(value, float):
            return _float(value), FLOAT
        if isinstance(value, tuple):
            return self._tuple([self.constant(one) for one in value])
        if value is None:
            return "null", NONE
        raise TypeError(f"{value!r} is no value of a step")

    def of_Name(self, node: ast.Name) -> Value:
        if node.id in self.names:
            kind = self.names[node.id]
            return self.op(f"load {kind.llvm}, ptr %v.{node.id}"), kind
        return self.constant(self.known[node.id])

    def static(self, node: Any) -> Any:
        """What a name stands for when this is compiled; NotImplemented: nothing that is known then."""
        if isinstance(node, ast.Name) and node.id not in self.names:
            return self.known[node.id]
        if isinstance(node, ast.Attribute):
            of = self.static(node.value)
            return getattr(of, node.attr) if isinstance(of, (ModuleType, type)) else NotImplemented
        return NotImplemented

    def of_Attribute(self, node: ast.Attribute) -> Value:
        known = self.static(node)
        return self.constant(known) if known is not NotImplemented else self.load(*self.place(node))

    def of_Subscript(self, node: ast.Subscript) -> Value:
        if isinstance(node.slice, ast.Constant):
            of = self.value(node.value)
            if of[1].kind == "tuple":
                return self.items(of)[node.slice.value]
        return self.load(*self.place(node))

    def of_Tuple(self, node: ast.Tuple) -> Value:
        values: list[Value] = []
        for one in node.elts:
            values += self.items(self.value(one.value)) if isinstance(one, ast.Starred) else [self.value(one)]
        return self._tuple(values)

    def of_IfExp(self, node: ast.IfExp) -> Value:
        parts = (lambda: self.value(node.body)), (lambda: self.value(node.orelse))
        return self.either(lambda yes, no: self.jump(node.test, yes, no), parts)

    def of_BoolOp(self, node: ast.BoolOp) -> Value:
        first = self.value(node.values[0])
        rest = node.values[1:]
        more: Any = rest[0] if len(rest) == 1 else ast.BoolOp(node.op, rest)

        def test(yes: str, no: str) -> None:
            self.end(f"br i1 {self.truth(first)}, label %{yes}, label %{no}")

        parts = (lambda: self.value(more)), (lambda: first)
        if isinstance(node.op, ast.Or):
            return self.either(test, parts[::-1])
        return self.either(test, parts)

    def of_UnaryOp(self, node: ast.UnaryOp) -> Value:
        value = self.value(node.operand)
        if isinstance(node.op, ast.Not):
            return self.op(f"xor i1 {self.truth(value)}, true"), BOOL
        if isinstance(node.op, ast.Invert):
            return self.op(f"xor i64 {self.cast(value, INT)}, -1"), INT
        if value[1] == FLOAT:
            return self.op(f"fneg double {value[0]}"), FLOAT
        text = self.cast(value, INT)
        return (f"-{text}" if text.isdigit() else self.op(f"sub i64 0, {text}")), INT

    def of_BinOp(self, node: ast.BinOp) -> Value:
        return self.binary(type(node.op), self.value(node.left), self.value(node.right), node)

    def binary(self, sign: Any, left: Value, right: Value, node: Any) -> Value:
        kind = FLOAT if sign is ast.Div else self.common(left[1], right[1])
        kind = INT if kind == BOOL else kind
        if sign is ast.Pow:
            return self._power(left, right)
        a, b = self.cast(left, kind), self.cast(right, kind)
        if sign in (ast.Div, ast.FloorDiv, ast.Mod):
            self._not_zero(b, kind)
        if sign in (ast.FloorDiv, ast.Mod):
            name = f"{'floor_of' if sign is ast.FloorDiv else 'rest_of'}_{kind.kind}s"
            return self.machine(name, [(a, kind), (b, kind)])
        word = _WORDS[sign]
        if kind == FLOAT:
            return self.op(f"f{word} double {a}, {b}"), FLOAT
        return self.op(f"{word} i64 {a}, {b}"), INT

    def _not_zero(self, text: str, kind: Kind) -> None:
        if text.lstrip("-").isdigit() or text.startswith("0x"):
            return
        bad, fine = self.label(), self.label()
        zero = self.op(f"fcmp oeq double {text}, 0.0" if kind == FLOAT else f"icmp eq i64 {text}, 0")
        self.end(f"br i1 {zero}, label %{bad}, label %{fine}, !prof !0")
        self.begin(bad)
        self.fail(ZeroDivisionError, "division by zero")
        self.begin(fine)

    def _power(self, left: Value, right: Value) -> Value:
        """Of a whole number that is known: a product, as numba has it."""
        if right[1] == INT and right[0].isdigit() and int(right[0]) in (2, 3):
            square = self.binary(ast.Mult, left, left, None)
            return square if right[0] == "2" else self.binary(ast.Mult, square, left, None)
        return POWER(self, left, right)

    def of_Compare(self, node: ast.Compare) -> Value:
        left = self.value(node.left)
        found: list[str] = []
        for sign, one in zip(node.ops, node.comparators):
            if isinstance(sign, (ast.In, ast.NotIn)):
                found.append(self._in(left, one, isinstance(sign, ast.NotIn)))
                continue
            right = self.value(one)
            found.append(self.compare(_SIGNS[type(sign)], left, right))
            left = right
        text = found[0]
        for more in found[1:]:  # NOTE: all are looked at, which nobody can tell
            text = self.op(f"and i1 {text}, {more}")
        return text, BOOL

    def compare(self, sign: str, left: Value, right: Value) -> str:
        kind = self.common(left[1], right[1])
        if kind.kind == "tuple":
            return self._compare_tuples(sign, self.items(left), self.items(right))
        a, b = self.cast(left, kind), self.cast(right, kind)
        if kind == FLOAT:
            return self.op(f"fcmp {'une' if sign == 'ne' else 'o' + sign} double {a}, {b}")
        word = sign if sign in ("eq", "ne") else "s" + sign
        return self.op(f"icmp {word} {kind.llvm} {a}, {b}")

    def _compare_tuples(self, sign: str, left: list[Value], right: list[Value]) -> str:
        """By the first items that differ."""
        last = self.compare(sign, left[-1], right[-1])
        for one, other in reversed(list(zip(left[:-1], right[:-1]))):
            same = self.compare("eq", one, other)
            first = {"eq": "false", "ne": "true"}.get(sign) or self.compare(sign[0] + "t", one, other)
            last = self.op(f"select i1 {same}, i1 {last}, i1 {first}")
        return last

    def _in(self, value: Value, node: ast.expr, is_not: bool) -> str:
        known = self.static(node)
        if isinstance(node, ast.Tuple) or isinstance(known, tuple):
            ones = [self.value(one) for one in node.elts] if isinstance(node, ast.Tuple) else map(self.constant, known)
            text = "false"
            for one in ones:
                text = self.op(f"or i1 {text}, {self.compare('eq', value, one)}")
        else:
            text = self.machine("has", [self.value(node), value])[0]
        return self.op(f"xor i1 {text}, true") if is_not else text

    # ---- calls
    def machine(self, name: str, values: list[Value]) -> Value:
        """A function of ``lists``, which every step knows."""
        from opsim.engine.fast_engine.machine import lists

        return self.called(getattr(lists, name), values)

    def call(self, node: ast.Call, wanted: bool) -> Value:
        given: list[Value] = []
        known = self.static(node.func)
        if known is NotImplemented:
            assert isinstance(node.func, ast.Attribute), "a call of what is not known"
            return self._method(node, node.func, wanted)
        for one in node.args:
            given += self.items(self.value(one.value)) if isinstance(one, ast.Starred) else [self.value(one)]
        return self.called(known, given, {one.arg: self.value(one.value) for one in node.keywords})

    def called(self, known: Any, given: list[Value], named: dict[Any, Value] | None = None) -> Value:
        if isinstance(known, Intrinsic):
            return known.emit(self, *given)  # type: ignore[return-value]
        if (emit := BUILTINS.get(known)) is not None:
            return emit(self, *given)
        one = self.module.step_of(known)
        if one is not None:
            return self._invoke(
                one.symbol, one.answer, [(self.cast(v, k), k) for v, k in zip(given, one.kinds, strict=True)]
            )
        function, how = (known.function, known.how) if isinstance(known, Helper) else (known, "")
        how = how or ("inlinehint" if function.__name__ in HOT else "")
        names = [parameter.arg for parameter in syntax_of(function).args.args]
        given += [named[name] for name in names[len(given) :] if named and name in named]
        values = []
        for number, value in enumerate(given):
            said = said_kind(function.__annotations__.get(names[number], "Any")) if number < len(names) else None
            kind = said if said is not None and names[number] != "self" else value[1]
            values.append((self.cast(value, kind), kind))
        made = self.module.helper(function, how, tuple(kind for _, kind in values))
        assert made.answer is not None
        return self._invoke(made.name, made.answer, values, fails=made.fails)

    def _invoke(self, name: str, answer: Kind, values: list[Value], *, fails: bool = True) -> Value:
        given = ", ".join(f"{kind.llvm} {text}" for text, kind in values)
        if not fails and answer == NONE:
            self.put(f"call void {name}({given})")
            return "null", NONE
        if not fails:
            return self.op(f"call {answer.llvm} {name}({given})"), answer
        kind = f"{{{'i64' if answer == NONE else answer.llvm}, i64}}"
        both, fine = self.op(f"call {kind} {name}({given})"), self.label()
        state = self.op(f"extractvalue {kind} {both}, 1")
        self.put(f"store i64 {state}, ptr %state")
        self.passes_on = self.fails = True
        self.end(f"br i1 {self.op(f'icmp ne i64 {state}, 0')}, label %failed, label %{fine}, !prof !0")
        self.begin(fine)
        return ("null" if answer == NONE else self.op(f"extractvalue {kind} {both}, 0")), answer

    def _method(self, node: ast.Call, func: ast.Attribute, wanted: bool) -> Value:
        if func.attr == "line" or func.attr.endswith("_line"):
            line = self.cast(self.value(func), INT)
            values = [self.value(one) for one in node.args]
            table = self.op(f"load ptr, ptr {values[0][0]}")
            function = self.op(f"load ptr, ptr {self.op(f'getelementptr ptr, ptr {table}, i64 {line}')}")
            values = [(self.cast(one, INT), INT) if one[1] == BOOL else one for one in values]
            return self._invoke(function, INT if wanted else NONE, values)
        of, given = self.value(func.value), [self.value(one) for one in node.args]
        if of[1].kind != "list":
            return self.called(METHODS[of[1].of, func.attr], [of, *given])
        if func.attr == "pop":
            return self.machine("pop_first" if given else "pop_last", [of])
        floor = [self.value(ast.Name("floor", ast.Load()))] if func.attr in ("append", "insert") else []
        return self.machine({"append": "push"}.get(func.attr, func.attr), [*floor, of, *given])


_WORDS = {
    ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div", ast.BitAnd: "and", ast.BitOr: "or",
    ast.BitXor: "xor", ast.LShift: "shl", ast.RShift: "ashr",
}  # fmt: skip
_SIGNS = {
    ast.Eq: "eq", ast.Is: "eq", ast.NotEq: "ne", ast.IsNot: "ne", ast.Lt: "lt", ast.LtE: "le", ast.Gt: "gt",
    ast.GtE: "ge",
}  # fmt: skip


def _loaded(node: Any) -> ast.expr:
    """A target as a value."""
    made = type(node)(**{name: getattr(node, name) for name in node._fields})
    made.ctx = ast.Load()
    return ast.copy_location(made, node)


def _zero(kind: Kind) -> str:
    if kind.kind == "tuple":
        return "zeroinitializer"
    return {"int": "0", "float": "0.0", "bool": "false"}.get(kind.kind, "null")


def _float(value: float) -> str:
    return f"0x{int.from_bytes(struct.pack('>d', value), 'big'):016X}"
