"""Pieces of HTML for notebooks: every text escaped, no script. NOTE: opsim has its own, as neither asks the other."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

import numpy as np

MOST_ROWS = 20
WIDE, TALL = 480, 150
FIGURES = 6


def sentence(*words: str) -> str:
    """A paragraph."""
    return f"<p>{escape(' '.join(word for word in words if word))}</p>"


def table(columns: Sequence[str], rows: Iterable[Sequence[object]], most: int = MOST_ROWS) -> str:
    """A table; of more than ``most`` rows the first, and how many follow."""
    listed = list(rows)
    head = "".join(f"<th>{escape(name)}</th>" for name in columns)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in listed[:most])
    more = sentence(f"and {len(listed) - most} more") if len(listed) > most else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def count(n: int, word: str, words: str = "") -> str:
    """``1 worker``, ``2 workers``."""
    return f"{n} {word if n == 1 else words or word + 's'}"


def bodies(positions_m: np.ndarray, parents: Sequence[int], said: str) -> str:
    """Lines along the bones at some even moments, left to right, from the side. positions_m : (T, J, 3), z up"""
    moments = np.linspace(0, len(positions_m) - 1, min(FIGURES, len(positions_m))).round().astype(int)
    some = positions_m[moments] - positions_m[moments][:, :1] * [1, 1, 0]
    across = some[:, :, int(np.argmax(np.ptp(some[:, :, :2], axis=(0, 1))))]
    up = some[:, :, 2] - some[:, :, 2].min()
    scale = (TALL - 20) / max(float(up.max()), 1e-6)
    step = WIDE / len(moments)
    lines = [f'<path d="M0 {TALL - 10}H{WIDE}" stroke="#999"/>']
    for at in range(len(moments)):
        xs, ys = step * (at + 0.5) + scale * across[at], TALL - 10 - scale * up[at]
        bones = (
            f"M{xs[parent]:.1f} {ys[parent]:.1f}L{xs[joint]:.1f} {ys[joint]:.1f}"
            for joint, parent in enumerate(parents)
            if parent >= 0
        )
        lines.append(f'<path d="{"".join(bones)}" fill="none" stroke="#0072B2" stroke-width="2.5"/>')
    size = f'viewBox="0 0 {WIDE} {TALL}" width="{WIDE}" style="max-width:100%"'
    said = escape(said)
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label="{said}">{"".join(lines)}</svg>'


def _cell(value: object) -> str:
    if isinstance(value, str):
        return f'<td style="text-align:left">{escape(value)}</td>'
    missing = value is None or (isinstance(value, float) and not np.isfinite(value))
    text = "" if missing else f"{value:.4g}" if isinstance(value, float) else str(value)
    return f'<td style="text-align:right">{escape(text)}</td>'
