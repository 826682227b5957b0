"""A study told on a terminal: its answer, the tables that fit on one screen, and where the page is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click


def print_study(page: Any, path: Path | None) -> None:
    """page : a StudyPage; path : where it was written, None where it was not."""
    from opsim.cli.console import print_table, printable

    click.echo(printable(f"{page.title}: {page.kind}"))
    for sentence in page.answer:
        click.echo(printable(sentence))
    for section in page.sections:
        if section.on_screen:
            _print_section(section, print_table, printable)
    if path is not None:
        click.echo(f"{page.kind}: {path}")


def _print_section(section: Any, print_table: Any, printable: Any) -> None:
    click.echo()
    if section.table is None:
        click.echo(printable(section.title))
    else:
        print_table(section.title, section.table.columns, section.table.rows, words=section.table.words)
    for sentence in section.sentences:
        click.echo(printable(sentence))
    for line in section.code.splitlines():
        click.echo(printable(line))
