"""What a step may say does the same compiled as in Python; what it may not is refused with its file and line."""

from itertools import count
from types import SimpleNamespace

import pytest
from made.machine import Floor, Given, empty_floor, entered

from opsim.engine.fast_engine import lowering
from opsim.engine.fast_engine.machine import lists
from opsim.engine.fast_engine.machine.compiler import Module
from opsim.engine.fast_engine.machine.llvm_text import NotSo
from opsim.engine.fast_engine.machine.steps import STEPS, step
from opsim.engine.floor import machine as in_python

_NUMBERS = count()
NAMES = ("drop", "index_of", "inlined")


def endless(n, m=0):
    return endless(n + m)


def rule_of(text, folder):
    """The function of a file, and its names, with some statements in which ``xs`` is a list and ``n`` a number."""
    path = folder / f"rule_{next(_NUMBERS)}.py"
    body = text.replace("\n", "\n    ")
    path.write_text(
        f"def {path.stem}(floor, given):\n    xs, n = given.box.numbers, given.n\n    {body}\n    return n\n"
    )
    return path


def function_of(path, machine):
    space = {name: getattr(machine, name) for name in NAMES if hasattr(machine, name)} | {
        "PAIR": (2, 3),
        "endless": endless,
        "__name__": "tried",
    }
    exec(compile(path.read_text(), str(path), "exec"), space)
    function = space[path.stem]
    function.__annotations__ = {"floor": Floor, "given": Given, "return": int}
    return function


def compiled(path, numbers, n):
    arena, floor = empty_floor()
    box = arena.new("Box")
    box.numbers.fill(numbers)
    arena.freeze()
    answer = entered(function_of(path, lists))(floor.address, box=box, n=n)
    return answer, list(box.numbers)


SAID = [
    "xs.append(3)\nxs.insert(0, 4)\nxs.insert(len(xs), n)",
    "n = xs.pop()\nn += xs.pop(0)",
    "del xs[2]\nn = 3 in xs",
    "xs.clear()\nn = bool(xs) + 2 * (5 not in xs)",
    "n = drop(xs, 1) + 10 * drop(xs, 77) + 100 * index_of(xs, 2)",
    "n = n in (1, 7) or n in PAIR",
    "for x in xs:\n    if x > 9:\n        continue\n    if len(xs) > 8:\n        break\n    xs.append(x + 5)",
    "for i in range(n, 0, -2):\n    xs.append(i)\n    i += 5",
    "while n < 100 and not n % 11 == 5:\n    n = 2 * n + 1",
    "xs[0], xs[1] = xs[1], xs[0]\na, b = (n, 2.5) if n > 3 else (1, 4)\nn = int(a * b)",
    "n = int(100 * (n / 3) - (-n // 4) + (-n % 4) + n ** 2 - 7.5 // 2 + -7.5 % 2)",
    "n = (n << 3 | 5) ^ (n & 6) - (n >> 1) + ~n",
    "n = max(n, 3, xs[0]) - min(2, n) + abs(-n) + int(-2.7)",
    "n = (1 < n < 9) + 2 * (n == 7 != 3) + 4 * ((n, 2) < (7, 3)) + 8 * ((n, 2) == (7, 2))",
    "x = 1\nif n:\n    x = 2.5\nn = int(2 * x)",
    "x = n and 4\ny = x or 9\nz = None\nn = y + (z is None)",
]


@pytest.mark.parametrize("text", SAID)
@pytest.mark.parametrize("n", [7, 2, 0])
def test_what_may_be_said_does_what_python_does(text, n, tmp_path):
    path, numbers = rule_of(text, tmp_path), [5, 1, 2, 1]
    given = SimpleNamespace(box=SimpleNamespace(numbers=list(numbers)), n=n)
    wanted = int(function_of(path, in_python)(None, given))
    assert compiled(path, numbers, n) == (wanted, given.box.numbers)


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ("del xs[0:2]", "'del' takes one item out"),
        ("for a, b in xs:\n    pass", "'for' takes the items of one list"),
        ("for a in n:\n    pass", "'for' goes through a list"),
        ("for a in range(0, 9, n):\n    pass", "the stride of a range is a number that is known"),
        ("y = 0 in xs in xs", "'in' stands alone"),
        ("y = {1: 2}", "no Dict in a step"),
        ("y = nobody(n)", "no 'nobody' is known here"),
        ("y = given.box.nubmers", "Box has no 'nubmers'; did you mean 'numbers'?"),
        ("y = n.real", "int has no fields"),
        ("xs.sort()", "lists have no 'sort'"),
        ("with n:\n    pass", "no With in a step"),
        ("y = sorted(n)", "is not compiled"),
        ("n = 1 if n else (2, 3)", "int and a tuple in one place"),
        ("y = xs.pop(1)", "'pop' takes the last item out of a list, or the first one"),
        ("y = index_of(xs)", "index_of is called with 1, expected 2"),
        ("y = endless()", "endless is called with 0, expected 1 to 2"),
        ("given.box = n", "int, expected a Box"),
    ],
)
def test_what_cannot_be_compiled_is_refused_with_its_file_and_line(written, words, tmp_path):
    path = rule_of(f"y = 1\n{written}", tmp_path)
    one = step(function_of(path, lists))
    del STEPS[one.line]
    with pytest.raises(NotSo) as raised:
        Module([one], lambda _line: False)
    assert words in raised.value.msg
    assert (raised.value.filename, raised.value.lineno) == (str(path), 4)


@pytest.mark.parametrize(
    ("written", "words"),
    [("n.wrong", "int has no fields"), ("helper(n)", "helper calls itself, which only a step may")],
)
def test_a_mistake_in_a_helper_is_on_the_helpers_line(written, words, tmp_path):
    path = tmp_path / "helped.py"
    path.write_text(f"def helper(n):\n    return {written}\n\n\ndef rule(floor, given):\n    return helper(given.n)\n")
    space = {"__name__": "tried"}
    exec(compile(path.read_text(), str(path), "exec"), space)
    space["rule"].__annotations__ = {"floor": Floor, "given": Given, "return": int}
    one = step(space["rule"])
    del STEPS[one.line]
    with pytest.raises(NotSo) as raised:
        Module([one], lambda _line: False)
    assert (raised.value.msg, raised.value.filename, raised.value.lineno) == (words, str(path), 2)


def test_what_was_imported_is_compiled_also_where_the_file_is_another_one_by_then(tmp_path):
    path = rule_of("n = 42", tmp_path)
    function = entered(function_of(path, lists))
    path.write_text("")
    arena, floor = empty_floor()
    assert function(floor.address, box=arena.new("Box")) == 42


def test_every_rule_can_be_compiled_together():
    lowering.know_all()
    rules = [one for one in STEPS.values() if one.function.__module__.startswith("opsim.")]
    whole = Module(rules, lambda _line: False)
    assert len(whole.steps) >= len(rules) > 300
    assert whole.calls == set()
