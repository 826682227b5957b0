"""``opsim select``: The best of several variants, with a promise."""

from __future__ import annotations

import click


@click.command("select")
def command() -> None:
    """The best of several variants, with a promise."""
