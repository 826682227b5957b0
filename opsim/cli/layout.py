"""``opsim layout``: Which station stands where."""

from __future__ import annotations

import click


@click.command("layout")
def command() -> None:
    """Which station stands where."""
