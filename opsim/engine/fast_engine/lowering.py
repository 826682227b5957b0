"""Rules of the floor as CPython reads them -> steps as numba compiles them, by a pass over their syntax.

What a step may say of lists and hooks, and what becomes of it:

    xs.append(x), xs.insert(i, x)       push(floor, xs, x), insert(floor, xs, i, x)
    xs.pop(), xs.pop(0), xs.clear()     pop_last(xs), pop_first(xs), clear(xs)
    del xs[i], x in xs                  drop_at(xs, i), has(xs, x)
    hook.line(floor, a, b)              tell_2(hook.line, floor, a, b), or ask_2 where its answer is taken
    for x in xs                         a count that goes up to len(xs) as it is then, as Python's does

All else is as it is written, and stands on the lines where it is written: errors and debuggers show these.

Modules of this package that are rules of the floor: found in ``opsim.engine.floor``, and lowered as they are read.

What was lowered is kept beside what Python has compiled, as long as neither the rule nor the pass changes.
"""

from __future__ import annotations

import ast
import importlib
import importlib.abc
import importlib.util
import marshal
import sys
from contextlib import suppress
from os import getpid, replace
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

WRITTEN, COMPILED = "opsim.engine.floor", "opsim.engine.fast_engine"
DECORATORS = ("step", "inlined")
METHODS = {("append", 1): "push", ("insert", 2): "insert", ("clear", 0): "clear", ("pop", 0): "pop_last"}
"""What a method of so many arguments becomes."""
GROWS = ("push", "insert")
"""These are given the floor, whose memory lists grow in."""
MOST_ARGUMENTS = 3
"""Of a hook, after the floor."""
_ALIAS = "{}__"
"""Names of the machine, which no rule has."""
NAMES = (
    *("push", "insert", "clear", "pop_first", "pop_last", "drop_at", "has"),
    *(f"{word}_{n}" for word in ("tell", "ask") for n in range(MOST_ARGUMENTS + 1) if (word, n) != ("ask", 0)),
)


class NotSo(SyntaxError):
    """Something in a step that cannot be compiled; it says the file and the line."""


def lowered(source: str, path: str) -> ast.Module:
    """A module of steps. Raises NotSo."""
    tree = ast.parse(source.replace(WRITTEN, COMPILED), path)
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and any(_name(one) in DECORATORS for one in node.decorator_list):
            node.body = _Body(path).statements(node.body)
    at = 1 + max((i for i, node in enumerate(tree.body) if _is_future(node)), default=-1)
    names = [ast.alias(name, _ALIAS.format(name)) for name in NAMES]
    tree.body.insert(at, ast.ImportFrom(f"{COMPILED}.machine", names, 0))
    return ast.fix_missing_locations(tree)


def _name(node: ast.expr) -> str:
    return node.id if isinstance(node, ast.Name) else ""


def _is_future(node: ast.stmt) -> bool:
    return isinstance(node, ast.ImportFrom) and node.module == "__future__"


