"""Small SVGs for notebooks: bars of shares, and a body at some moments of a movement, seen from the side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

import numpy as np

WIDE, BAR = 480, 16
NAME = 110
FIGURES = 6
TALL = 150


def share_bars(bars: Mapping[str, Mapping[str, float]], colours: Mapping[str, str]) -> str:
    """A bar of parts for each name, as long as their shares; the parts' names stand below and at each part."""
    used = [part for part in colours if any(shares.get(part, 0) > 0 for shares in bars.values())]
    lines = []
    for row, (name, shares) in enumerate(bars.items()):
        y, x = row * (BAR + 4), float(NAME)
        lines.append(_text(NAME - 6, y + BAR - 4, _short(name), anchor="end"))
        for part in used:
            wide = shares.get(part, 0.0) * (WIDE - NAME)
            said = f"<title>{escape(f'{name}: {part} {shares.get(part, 0.0):.1%}')}</title>"
            lines.append(
                f'<rect x="{x:.1f}" y="{y}" width="{wide:.1f}" height="{BAR}" fill="{colours[part]}">{said}</rect>'
            )
            x += wide
    legend, below = [], len(bars) * (BAR + 4) + 4
    for at, part in enumerate(used):
        x = NAME + at % 4 * 90
        y = below + at // 4 * 16
        legend.append(f'<rect x="{x}" y="{y}" width="10" height="10" fill="{colours[part]}"/>')
        legend.append(_text(x + 14, y + 9, part))
    tall = below + -(-len(used) // 4) * 16
    return _svg(WIDE, tall, "".join([*lines, *legend]), "shares of time")


def bodies(positions_m: np.ndarray, parents: Sequence[int], said: str) -> str:
    """Lines along the bones at some even moments, left to right. positions_m : (T, J, 3), z up"""
    moments = np.linspace(0, len(positions_m) - 1, min(FIGURES, len(positions_m))).round().astype(int)
    some = positions_m[moments] - positions_m[moments][:, :1] * [1, 1, 0]
    side = some[:, :, _widest(some)]
    scale = (TALL - 20) / max(float(np.ptp(some[:, :, 2])), 1e-6)
    step = WIDE / len(moments)
    lines = []
    for at, (across, up) in enumerate(zip(side, some[:, :, 2] - some[:, :, 2].min())):
        xs, ys = step * (at + 0.5) + scale * across, TALL - 10 - scale * up
        bones = "".join(
            f"M{xs[parent]:.1f} {ys[parent]:.1f}L{xs[joint]:.1f} {ys[joint]:.1f}"
            for joint, parent in enumerate(parents)
            if parent >= 0
        )
        lines.append(f'<path d="{bones}" fill="none" stroke="#0072B2" stroke-width="2.5" stroke-linecap="round"/>')
    floor = f'<path d="M0 {TALL - 10}H{WIDE}" stroke="#999"/>'
    return _svg(WIDE, TALL, floor + "".join(lines), said)


def _widest(positions_m: np.ndarray) -> int:
    """The level axis along which the body reaches farther: it is seen across that one."""
    return int(np.argmax(np.ptp(positions_m[:, :, :2], axis=(0, 1))))


def _text(x: float, y: float, words: str, anchor: str = "start") -> str:
    return f'<text x="{x:g}" y="{y:g}" font-size="11" fill="#555" text-anchor="{anchor}">{escape(words)}</text>'


def _short(name: str) -> str:
    return name if len(name) <= 16 else f"{name[:15]}…"


def _svg(wide: int, tall: int, inside: str, said: str) -> str:
    size = f'viewBox="0 0 {wide} {tall}" width="{wide}" style="max-width:100%"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label="{escape(said)}">{inside}</svg>'
