import json

from opsim.cli.console import print_json, print_table


def test_names_in_a_table_are_never_markup(capsys):
    print_table("[red]title", ("a", "b"), [("[bold]x[/bold]", "1")])
    shown = capsys.readouterr().out
    assert "[red]title" in shown and "[bold]x[/bold]" in shown


def test_what_is_not_a_number_is_null_in_json(capsys):
    print_json({"a": float("nan"), "b": [float("inf"), 1.5], "c": ("x",)})
    assert json.loads(capsys.readouterr().out) == {"a": None, "b": [None, 1.5], "c": ["x"]}
