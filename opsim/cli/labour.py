"""``opsim labour``: What differences between people cost."""

from __future__ import annotations

import click


@click.command("labour")
def command() -> None:
    """What differences between people cost."""
