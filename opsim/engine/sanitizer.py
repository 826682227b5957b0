"""A sanitizer: the rules as CPython runs them refuse what compiled code does not see. On with ``OPSIM_SANITIZE=1``.

It is read once, as ``opsim.engine.floor.machine`` is imported, some of whose names stand for those of ``names`` then;
without it nothing is looked at. Refused, by ``Unsound`` with the file and the line of the rule:

- use after give-back: of a struct, of its lists, of an array;
- a reference to nothing;
- an index that is too far, also a negative one, which Python would count from the end;
- a list that is changed while it is walked;
- a ``bool`` that is no 0 or 1, as an argument or an answer of a rule;
- a whole number beyond 64 bits, also one that is only on the way to another; a float where a whole number stands.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any

LEAST, MOST = -(2**63), 2**63 - 1
_MACHINE = (__file__, str(Path(__file__).parent / "floor" / "machine.py"), "<")
_CAUGHT = """
try:
    pass
except (AttributeError, TypeError) as error__:
    raise of_nothing__(error__) from error__
"""
_PLAIN: dict[str, Any] = {}
"""What rules are written in without a sanitizer, by name."""
_WRAPPED = (ast.Add, ast.Sub, ast.Mult, ast.LShift, ast.Pow)
"""What may lead out of 64 bits. NOTE: ``~`` and the rest of the operators cannot."""


class Unsound(RuntimeError):
    """A rule did what compiled code would do otherwise, or would break at without a word."""


def _unsound(words: str) -> Unsound:
    return Unsound(f"{_place()}: {words}")


def _place() -> str:
    """The line of a rule that is at hand: the first one outside of what rules are written in."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_MACHINE):
        frame = frame.f_back
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"


def whole(value: Any) -> Any:
    """A value, which is no whole number beyond 64 bits."""
    if type(value) is int and not LEAST <= value <= MOST:
        raise _unsound(f"a whole number beyond 64 bits: {value}")
    return value


def truth(value: Any, of: str) -> Any:
    """A value that is 0 or 1."""
    if type(value) is not bool and (type(value) is not int or value not in (0, 1)):
        raise _unsound(f"a bool that is no 0 or 1: {of} is {value!r}")
    return value


def of_nothing(error: Exception) -> Exception:
    """What is to be raised for an error of CPython: also an array holds 0 where it leads nowhere."""
    words, trace = str(error), error.__traceback__
    if "'NoneType' object" not in words and "'int' object has no attribute" not in words:
        return error
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    if trace is None or trace.tb_frame.f_globals.get("of_nothing__") is not of_nothing:
        return error  # a model's or a plug-in's own
    return Unsound(f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}: a reference to nothing: {words}")


class Items(list[Any]):
    """A list of a struct, or an array. n_changes : of its length; given_back : where; else nothing."""

    __slots__ = ("given_back", "n_changes")

    def __init__(self, items: Any = ()):
        super().__init__(map(whole, items))
        self.n_changes, self.given_back = 0, ""

    def _at(self, index: Any, n: int) -> Any:
        self._used()
        if type(index) is not slice and (type(index) not in (int, bool) or not 0 <= index < n):
            raise _unsound(f"an index too far: {index!r} of {len(self)}")
        return index

    def _used(self) -> None:
        if self.given_back:
            raise _unsound(f"use after give-back: of a list that was given back at {self.given_back}")

    def _changes(self) -> None:
        self._used()
        self.n_changes += 1

    def __getitem__(self, index: Any) -> Any:
        return super().__getitem__(self._at(index, len(self)))

    def __setitem__(self, index: Any, item: Any) -> None:
        super().__setitem__(self._at(index, len(self)), whole(item))

    def __delitem__(self, index: Any) -> None:
        self._changes()
        super().__delitem__(self._at(index, len(self)))

    def insert(self, index: Any, item: Any) -> None:
        """Before the item of an index; behind the last."""
        self._changes()
        super().insert(self._at(index, len(self) + 1), whole(item))

    def append(self, item: Any) -> None:
        """Behind the last."""
        self._changes()
        super().append(whole(item))

    def pop(self, index: Any = None) -> Any:
        """Take the last one out, or another."""
        self._changes()
        return super().pop(self._at(len(self) - 1 if index is None else index, len(self)))

    def remove(self, item: Any) -> None:
        """Take the first out that is an item."""
        self._changes()
        super().remove(item)

    def clear(self) -> None:
        """Take all items out."""
        self._changes()
        super().clear()

    def __iter__(self) -> Iterator[Any]:
        self._used()
        before = self.n_changes
        for item in super().__iter__():
            yield item
            if self.n_changes != before:
                raise _unsound("a list changed while it is walked")

    def __contains__(self, item: Any) -> bool:
        self._used()
        return super().__contains__(item)


