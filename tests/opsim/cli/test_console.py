import json

from opsim.cli.app import print_json, print_table


def test_names_in_a_table_are_never_markup(capsys):
    print_table("[red]title", ("a", "b"), [("[bold]x[/bold]", "1")])
    shown = capsys.readouterr().out
    assert "[red]title" in shown and "[bold]x[/bold]" in shown


def test_what_is_not_a_number_is_null_in_json(capsys):
    print_json({"a": float("nan"), "b": [float("inf"), 1.5], "c": ("x",)})
    assert json.loads(capsys.readouterr().out) == {"a": None, "b": [None, 1.5], "c": ["x"]}


def test_nothing_that_steers_a_terminal_reaches_it(capsys):
    print_table("\x1b[31mRED\a", ("a\x9b", "b"), [("x\u202ey\tz", "1")])
    shown = capsys.readouterr().out
    assert "?[31mRED?" in shown and "a?" in shown and "x?y z" in shown
    assert not set(shown) & set("\x1b\a\x9b\u202e")
