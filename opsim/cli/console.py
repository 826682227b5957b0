"""Tables for people and JSON for machines, both on stdout."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Sequence
from typing import Any

import click

PIPE_WIDTH = 140


def width() -> int:
    """Characters of the terminal; of what a pipe is given elsewhere."""
    from shutil import get_terminal_size

    return get_terminal_size().columns if sys.stdout.isatty() else PIPE_WIDTH


def say(sentence: str) -> None:
    """A sentence, broken between words on a terminal and in one line elsewhere; nothing in it steers a terminal."""
    from textwrap import fill

    text = printable(sentence)
    click.echo(fill(text, width(), break_long_words=False, break_on_hyphens=False) if sys.stdout.isatty() else text)


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]], *, words: int = 1) -> None:
    """A table; the first ``words`` columns are text, the others stand to the right. Nothing in it is read as markup.

    Characters that do not print, such as those that steer a terminal, become '?'.
    """
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console() if sys.stdout.isatty() else Console(width=PIPE_WIDTH)
    table = Table(title=Text(printable(title), style="bold"), title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for place, column in enumerate(columns):
        table.add_column(Text(printable(column)), justify="left" if place < words else "right", overflow="fold")
    for row in rows:
        table.add_row(*(Text(printable(cell)) for cell in row))
    console.print(table)


def printable(text: str) -> str:
    """The text without anything that a terminal would obey; a tab or a new line becomes a space."""
    return "".join(c if c.isprintable() else " " if c in "\t\n\r" else "?" for c in text)


def print_json(value: Any) -> None:
    """One JSON document; what is not a number is null."""
    click.echo(json.dumps(_plain(value), indent=1, ensure_ascii=False, allow_nan=False))


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
