"""``opsim merge``: Shards of one study put together."""

from __future__ import annotations

import click


@click.command("merge")
def command() -> None:
    """Shards of one study put together."""