class _Body(ast.NodeTransformer):
    """Of one step."""

    def __init__(self, path: str):
        self.path, self.n_loops = path, 0

    def statements(self, body: list[Any]) -> list[Any]:
        found = (self.visit(node) for node in body)
        return [one for node in found for one in (node if isinstance(node, list) else [node])]

    def visit_For(self, node: ast.For) -> Any:
        self.generic_visit(node)
        if isinstance(node.iter, ast.Call):  # range
            return node
        if node.orelse or not isinstance(node.target, ast.Name):
            raise self._wrong(node, "'for' takes the items of one list, each by a name, and has no 'else' in a step")
        self.n_loops += 1
        items, at, item = f"items__{self.n_loops}", f"at__{self.n_loops}", node.target.id
        text = f"{items} = 0\n{at} = 0\nwhile {at} < len({items}):\n    {item} = {items}[{at}]\n    {at} += 1"
        made: list[Any] = ast.parse(text).body
        made[0].value = node.iter
        for one in (made[0], made[0].targets[0], made[1], made[2], *made[2].body[:2]):
            ast.copy_location(one, node)
        for one in (*ast.walk(made[2].test), *(deep for inner in made[2].body[:2] for deep in ast.walk(inner))):
            ast.copy_location(one, node)
        made[2].body += node.body
        return made

    def visit_Expr(self, node: ast.Expr) -> Any:
        if isinstance(node.value, ast.Call) and _is_line(node.value.func):
            node.value = self._hook(node.value, "tell")
            return node
        return self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> Any:
        if _is_line(node.func):
            return self._hook(node, "ask")
        self.generic_visit(node)
        if not isinstance(node.func, ast.Attribute):
            return node
        method, items, given = node.func.attr, node.func.value, node.args
        if method == "pop" and len(given) == 1 and isinstance(given[0], ast.Constant) and given[0].value == 0:
            return self._machine("pop_first", [items], node)
        name = METHODS.get((method, len(given)))
        if name is None:
            return node
        floor = [ast.Name("floor", ast.Load())] if name in GROWS else []
        return self._machine(name, [*floor, items, *given], node)

    def visit_Compare(self, node: ast.Compare) -> Any:
        self.generic_visit(node)
        if not any(isinstance(one, (ast.In, ast.NotIn)) for one in node.ops) or isinstance(
            node.comparators[0], ast.Tuple
        ):
            return node
        if len(node.ops) > 1:
            raise self._wrong(node, "'in' stands alone in a step")
        found = self._machine("has", [node.comparators[0], node.left], node)
        return found if isinstance(node.ops[0], ast.In) else ast.copy_location(ast.UnaryOp(ast.Not(), found), node)

    def visit_Delete(self, node: ast.Delete) -> Any:
        self.generic_visit(node)
        of = node.targets[0]
        if len(node.targets) > 1 or not isinstance(of, ast.Subscript) or isinstance(of.slice, ast.Slice):
            raise self._wrong(node, "'del' takes one item out of a list in a step")
        return ast.copy_location(ast.Expr(self._machine("drop_at", [of.value, of.slice], node)), node)

    def _hook(self, node: ast.Call, word: str) -> ast.Call:
        self.generic_visit(node)
        n = len(node.args) - 1
        if not 0 <= n <= MOST_ARGUMENTS or f"{word}_{n}" not in NAMES:
            raise self._wrong(node, f"a hook is given the floor and at most {MOST_ARGUMENTS} more")
        return self._machine(f"{word}_{n}", [node.func, *node.args], node)

    def _machine(self, name: str, given: list[Any], node: Any) -> ast.Call:
        function = ast.Name(_ALIAS.format(name), ast.Load())
        return ast.copy_location(ast.Call(ast.copy_location(function, node), given, []), node)

    def _wrong(self, node: Any, words: str) -> NotSo:
        return NotSo(words, (self.path, node.lineno, node.col_offset + 1, ast.unparse(node)))


def _is_line(node: ast.expr) -> bool:
    """Whether what is called is the line of a hook."""
    return isinstance(node, ast.Attribute) and (node.attr == "line" or node.attr.endswith("_line"))


HERE = Path(__file__).parent
FLOOR = HERE.parent / "floor"


def know_all() -> None:
    """Have all steps known by their lines: also those of rules that a block comes to only where a plan asks for it."""
    for name in (*rules(), *(path.stem for path in HERE.glob("[!_]*.py"))):
        importlib.import_module(f"{COMPILED}.{name}")


def rules() -> list[str]:
    """Names of all modules of rules, within the package."""
    return [
        path.stem
        for path in sorted(FLOOR.glob("[!_]*.py"))
        if path.stem != "machine" and not (HERE / path.name).exists()
    ]


class Lowering(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Asked after Python's own finders: what this package has a file of is that file."""

    def find_spec(self, name: str, path: Any, target: Any = None) -> Any:
        """Where a module is."""
        if name.startswith(COMPILED + "."):
            file = FLOOR.joinpath(*name.removeprefix(COMPILED + ".").split(".")).with_suffix(".py")
            if file.is_file():
                return importlib.util.spec_from_file_location(name, file, loader=self)
        return None

    def create_module(self, spec: Any) -> ModuleType | None:
        """An ordinary one."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """What stands in it, lowered."""
        exec(_code(Path(str(module.__file__))), module.__dict__)


def _code(path: Path) -> CodeType:
    """From disk where it is that of today's source, of this pass and this Python."""
    kept = Path(importlib.util.cache_from_source(str(HERE / path.relative_to(FLOOR))))
    times = [of.stat() for of in (path, Path(str(__file__)))]
    key = importlib.util.MAGIC_NUMBER + repr([(one.st_mtime_ns, one.st_size) for one in times] + [str(path)]).encode()
    with suppress(OSError, ValueError, EOFError, TypeError):
        data = kept.read_bytes()
        if data.startswith(key):
            found: CodeType = marshal.loads(data[len(key) :])
            return found
    made = compile(lowered(path.read_text(encoding="utf-8"), str(path)), str(path), "exec")
    if not sys.dont_write_bytecode:
        with suppress(OSError):
            _write(kept, key + marshal.dumps(made))
    return made


def _write(kept: Path, data: bytes) -> None:
    """Under another name first, as several processes may do so at once."""
    kept.parent.mkdir(parents=True, exist_ok=True)
    part = kept.with_name(f"{kept.name}.{getpid()}")
    part.write_bytes(data)
    replace(part, kept)


# NOTE: done as this is imported, first of all in this package: the modules after it are found that way.
sys.meta_path.append(Lowering())
