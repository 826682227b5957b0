"""Expressions of a step -> LLVM's text: their kinds are found on the way."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from types import FunctionType, ModuleType
from typing import Any

from opsim.engine.fast_engine.machine.intrinsics import BUILTINS, POWER, Helper, Intrinsic
from opsim.engine.fast_engine.machine.llvm_text import NotSo, Text, Value, common, float_text
from opsim.engine.fast_engine.machine.steps import STEPS, Line, Step
from opsim.engine.fast_engine.machine.structs import BOOL, FLOAT, INT, LAYOUTS, NONE, Kind, field_kind, said_kind
from opsim.problems import did_you_mean

METHODS: dict[tuple[str, str], Any] = {}
"""What a formula calls of ``self``, by the struct that stands for it and the name."""
LISTS: dict[str, Any] = {}
"""What a step says of lists and numbers, by its word: helpers, which ``lists`` puts here."""
_WORDS = {
    ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div", ast.BitAnd: "and", ast.BitOr: "or",
    ast.BitXor: "xor", ast.LShift: "shl", ast.RShift: "ashr",
}  # fmt: skip
_SIGNS = {
    ast.Eq: "eq", ast.Is: "eq", ast.NotEq: "ne", ast.IsNot: "ne", ast.Lt: "lt", ast.LtE: "le", ast.Gt: "gt",
    ast.GtE: "ge",
}  # fmt: skip


LISTED = "what may stand in one: DESIGN.md, 'The form of a rule of the floor'"


class Expressions(Text):
    """Of one function. ``names`` : kinds of its own; ``known`` : what all others stand for when it is compiled

    module : of all functions that are compiled together
    """

    names: dict[str, Kind]
    known: Mapping[str, Any]
    module: Any
    function: FunctionType
    passes_on: bool

    def wrong(self, node: Any, words: str) -> NotSo:
        """What is raised of a part of the function."""
        where = self.function.__code__.co_filename, node.lineno, node.col_offset + 1, ast.unparse(node)
        return NotSo(words, where)

    def unknown(self, node: Any) -> Any:
        """Raises NotSo."""
        raise self.wrong(node, f"no {type(node).__name__} in a step; {LISTED}")

    def value(self, node: ast.expr) -> Value:
        """Of an expression."""
        if isinstance(node, ast.Call):
            return self.call(node)
        found: Value = getattr(self, "of_" + type(node).__name__, self.unknown)(node)
        return found

    def jump(self, node: ast.expr, yes: str, no: str) -> None:
        """Go one way or the other, by a condition."""
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

    def of_Constant(self, node: ast.Constant) -> Value:
        return self.constant(node.value)

    def constant(self, value: Any) -> Value:
        """What is known now. NOTE: who names the line of a step needs that step."""
        if isinstance(value, Line):
            self.module.wants(STEPS[value])
        if isinstance(value, bool):
            return str(value).lower(), BOOL
        if isinstance(value, int):
            return str(int(value)), INT
        if isinstance(value, float):
            return float_text(value), FLOAT
        if isinstance(value, tuple):
            return self.tuple_of([self.constant(one) for one in value])
        if value is None:
            return "null", NONE
        raise TypeError(f"{value!r} is no value of a step")

    def of_Name(self, node: ast.Name) -> Value:
        if node.id in self.names:
            kind = self.names[node.id]
            return self.op(f"load {kind.llvm}, ptr %v.{node.id}"), kind
        return self.constant(self._meaning(node))

    def _meaning(self, node: ast.Name) -> Any:
        if node.id not in self.known:
            raise self.wrong(node, f"no {node.id!r} is known here")
        return self.known[node.id]

    def static(self, node: Any) -> Any:
        """What a name stands for when this is compiled; NotImplemented: nothing that is known then."""
        if isinstance(node, ast.Name) and node.id not in self.names:
            return self._meaning(node)
        if isinstance(node, ast.Attribute):
            of = self.static(node.value)
            return getattr(of, node.attr) if isinstance(of, (ModuleType, type)) else NotImplemented
        return NotImplemented

    def place(self, node: Any) -> Value:
        """Where a field or an item is, and its kind."""
        of, kind = self.value(node.value)
        if isinstance(node, ast.Attribute):
            field = self._field(node, kind)
            return self.op(f"getelementptr inbounds i8, ptr {of}, i64 {field.at}"), field_kind(field)
        return self._place_of_item((of, kind), self.cast(self.value(node.slice), INT))

    def _field(self, node: ast.Attribute, kind: Kind) -> Any:
        layout = LAYOUTS.get(kind.of) if kind.kind == "ref" else None
        if layout is None:
            raise self.wrong(node, f"{kind.said} has no fields")
        if node.attr not in layout.fields:
            near = did_you_mean(node.attr, layout.fields)
            raise self.wrong(node, f"{kind.of} has no {node.attr!r}; {near}")
        return layout.fields[node.attr]

    def _place_of_item(self, items: Value, index: str) -> Value:
        of, kind = items
        if kind.kind == "list":
            data, first = self.op(f"load ptr, ptr {of}"), self.op(f"getelementptr inbounds i64, ptr {of}, i64 1")
            of = self.op(f"getelementptr i64, ptr {data}, i64 {self.op(f'load i64, ptr {first}')}")
        elif kind.kind != "array":
            raise TypeError(f"{kind.said} has no items")
        return self.op(f"getelementptr inbounds i64, ptr {of}, i64 {index}"), kind.item

    def of_Attribute(self, node: ast.Attribute) -> Value:
        known = self.static(node)
        return self.constant(known) if known is not NotImplemented else self.load(*self.place(node))

    def of_Subscript(self, node: ast.Subscript) -> Value:
        if isinstance(node.slice, ast.Constant):
            of = self.value(node.value)
            if of[1].kind == "tuple" and isinstance(node.slice.value, int):
                return self.items(of)[node.slice.value]
        return self.load(*self.place(node))

    def item(self, items: Value, at: str) -> Value:
        """Of a list or an array."""
        return self.load(*self._place_of_item(items, at))

    def of_Tuple(self, node: ast.Tuple) -> Value:
        values: list[Value] = []
        for one in node.elts:
            values += self.items(self.value(one.value)) if isinstance(one, ast.Starred) else [self.value(one)]
        return self.tuple_of(values)

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
        return self.binary(type(node.op), self.value(node.left), self.value(node.right))

    def binary(self, sign: Any, left: Value, right: Value) -> Value:
        """Of two numbers."""
        kind = FLOAT if sign is ast.Div else common(left[1], right[1])
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
            square = self.binary(ast.Mult, left, left)
            return square if right[0] == "2" else self.binary(ast.Mult, square, left)
        return POWER(self, left, right)

    def of_Compare(self, node: ast.Compare) -> Value:
        left = self.value(node.left)
        found: list[str] = []
        for sign, one in zip(node.ops, node.comparators, strict=True):
            if isinstance(sign, (ast.In, ast.NotIn)):
                if one is not node.comparators[-1]:
                    raise self.wrong(node, "'in' stands alone in a step")
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
        """Whether it is so; floats and tuples as Python has it."""
        kind = common(left[1], right[1])
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
        for one, other in reversed(list(zip(left[:-1], right[:-1], strict=True))):
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

    def fail(self, kind: Any, words: str) -> None:
        """Raise it where this is run."""
        self.give_up(str(self.module.failure(kind.__name__, words)))

    def call(self, node: ast.Call, *, wanted: bool = True) -> Value:
        """Of a step, a helper, or a hook; ``wanted``: whether somebody takes the answer."""
        given: list[Value] = []
        known = self.static(node.func)
        if known is NotImplemented:
            if not isinstance(node.func, ast.Attribute):
                raise self.wrong(node, "nothing that is known is called")
            return self._method(node, node.func, wanted)
        for one in node.args:
            given += self.items(self.value(one.value)) if isinstance(one, ast.Starred) else [self.value(one)]
        return self.called(known, given, {one.arg: self.value(one.value) for one in node.keywords})

    def called(self, known: Any, given: list[Value], named: dict[Any, Value] | None = None) -> Value:
        """The answer of what is known now."""
        if isinstance(known, Intrinsic):
            return known.emit(self, *given)
        if (emit := BUILTINS.get(known)) is not None:
            return emit(self, *given)
        if isinstance(known, Step):
            _count(known.name, len(given), len(known.kinds), len(known.kinds))
            return self._step(known, [(self.cast(v, k), k) for v, k in zip(given, known.kinds, strict=True)])
        return self._helper(known, given, named or {})

    def _step(self, one: Step, values: list[Value]) -> Value:
        """NOTE: one that is compiled elsewhere is called by the table, as hooks are."""
        name = one.symbol if self.module.wants(one) else self._in_table(values[0], str(one.line))
        return self._invoke(name, one.answer, values)

    def _in_table(self, floor: Value, line: str) -> str:
        table = self.op(f"load ptr, ptr {floor[0]}")
        return self.op(f"load ptr, ptr {self.op(f'getelementptr ptr, ptr {table}, i64 {line}')}")

    def _helper(self, known: Any, given: list[Value], named: dict[Any, Value]) -> Value:
        function, how = (known.function, known.how) if isinstance(known, Helper) else (known, "")
        if not isinstance(function, FunctionType):
            raise TypeError(f"{known!r} is not compiled")
        parameters = self.module.syntax_of(function).args
        names = [one.arg for one in parameters.args]
        given = [*given, *(named[name] for name in names[len(given) :] if name in named)]
        least = len(names) - len(parameters.defaults)
        _count(function.__name__, len(given), least, len(given) if parameters.vararg else len(names))
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
            values = [(self.cast(one, INT), INT) if one[1] == BOOL else one for one in values]
            return self._invoke(self._in_table(values[0], line), INT if wanted else NONE, values)
        of, given = self.value(func.value), [self.value(one) for one in node.args]
        if of[1].kind != "list":
            if (of[1].of, func.attr) not in METHODS:
                raise self.wrong(node, f"{of[1].said} has no {func.attr!r} that is compiled")
            return self.called(METHODS[of[1].of, func.attr], [of, *given])
        if func.attr == "pop":
            if given not in ([], [("0", INT)]):
                raise TypeError("'pop' takes the last item out of a list, or the first one, pop(0), in a step")
            return self.machine("pop_first" if given else "pop_last", [of])
        floor = (
            [self.value(ast.copy_location(ast.Name("floor", ast.Load()), node))]
            if func.attr in ("append", "insert")
            else []
        )
        return self.machine(func.attr, [*floor, of, *given])

    def machine(self, name: str, values: list[Value]) -> Value:
        """What ``lists`` has for a word. Raises TypeError."""
        if name not in LISTS:
            raise TypeError(f"lists have no {name!r}; {did_you_mean(name, LISTS)}")
        return self.called(LISTS[name], values)


def _count(name: str, given: int, least: int, most: int) -> None:
    if not least <= given <= most:
        wanted = str(most) if least == most else f"{least} to {most}"
        raise TypeError(f"{name} is called with {given}, expected {wanted}")