class _GivenBack:
    """What the class of a struct becomes that was given back."""

    __slots__ = ()

    def __getattribute__(self, name: str) -> Any:
        if name.startswith("_"):  # SimPy looks at an event once more after it has happened
            return object.__getattribute__(self, name)
        raise _used_after(self, f".{name}")

    def __setattr__(self, name: str, value: Any) -> None:
        raise _used_after(self, f".{name}")

    def __bool__(self) -> bool:
        raise _used_after(self, "truth")

    def __eq__(self, other: object) -> bool:
        raise _used_after(self, "comparison")

    __hash__ = object.__hash__


_GIVEN_BACK_AT: dict[int, str] = {}


def _used_after(one: Any, what: str) -> Unsound:
    name, at = type(one).__name__, _GIVEN_BACK_AT.get(id(one), "?")
    return _unsound(f"use after give-back: {what} of a {name} that was given back at {at}")


@cache
def _dead(cls: Any) -> Any:
    return type(cls.__name__, (_GivenBack, cls), {"__slots__": (), "alive": cls})


def struct(cls: Any) -> Any:
    """A class of annotations whose fields are looked at as they are set."""
    plain: Any = _PLAIN["struct"](cls)
    fields = {name: str(kind) for name, kind in cls.__annotations__.items()}

    def put(self: Any, name: str, value: Any) -> None:
        kind = fields.get(name, "")
        if type(value) is list and kind.startswith("List["):
            value = Items(value)
        elif kind == "bool":
            truth(value, name)
        elif kind == "int" and type(value) is float:
            raise _unsound(f"a float where a whole number stands: {name} is {value!r}")
        object.__setattr__(self, name, whole(value))

    made = type(cls.__name__, (plain,), {"__slots__": (), "__setattr__": put, "__module__": cls.__module__})
    _PLAIN["STRUCTS"][cls.__name__] = made
    return made


def give_back(_struct: Any) -> Callable[[Any, Any], None]:
    """A function of the floor and a struct that nobody may use any more, nor its lists."""

    def given_back(_floor: Any, one: Any) -> None:
        if isinstance(one, _GivenBack):
            raise _used_after(one, "give-back")
        where = _GIVEN_BACK_AT[id(one)] = _place()
        cls: Any = type(one)
        for name in _PLAIN["lists_of"](cls):
            getattr(one, name).given_back = where
        object.__setattr__(one, "__class__", _dead(cls))

    return given_back


def new_ints(floor: Any, n: int) -> Any:
    """An array of n whole numbers."""
    return Items(_PLAIN["new_ints"](floor, n))


def new_floats(floor: Any, n: int) -> Any:
    """An array of n floats."""
    return Items(_PLAIN["new_floats"](floor, n))


def give_ints_back(_floor: Any, items: Any, n: int) -> None:
    """An array of n that nobody may use any more."""
    items._used()
    if len(items) != n:
        raise _unsound(f"an index too far: an array of {len(items)} is given back as one of {n}")
    items.given_back = _place()


_Plain: Any = object


class _Arena(_Plain):
    """As the plain one; what was given back in a run is there again in the next."""

    def array(self, of: str, values: Any) -> Any:
        """An array of numbers or structs."""
        made = Items(super().array(of, values))
        self._arrays[-1] = made
        return made

    def restore(self) -> None:
        """All as it was when it was frozen."""
        structs_of, arrays = self._frozen
        for _, one, _, lists_of in structs_of:
            if isinstance(one, _GivenBack):
                object.__setattr__(one, "__class__", type(one).alive)  # type: ignore[attr-defined]
            for items, _ in lists_of:
                items.given_back = ""
        for items, _ in arrays:
            items.given_back = ""
        super().restore()


