"""Steps and what they are made of -> LLVM's text, from their syntax: kinds of values are found on the way, in one pass.

A name of a function has one kind throughout. Where a later line widens it (a number becomes a float, nothing becomes a
reference), the function is gone through once more. A helper without annotations is compiled for the kinds that it is
given, as formulas are.
"""

from __future__ import annotations

import ast
import builtins
from collections import ChainMap
from collections.abc import Callable, Iterable
from functools import cache
from hashlib import blake2b
from itertools import count
from types import FunctionType
from typing import Any

from opsim.engine.fast_engine.machine.code_cache import source_of
from opsim.engine.fast_engine.machine.expressions import Expressions
from opsim.engine.fast_engine.machine.llvm_text import Value, common, zero
from opsim.engine.fast_engine.machine.steps import Step
from opsim.engine.fast_engine.machine.structs import INT, NONE, Kind, said_kind


@cache
def _functions_of(path: str) -> dict[tuple[int, str], ast.FunctionDef]:
    tree = ast.parse(source_of(path), path)
    found = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    return {(min([n.lineno, *(one.lineno for one in n.decorator_list)]), n.name): n for n in found}


def syntax_of(function: FunctionType) -> ast.FunctionDef:
    """As it is written."""
    code = function.__code__
    return _functions_of(code.co_filename)[code.co_firstlineno, code.co_name]


class Module:
    """What is compiled together: some steps, all that these come to, and the helpers in them.

    is_elsewhere : whether the step of a line is compiled already, and called by the table
    steps : those in it, by their lines; calls : lines of those elsewhere; failures : what it may raise, by numbers
    functions : all that are in it
    """

    def __init__(self, roots: Iterable[Step], is_elsewhere: Callable[[int], bool]):
        self.is_elsewhere = is_elsewhere
        self.steps: dict[int, Step] = {}
        self.calls = set[int]()
        self.failures: dict[int, tuple[str, str]] = {}
        self.functions = set[FunctionType]()
        self._helpers: dict[Any, Body] = {}
        self._under_way, self._numbers = set[Any](), count()
        self._declared: dict[str, None] = {}
        self._texts: list[str] = []
        self._todo: list[Step] = []
        for one in roots:
            self.wants(one)
        while self._todo:
            one = self._todo.pop()
            # NOTE: every step can fail, as who calls by the table does not know which of them it is
            body = Body(self, one.function, one.kinds, one.answer, one.symbol, "internal noinline", fails=True)
            self._texts.append(body.text())

    @property
    def text(self) -> str:
        """All of it."""
        return "\n".join([*self._declared, *self._texts])

    def wants(self, one: Step) -> bool:
        """Whether a step that is come to is in this module, and not elsewhere."""
        if one.line in self.steps:
            return True
        if self.is_elsewhere(one.line):
            self.calls.add(one.line)
            return False
        self.steps[one.line] = one
        self._todo.append(one)
        return True

    def helper(self, function: FunctionType, how: str, kinds: tuple[Kind, ...]) -> Body:
        """A function for some kinds of arguments. Raises TypeError for one that calls itself."""
        key = function, kinds, how
        if key in self._under_way:
            raise TypeError(f"{function.__name__} calls itself, which only a step may")
        if key not in self._helpers:
            self._under_way.add(key)
            name = f'@"{function.__qualname__}.{next(self._numbers)}"'
            answer = said_kind(function.__annotations__.get("return", "Any"))
            made = Body(self, function, kinds, answer, name, f"internal {how}")
            self._texts.append(made.text())
            self._helpers[key] = made
            self._under_way.remove(key)
        return self._helpers[key]

    def syntax_of(self, function: FunctionType) -> ast.FunctionDef:
        """As it is written; it is in this module then."""
        self.functions.add(function)
        return syntax_of(function)

    def declare(self, line: str) -> None:
        """A function of C's library or of LLVM."""
        self._declared[line] = None

    def failure(self, name: str, words: str) -> int:
        """Its number, which is the same everywhere, and not 0."""
        number = 1 + int.from_bytes(blake2b(f"{name} {words}".encode(), digest_size=6).digest(), "little")
        self.failures[number] = name, words
        return number


