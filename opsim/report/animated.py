"""Recorded and emulated performances moving side by side, unlabelled: one offline page on which a reader guesses."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from opsim.report.body import body
from opsim.report.offline import asset, policy, template
from opsim.report.staged import RATE_HZ, Card
from opsim.report.view import TRAVEL_M, view_axes
from opsim.whole import write_text

LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
FURTHEST_M = 32.0
"""Two bytes a coordinate hold whole mm up to here."""


def write_animated(
    cards: Sequence[Card], skeleton: Any, path: str | Path, *, task: str, notes: Sequence[tuple[str, str]] = ()
) -> Path:
    """Write the page and return where it is; the same cards give the same bytes.

    cards : in the order to show them, at most 26, lettered from A
    notes : (topic, words) at the foot of the page: where the performances come from. They must not tell who is who
    Raises ValueError for no card or too many, or for a body that leaves the stage.
    """
    path = Path(path)
    write_text(path, animated_html(cards, skeleton, task=task, notes=notes))
    return path


def animated_html(cards: Sequence[Card], skeleton: Any, *, task: str, notes: Sequence[tuple[str, str]] = ()) -> str:
    """The page as text; names are escaped by jinja2, and in JSON by ``tojson``."""
    if not 1 <= len(cards) <= len(LETTERS):
        raise ValueError(f"cards: found {len(cards)}, expected 1 to {len(LETTERS)}")
    script = asset("animated.js")
    return str(
        template("animated.html.jinja").render(
            task=task,
            letters=LETTERS[: len(cards)],
            n_real=sum(card.is_real for card in cards),
            longest_s=max(card.duration_s for card in cards),
            notes=notes,
            film=_film(cards, skeleton),
            script=script,
            style=asset("report.css") + asset("animated.css"),
            policy=policy(script),
        )
    )


def _film(cards: Sequence[Card], skeleton: Any) -> dict[str, Any]:
    """What the page's script reads. The answers are packed, so that a glance at the source does not give them away."""
    answers = [[int(card.is_real), f"{card.who}, {card.duration_s:.1f} s"] for card in cards]
    root = skeleton.parents.index(-1)
    travel = [np.linalg.norm(np.ptp(card.positions_m[:, root, :2], axis=0)) for card in cards]
    return {
        "rate_hz": RATE_HZ,
        "joints": len(skeleton.names),
        "body": body(skeleton),
        "turn_deg": _turn_deg(cards, skeleton),
        "follow": bool(max(travel) > TRAVEL_M),
        "cards": [_packed(card.positions_m) for card in cards],
        "answers": base64.b64encode(json.dumps(answers).encode()).decode(),
    }


def _packed(positions_m: np.ndarray) -> str:
    """(T, J, 3) in whole mm as little-endian int16, base64."""
    if not np.all(np.abs(positions_m) < FURTHEST_M):
        raise ValueError(
            f"a joint is {np.abs(positions_m).max():.1f} m from the start, expected under {FURTHEST_M:g} m"
        )
    return base64.b64encode(np.rint(1000 * positions_m).astype("<i2").tobytes()).decode()


def _turn_deg(cards: Sequence[Card], skeleton: Any) -> int:
    """Whence all are looked at first: one direction, from the movements of all."""
    if not {"left_hip", "right_hip"} <= set(skeleton.names):
        return 30
    _, viewer = view_axes(np.concatenate([card.positions_m for card in cards]), skeleton)
    return round(float(np.degrees(np.arctan2(viewer[1], viewer[0]))))
