"""Bodies moving side by side on one offline page, with a player; and the game on it: who is recorded, who emulated?"""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from opsim.report.camera import camera_of
from opsim.report.offline import asset, policy, template
from opsim.report.staged import RATE_HZ, Card
from opsim.whole import write_text

LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
FURTHEST_M = 32.0
"""Two bytes a coordinate hold whole mm up to here."""
HOLD_S = 0.8
"""Between the end of the longest performance and the next beginning."""


@dataclass(frozen=True)
class Caption:
    """Of one body: a ``name`` for the page's own use, the bold ``label``, and what is ``said`` after it."""

    name: str
    label: str
    said: str = ""

    @property
    def aria(self) -> str:
        """For those who hear the page."""
        return f"performance {self.label}" if len(self.label) == 1 else self.label


def write_animated(
    cards: Sequence[Card], skeleton: Any, path: str | Path, *, task: str, notes: Sequence[tuple[str, str]] = ()
) -> Path:
    """Write the page of the game and return where it is; the same cards give the same bytes.

    cards : in the order to show them, at most 26, lettered from A
    notes : (topic, words) at the foot of the page: where the performances come from. They must not tell who is who
    Raises ValueError for no card or too many, or for a body that leaves the stage.
    """
    path = Path(path)
    write_text(path, animated_html(cards, skeleton, task=task, notes=notes))
    return path


def animated_html(cards: Sequence[Card], skeleton: Any, *, task: str, notes: Sequence[tuple[str, str]] = ()) -> str:
    """The page of the game as text."""
    if not 1 <= len(cards) <= len(LETTERS):
        raise ValueError(f"cards: found {len(cards)}, expected 1 to {len(LETTERS)}")
    captions = [Caption(letter, letter) for letter in LETTERS[: len(cards)]]
    words = {"task": task, "notes": notes, "n_real": sum(card.is_real for card in cards)}
    return page_of(
        "guess.html.jinja", cards, captions, skeleton, words, film={"answers": _answers(cards)}, scripts=["guess.js"]
    )


def page_of(
    name: str,
    cards: Sequence[Card],
    captions: Sequence[Caption],
    skeleton: Any,
    words: dict[str, Any],
    *,
    film: dict[str, Any] | None = None,
    scripts: Sequence[str] = (),
) -> str:
    """A page with the player, made from the template ``name`` with ``words``; more for its ``scripts`` in ``film``.

    The people are those of the replay, whose script draws them. Names are escaped by jinja2, in JSON by ``tojson``.
    """
    from opsim.viewer.write import page_script

    texts = [page_script(), *map(asset, scripts)]
    return str(
        template(name).render(
            {"first_apart": False, **words},
            captions=captions,
            film=_film(cards, skeleton) | (film or {}),
            scripts=texts,
            style=asset("report.css") + asset("animated.css"),
            policy=policy(*texts),
        )
    )


def _film(cards: Sequence[Card], skeleton: Any) -> dict[str, Any]:
    """What the player reads."""
    return {
        "rate_hz": RATE_HZ,
        "hold_s": HOLD_S,
        "joints": len(skeleton.names),
        "skeleton": {"names": list(skeleton.names), "parents": [int(parent) for parent in skeleton.parents]},
        "camera": camera_of([card.positions_m for card in cards], skeleton).as_dict(),
        "cards": [_packed(card.positions_m) for card in cards],
    }


def _answers(cards: Sequence[Card]) -> str:
    """Packed, so that a glance at the source does not give them away."""
    answers = [[int(card.is_real), f"{card.who}, {card.duration_s:.1f} s"] for card in cards]
    return base64.b64encode(json.dumps(answers).encode()).decode()


def _packed(positions_m: np.ndarray) -> str:
    """(T, J, 3) in whole mm as little-endian int16, base64."""
    if not np.all(np.abs(positions_m) < FURTHEST_M):
        raise ValueError(
            f"a joint is {np.abs(positions_m).max():.1f} m from the start, expected under {FURTHEST_M:g} m"
        )
    return base64.b64encode(np.rint(1000 * positions_m).astype("<i2").tobytes()).decode()