class _Widened(Exception):
    """A name is of a wider kind than was known before."""


class Body(Expressions):
    """Of one function for some kinds of arguments. ``how`` : LLVM's words for it; ``loops`` : where to go on, and after

    widest : kind of what was returned so far
    """

    def __init__(
        self,
        module: Module,
        function: Any,
        kinds: tuple[Kind, ...],
        answer: Kind | None,
        name: str,
        how: str,
        *,
        fails: bool = False,
    ):
        super().__init__(answer, fails=fails)
        self.module, self.function, self.kinds, self.name, self.how = module, function, kinds, name, how
        self.node = module.syntax_of(function)
        self.names: dict[str, Kind] = {}
        self.widest: Kind | None = answer
        cells = {
            n: c.cell_contents for n, c in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True)
        }
        self.known = ChainMap(cells, function.__globals__, vars(builtins))

    def text(self) -> str:
        """All of it."""
        while True:
            try:
                return self._text()
            except _Widened:
                continue

    def _text(self) -> str:
        self.begin_anew()
        self.passes_on = False
        self.loops: list[tuple[str, str]] = []
        given = self.node.args
        names = [one.arg for one in given.args]
        for number, (name, kind) in enumerate(zip(names, self.kinds, strict=False)):
            self._assign(name, (f"%a{number}", kind))
        if given.vararg is not None:
            rest = [(f"%a{number}", kind) for number, kind in enumerate(self.kinds)][len(names) :]
            self._assign(given.vararg.arg, self.tuple_of(rest))
        for name, default in zip(
            names[len(self.kinds) :], given.defaults[len(self.kinds) - len(names) :], strict=False
        ):
            self._assign(name, self.value(default))
        self.body(self.node.body)
        answer = self.answer or self.widest or NONE
        if self.open:
            self.give("0" if answer == NONE else zero(answer))
        if self.passes_on:
            self.put("failed:")
            self.give_up(self.op("load i64, ptr %state"))
        self.answer = answer
        kinds = ", ".join(f"{kind.llvm} %a{number}" for number, kind in enumerate(self.kinds))
        slots = [f"%v.{name} = alloca {kind.llvm}" for name, kind in self.names.items()]
        slots += ["%state = alloca i64"] if self.passes_on else []
        linkage, _, how = self.how.partition(" ")
        lines = [one if isinstance(one, str) else self.ended(number, *one) for number, one in enumerate(self.lines)]
        head = f"define {linkage} {self.returned} {self.name}({kinds}) nounwind {how} {{"
        return "\n".join([head, "entry:", *slots, *lines, "}", ""])

    def body(self, statements: list[ast.stmt]) -> None:
        """Statements one after the other, as far as they are come to. Raises NotSo."""
        for node in statements:
            if not self.open:
                return
            try:
                getattr(self, "on_" + type(node).__name__, self.unknown)(node)
            except (TypeError, LookupError, AttributeError, ValueError) as error:
                raise self.wrong(node, str(error)) from error

    def _assign(self, name: str, value: Value) -> None:
        before = self.names.get(name)
        kind = value[1] if before is None else common(before, value[1])
        self.names[name] = kind
        if before not in (None, kind):
            raise _Widened
        self.put(f"store {kind.llvm} {self.cast(value, kind)}, ptr %v.{name}")

    def on_Pass(self, node: ast.Pass) -> None:
        pass

    def on_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call):
            self.call(node.value, wanted=False)
        elif not isinstance(node.value, ast.Constant):
            self.value(node.value)

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
        self.store(node.target, self.binary(type(node.op), before, self.value(node.value)))

    def store(self, target: ast.expr, value: Value) -> None:
        """Give a name, a field, an item, or several of those a value."""
        if isinstance(target, ast.Name):
            self._assign(target.id, value)
        elif isinstance(target, ast.Tuple):
            for one, item in zip(target.elts, self.items(value), strict=True):
                self.store(one, item)
        else:
            at, kind = self.place(target)
            self.put(f"store {kind.llvm} {self.cast(value, kind)}, ptr {at}")

    def on_Delete(self, node: ast.Delete) -> None:
        of = node.targets[0]
        if len(node.targets) > 1 or not isinstance(of, ast.Subscript) or isinstance(of.slice, ast.Slice):
            raise self.wrong(node, "'del' takes one item out of a list in a step")
        self.machine("drop_at", [self.value(of.value), self.value(of.slice)])

    def on_Return(self, node: ast.Return) -> None:
        value = ("null", NONE) if node.value is None else self.value(node.value)
        if self.answer is None:
            wider = value[1] if self.widest is None else common(self.widest, value[1])
            before, self.widest = self.widest, wider
            if before not in (None, wider):
                raise _Widened
        wanted = self.answer or self.widest
        assert wanted is not None
        self.give("0" if wanted == NONE else self.cast(value, wanted))

    def on_Raise(self, node: ast.Raise) -> None:
        said = node.exc
        kind = self.static(said.func if isinstance(said, ast.Call) else said)
        words = said.args[0].value if isinstance(said, ast.Call) and said.args else ""  # type: ignore[attr-defined]
        self.fail(kind, words)

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
            self.unknown(node)
        again, inside, after = self.label(), self.label(), self.label()
        self.begin(again)
        self.jump(node.test, inside, after)
        self.begin(inside)
        self._loop(node.body, again, after)
        self.go(again)
        self.begin(after)

    def on_Break(self, node: ast.Break) -> None:
        self.go(self.loops[-1][1])

    def on_Continue(self, node: ast.Continue) -> None:
        self.go(self.loops[-1][0])

    def on_For(self, node: ast.For) -> None:
        if node.orelse or not isinstance(node.target, ast.Name):
            raise self.wrong(node, "'for' takes the items of one list, each by a name, and has no 'else' in a step")
        if isinstance(node.iter, ast.Call) and ast.unparse(node.iter.func) == "range":
            given = [self.cast(self.value(one), INT) for one in node.iter.args]
            first, last, by = {1: ["0", *given, "1"], 2: [*given, "1"], 3: given}[len(given)]
            if not by.lstrip("-").isdigit():
                raise TypeError("the stride of a range is a number that is known in a step")
            self._count(node, first, lambda: last, by, lambda at: (at, INT))
            return
        items = self.value(node.iter)
        if items[1].kind != "list":
            raise TypeError("'for' goes through a list")
        self._count(node, "0", lambda: self.length(items), "1", lambda at: self.item(items, at))

    def _count(self, node: Any, first: str, last: Callable[[], str], by: str, item: Callable[[str], Value]) -> None:
        """NOTE: of a list that grows meanwhile the new items come too, as Python has it."""
        self.n += 1
        counter = f".{self.n}"
        self._assign(counter, (first, INT))
        top, inside, again, after = (self.label() for _ in range(4))
        self.begin(top)
        at = self.op(f"load i64, ptr %v.{counter}")
        goes_on = self.op(f"icmp {'sgt' if by.startswith('-') else 'slt'} i64 {at}, {last()}")
        self.end(f"br i1 {goes_on}, label %{inside}, label %{after}")
        self.begin(inside)
        self._assign(node.target.id, item(at))
        self._loop(node.body, again, after)
        self.begin(again)
        following = self.op(f"add i64 {self.op(f'load i64, ptr %v.{counter}')}, {by}")
        self.put(f"store i64 {following}, ptr %v.{counter}")
        self.go(top)
        self.begin(after)

    def _loop(self, body: list[ast.stmt], again: str, after: str) -> None:
        self.loops.append((again, after))
        self.body(body)
        self.loops.pop()


def _loaded(node: Any) -> ast.expr:
    """A target as a value."""
    made: ast.expr = type(node)(**{name: getattr(node, name) for name in node._fields if name != "ctx"}, ctx=ast.Load())
    return ast.copy_location(made, node)
