"""Changes of a layout as they are written."""

import pytest
from hypothesis import given
from hypothesis import strategies as some

from opsim.scenario.fields import EXAMPLES, read_any_moved, read_moved, split_names

names = some.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)


@pytest.mark.parametrize("kind", EXAMPLES)
def test_every_example_can_be_read_and_is_written_the_same(kind):
    moved = read_moved(kind, EXAMPLES[kind])
    assert str(moved) == f"{kind} {EXAMPLES[kind]}" and read_any_moved(str(moved)) == moved


@given(names, names, names)
def test_what_is_read_is_what_was_written(a, b, c):
    assert read_moved("add", f" {a} = like {b}  at {c} ").what == (a, b, c)
    assert read_moved("place", f"{a}={c}").what == (a, c)
    if a != b:
        assert read_moved("swap", f"{a} , {b}").what == (a, b)


@given(some.text(max_size=30))
def test_any_text_is_read_or_refused_in_words(text):
    for kind in EXAMPLES:
        try:
            read_moved(kind, text)
        except ValueError as error:
            assert kind in str(error)


@pytest.mark.parametrize(
    "text, words",
    [
        ("swap saw", "cannot be read; such as swap 'saw,drill'"),
        ("swap saw,saw", "cannot change places with itself"),
        ("swop saw,drill", "did you mean 'swap'?"),
        ("move bench=6, 1 m", "6 has no unit"),
        ("", "expected a change of the layout"),
    ],
)
def test_what_cannot_be_read_is_said_with_an_example(text, words):
    with pytest.raises(ValueError) as error:
        read_any_moved(text)
    assert words in str(error.value)


def test_names_with_commas_between_them():
    assert split_names(" a, b ,,c") == ["a", "b", "c"]