def step(function: Any) -> Any:
    """A function of the floor and of more, with all that it says looked at."""
    node = _written(function)
    if node is not None:
        watch(function, node)
    return function


def watch(function: Any, node: ast.FunctionDef) -> None:
    """Have a function do what is written in a node, with all that it says looked at."""
    space: dict[str, Any] = {}
    function.__globals__.update(whole__=whole, truth__=truth, of_nothing__=of_nothing)
    future = ast.ImportFrom("__future__", [ast.alias("annotations")], 0)
    tree = ast.fix_missing_locations(ast.Module([future, _looked_at(node)], []))
    exec(compile(tree, function.__code__.co_filename, "exec"), function.__globals__, space)
    function.__code__ = space[node.name].__code__


def inlined(function: Any) -> Any:
    """A small function."""
    return _PLAIN["inlined"](step(function) if isinstance(function, FunctionType) else function)


@cache
def _tree(path: str) -> dict[int, ast.FunctionDef]:
    """The functions of a file at its top, by the lines in which they begin with their decorators."""
    body = ast.parse(Path(path).read_text(encoding="utf-8")).body
    nodes = (node for node in body if isinstance(node, ast.FunctionDef))
    return {min([node.lineno, *(one.lineno for one in node.decorator_list)]): node for node in nodes}


def _written(function: Any) -> ast.FunctionDef | None:
    """A function as it is written; None where it is no function at the top of a file."""
    code = function.__code__
    found = _tree(code.co_filename).get(code.co_firstlineno) if Path(code.co_filename).is_file() else None
    return found if found is not None and found.name == function.__qualname__ and not code.co_freevars else None


def _looked_at(node: ast.FunctionDef) -> ast.FunctionDef:
    """A rule that asks for its truths, its whole numbers, and what is nothing."""
    truths = (one.arg for one in node.args.args if _says_bool(one.annotation))
    asked = [ast.Expr(_call("truth__", ast.Name(name, ast.Load()), name)) for name in truths]
    looks = _Looks(_says_bool(node.returns))
    whole_rule: Any = ast.parse(_CAUGHT).body[0]
    whole_rule.body = [*(ast.copy_location(one, node) for one in asked), *map(looks.visit, node.body)]
    node.body, node.decorator_list = [whole_rule], []
    return node


def _says_bool(annotation: ast.expr | None) -> bool:
    return isinstance(annotation, ast.Name) and annotation.id == "bool"


class _Looks(ast.NodeTransformer):
    """Of a rule's statements. answers : whether it answers a truth"""

    def __init__(self, answers: bool):
        self.answers = answers

    def visit_BinOp(self, node: ast.BinOp) -> Any:
        self.generic_visit(node)
        return ast.copy_location(_call("whole__", node), node) if isinstance(node.op, _WRAPPED) else node

    def visit_AugAssign(self, node: ast.AugAssign) -> Any:
        self.generic_visit(node)
        if not isinstance(node.target, ast.Name):  # a field or an item looks at what it is given
            return node
        value = ast.BinOp(ast.Name(node.target.id, ast.Load()), node.op, node.value)
        return ast.copy_location(ast.Assign([node.target], _call("whole__", value)), node)

    def visit_Return(self, node: ast.Return) -> Any:
        self.generic_visit(node)
        if self.answers and node.value is not None:
            node.value = ast.copy_location(_call("truth__", node.value, "the answer"), node.value)
        return node


def _call(name: str, value: ast.expr, *words: str) -> ast.Call:
    return ast.Call(ast.Name(name, ast.Load()), [value, *map(ast.Constant, words)], [])


def names(plain: dict[str, Any]) -> dict[str, Any]:
    """What stands in for some of the names of the machine; ``plain``: all that it has."""
    _PLAIN.update(plain)
    ours = (give_back, give_ints_back, inlined, new_floats, new_ints, step, struct)
    arena = type("Arena", (_Arena, plain["Arena"]), {"__doc__": _Arena.__doc__})
    return {one.__name__: one for one in ours} | {"Arena": arena}
