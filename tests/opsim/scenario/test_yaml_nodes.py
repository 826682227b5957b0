import time
from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.scenario.tree import child
from opsim.scenario.yaml import read_tree, scalar


def answer(raw):
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(raw, Path("x.yaml"))
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("no", "no"),
        ("NO", "NO"),
        ("on", "on"),
        ("yes", "yes"),
        ("08:30", "08:30"),
        ("1:30:00", "1:30:00"),
        ("010", 10),
        ("0o10", 8),
        ("0x1F", 31),
        ("1_000", "1_000"),
        ("1e3", 1000.0),
        ("-.5", -0.5),
        ("2026-03-02", "2026-03-02"),
        ("true", True),
        ("~", None),
        ("", None),
        (".inf", float("inf")),
        ("9" * 400, "9" * 400),
    ],
)
def test_plain_scalars_follow_the_core_schema_of_yaml_1_2(text, value):
    assert scalar(text) == value and type(scalar(text)) is type(value)


def test_values_know_where_they_stand():
    tree, problems = read_tree(b"a: 1\nb:\n  - x\n  - c: '2'\n", "x.yaml")
    two = child(tree, "b", 1, "c")
    assert not problems
    assert (two.value, two.place.line, two.place.column, two.key.column) == ("2", 3, 7, 4)


def test_a_key_is_the_text_that_stands_there():
    tree, _ = read_tree(b"no: 1\n010: 2\ntrue: 3\n", "x.yaml")
    assert list(tree.value) == ["no", "010", "true"]


def test_an_alias_stands_for_its_anchor():
    tree, _ = read_tree(b"a: &x {k: [1, 2]}\nb: *x\n", "x.yaml")
    assert tree.plain() == {"a": {"k": [1, 2]}, "b": {"k": [1, 2]}}


def test_utf_16_and_a_byte_order_mark_are_read():
    for encoding in ("utf-16", "utf-8-sig"):
        assert read_tree("a: ü\n".encode(encoding), "x.yaml")[0].plain() == {"a": "ü"}


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (b"", "x.yaml: the file is empty\n  a scenario begins with 'opsim: 1'\n1 problem in x.yaml"),
        (b"# nothing yet\n", "x.yaml: the file is empty\n  a scenario begins with 'opsim: 1'\n1 problem in x.yaml"),
        (
            b"PK\x03\x04\x00\x00\xff",
            "x.yaml: this is a binary file, not a scenario\n  a scenario is a YAML text file\n1 problem in x.yaml",
        ),
        (
            b"name: M\xfcller\n",
            "x.yaml:1:8: byte 0xfc is not UTF-8 text\n     1 | name: M\N{REPLACEMENT CHARACTER}\n"
            "       |        ^ save the file as UTF-8\n1 problem in x.yaml",
        ),
        (
            b"a: 1\nname: \x1b[31m\n",
            "x.yaml:2:7: a control character (U+001B) stands here\n     2 | name: ?[31m\n"
            "       |       ^ remove it\n1 problem in x.yaml",
        ),
        (
            b"- a\n",
            "x.yaml:1:1: expected a scenario, found a list of 1\n     1 | - a\n"
            "       | ^ a scenario begins with 'opsim: 1'\n1 problem in x.yaml",
        ),
        (
            b"a: 1\n---\nb: 2\n",
            "x.yaml:2:1: a second document begins here\n     2 | ---\n"
            "       | ^ a file holds one scenario; remove the '---'\n1 problem in x.yaml",
        ),
        (
            b"a:\n\tb: 1\n",
            "x.yaml:2:1: not YAML: a tab stands where the indent is\n     2 |  b: 1\n"
            "       | ^ indent with spaces\n1 problem in x.yaml",
        ),
        (
            b"a: @b\n",
            "x.yaml:1:4: not YAML: a value cannot begin with '@'\n     1 | a: @b\n"
            "       |    ^ put it in quotes\n1 problem in x.yaml",
        ),
        (
            b'a: "b\nc: 1\n',
            'x.yaml:1:4: not YAML: a quote is opened and never closed\n     1 | a: "b\n'
            "       |    ^ close it on the same line\n1 problem in x.yaml",
        ),
        (
            b"a: b: c\n",
            "x.yaml:1:5: not YAML: a second ': ' in one value\n     1 | a: b: c\n"
            "       |     ^ put the value in quotes, or the key on its own line\n1 problem in x.yaml",
        ),
        (
            b"a: &x 1\nb: *y\n",
            "x.yaml:2:4: b: no anchor '&y' before this\n     2 | b: *y\n       |    ^ known: x\n1 problem in x.yaml",
        ),
    ],
)
def test_what_is_no_yaml_text_gets_its_whole_answer(raw, said):
    assert answer(raw) == said


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (b"- " * 100_000, "more than 30 deep"),
        (b"a: 1\n" * 90_000, "this key stands twice"),
        (b"a: !!python/object/apply:os.system [ls]\n", "means nothing here"),
        (b"a: &a [*a]\n", "no anchor '&a' before this"),
        (b"<<: {a: 1}\n", "write 'like: NAME' instead"),
    ],
)
def test_what_yaml_allows_and_a_scenario_does_not_is_refused_quickly(raw, said):
    start = time.process_time()
    assert said in answer(raw)
    assert time.process_time() - start < 5  # a square law would take minutes
