"""``opsim sweep``: Many points of some factors of a scenario."""

from __future__ import annotations

import click


@click.command("sweep")
def command() -> None:
    """Many points of some factors of a scenario."""
