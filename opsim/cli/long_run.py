"""``opsim long-run``: What long runs say."""

from __future__ import annotations

import click


@click.command("long-run")
def command() -> None:
    """What long runs say."""
