"""Pieces of HTML for notebooks: every text escaped, no script, no style but what stands at an element."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

MOST_ROWS = 20


def sentence(*words: str) -> str:
    """A paragraph."""
    return f"<p>{escape(' '.join(word for word in words if word))}</p>"


def table(columns: Sequence[str], rows: Iterable[Sequence[object]], most: int = MOST_ROWS) -> str:
    """A table; of more than ``most`` rows the first, and how many follow. Numbers stand to the right."""
    listed = list(rows)
    head = "".join(f"<th>{escape(name)}</th>" for name in columns)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in listed[:most])
    more = sentence(f"and {len(listed) - most} more") if len(listed) > most else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _cell(value: object) -> str:
    if isinstance(value, str):
        return f'<td style="text-align:left">{escape(value)}</td>'
    return f'<td style="text-align:right">{escape(number(value))}</td>'


def number(value: object) -> str:
    """A number as a table has it; nothing where there is none."""
    if value is None or (isinstance(value, float) and value != value):
        return ""
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 10_000 else f"{value:,.0f}"
    return f"{value:,}" if isinstance(value, int) else str(value)


def count(n: int, word: str, words: str = "") -> str:
    """``1 worker``, ``2 workers``."""
    return f"{n:,} {word if n == 1 else words or word + 's'}"


def duration(seconds: float) -> str:
    """A time in the unit that people would say it in."""
    for unit_s, unit in ((86_400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if seconds >= 2 * unit_s:
            return f"{seconds / unit_s:.4g} {unit}"
    return f"{seconds:.3g} s"
