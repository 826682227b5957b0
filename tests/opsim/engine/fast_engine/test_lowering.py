"""Rules of the floor as numba compiles them: what becomes of each word, where it stands, and what is refused."""

import ast

import pytest

from opsim.engine.fast_engine.lowering import FLOOR, NotSo, lowered, rules

HEAD = "from __future__ import annotations\n\n\n@step\ndef rule(floor: Floor, xs: List[int], hook: Hook) -> None:\n    "


def body(text: str) -> str:
    """What the statements of a step become."""
    tree = lowered(HEAD + text.replace("\n", "\n    "), "rule.py")
    return "\n".join(ast.unparse(one) for one in tree.body[-1].body).replace("__(", "(")


@pytest.mark.parametrize(
    ("written", "compiled"),
    [
        ("xs.append(3)", "push(floor, xs, 3)"),
        ("xs.insert(0, 3)", "insert(floor, xs, 0, 3)"),
        ("xs.clear()", "clear(xs)"),
        ("one = xs.pop()", "one = pop_last(xs)"),
        ("one = xs.pop(0)", "one = pop_first(xs)"),
        ("del xs[2]", "drop_at(xs, 2)"),
        ("one = 3 in xs", "one = has(xs, 3)"),
        ("one = 3 not in xs", "one = not has(xs, 3)"),
        ("one = 3 in (1, 2)", "one = 3 in (1, 2)"),
        ("hook.line(floor, hook.subject)", "tell_1(hook.line, floor, hook.subject)"),
        ("_ = hook.line(floor, hook.subject)", "_ = ask_1(hook.line, floor, hook.subject)"),
        ("if hook.act_line(floor, 1, 2):\n    pass", "if ask_2(hook.act_line, floor, 1, 2):\n    pass"),
        ("for i in range(3):\n    pass", "for i in range(3):\n    pass"),
    ],
)
def test_what_becomes_of_a_word(written, compiled):
    assert body(written) == compiled


def test_a_list_is_gone_through_as_python_does_where_it_grows():
    text = body("for x in xs:\n    if x:\n        continue\n    xs.append(x)")
    xs, made = [1, 0, 2], []
    space = {"push": lambda _floor, items, x: made.append(x), "xs": xs, "floor": None}
    exec(text, space)
    assert made == [0]
    assert "while at__1 < len(items__1)" in text


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ("x = 1\ndel xs[0:2]", "'del' takes one item out"),
        ("x = 1\nfor a, b in xs:\n    pass", "'for' takes the items of one list"),
        ("x = 1\nhook.line(floor, 1, 2, 3, 4)", "at most 3 more"),
        ("x = 1\ny = 0 < 3 in xs", "'in' stands alone"),
    ],
)
def test_what_cannot_be_compiled_is_named_with_its_line(written, words):
    with pytest.raises(NotSo, match=words) as raised:
        body(written)
    assert (raised.value.filename, raised.value.lineno) == ("rule.py", 7)


def test_every_rule_can_be_lowered_and_keeps_its_lines():
    assert len(rules()) > 40
    for name in rules():
        path = FLOOR.joinpath(*name.split(".")).with_suffix(".py")
        source = path.read_text(encoding="utf-8")
        where = {one.name: one.lineno for one in ast.parse(source).body if isinstance(one, ast.FunctionDef)}
        tree = lowered(source, str(path))
        assert where == {one.name: one.lineno for one in tree.body if isinstance(one, ast.FunctionDef)}
        assert all(one.lineno <= source.count("\n") + 1 for one in ast.walk(tree) if hasattr(one, "lineno"))


def test_what_under_no_decorator_stands_is_any_python():
    tree = lowered("def install(build):\n    build.hooks.append({1: 2})\n", "rule.py")
    assert ast.unparse(tree.body[-1]) == "def install(build):\n    build.hooks.append({1: 2})"
