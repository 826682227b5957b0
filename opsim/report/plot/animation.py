"""Bodies moving side by side on one offline page, with a player; and the game on it: who is recorded, who emulated?

What a video shows: the mean performance beside simulated ones, on one clock.

The sheet on which bodies of a film move: title, captions, the words on where it comes from, and where bodies go.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from opsim.files import write_text
from opsim.report.page import asset, policy, template
from opsim.report.plot.body import LEFT, RIGHT, camera_of
from opsim.report.plot.plotly import INK, MUTED
from opsim.report.sections.motions import CARD_RATE_HZ, Card

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
        "rate_hz": CARD_RATE_HZ,
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


Report = Callable[..., None]
"""``report(done, total, label="")``."""


@dataclass(frozen=True, eq=False)
class Video:
    """``mean`` first, then ``drawn``, bodies on one ``skeleton``.

    lead  : a sentence on what this is and from whom it was emulated
    notes : (topic, words) on where it comes from
    A card's ``who`` is said below its label.
    """

    task: str
    lead: str
    mean: Card
    drawn: tuple[Card, ...]
    skeleton: Any
    notes: tuple[tuple[str, str], ...] = ()

    @property
    def cards(self) -> tuple[Card, ...]:
        """In the order to show them."""
        return (self.mean, *self.drawn)

    @property
    def captions(self) -> tuple[Caption, ...]:
        """Of the cards."""
        drawn = [Caption(f"{k}", f"simulated {k}", card.who) for k, card in enumerate(self.drawn, start=1)]
        return (Caption("mean", "mean performance", self.mean.who), *drawn)


WIDTH_PX, NARROWEST_PX, WIDEST_BODY_PX = 1184, 560, 280
EDGE_PX, GAP_PX, CAPTION_PX, BAR_PX = 16, 12, 46, 4
FRAME, BAR_ROOM = "#dfe3e8", "#eceff2"


@dataclass(frozen=True, eq=False)
class Sheet:
    """``picture`` with all that stands still; in px, (x, y), the ``places`` of bodies and the ``clock``'s right top."""

    picture: Any
    places: tuple[tuple[int, int], ...]
    clock: tuple[int, int]


def columns_of(n: int) -> int:
    """How many bodies stand side by side: up to four in one row, else rows that are as full as can be."""
    rows = -(-n // (4 if n <= 8 else 5 if n <= 15 else 7))
    return -(-n // rows)


def body_width_px(n: int) -> int:
    """Room for each of ``n`` bodies."""
    columns = columns_of(n)
    return min((WIDTH_PX - 2 * EDGE_PX - (columns - 1) * GAP_PX) // columns, WIDEST_BODY_PX)


def sheet_of(video: Video, body_px: tuple[int, int], said: str) -> Sheet:
    """The sheet for bodies of ``body_px`` (width, height); ``said`` is the first line at its foot."""
    from PIL import Image, ImageDraw

    n, (wide, high) = len(video.cards), body_px
    columns = columns_of(n)
    inside = max(columns * wide + (columns - 1) * GAP_PX, NARROWEST_PX - 2 * EDGE_PX)
    head = [(video.task, 20, True, INK), *((line, 13, False, INK) for line in wrapped(video.lead, 13, inside))]
    foot = [(line, 11, False, MUTED) for text in (said, *_sources(video)) for line in wrapped(text, 11, inside)]
    top = EDGE_PX + sum(_line_px(size) for _, size, *_ in head) + 26
    step = CAPTION_PX + high + 3 * BAR_PX + GAP_PX
    below = top + -(-n // columns) * step
    size = (inside + 2 * EDGE_PX, below + sum(_line_px(size) for _, size, *_ in foot) + EDGE_PX)
    picture = Image.new("RGB", (size[0] + size[0] % 2, size[1] + size[1] % 2), "white")
    draw = ImageDraw.Draw(picture)
    _lines(draw, EDGE_PX, head)
    _lines(draw, below, foot)
    write(draw, (EDGE_PX, top - 25), "left limbs", 12, LEFT)
    write(draw, (EDGE_PX + 78, top - 25), "right limbs", 12, RIGHT)
    left = EDGE_PX + (inside - columns * wide - (columns - 1) * GAP_PX) // 2
    corners = [(left + k % columns * (wide + GAP_PX), top + k // columns * step) for k in range(n)]
    for k, corner in enumerate(corners):
        _card(draw, corner, body_px, video.captions[k], first=k == 0)
    return Sheet(picture, tuple((x, y + CAPTION_PX) for x, y in corners), (EDGE_PX + inside, top - 28))


def _sources(video: Video) -> list[str]:
    return [f"{topic}: {words}" for topic, words in video.notes]


def _card(draw: Any, corner: tuple[int, int], body_px: tuple[int, int], caption: Any, *, first: bool) -> None:
    (x, y), (wide, high) = corner, body_px
    bottom = y + CAPTION_PX + high + 2 * BAR_PX
    draw.rounded_rectangle((x, y, x + wide - 1, bottom), 6, outline=INK if first else FRAME, width=2 if first else 1)
    size = 13 if font(13, True).getlength(caption.label) <= wide - 18 else 11
    write(draw, (x + 9, y + 7), clipped(caption.label, size, wide - 18, bold=True), size, INK, bold=True)
    write(draw, (x + 9, y + 25), clipped(caption.said, 12, wide - 18), 12, MUTED)
    bar(draw, (x, y + CAPTION_PX), body_px, 1.0, BAR_ROOM)


def bar(draw: Any, place: tuple[int, int], body_px: tuple[int, int], share: float, colour: str) -> None:
    """The bar below a body, as long as a share of its room."""
    x, y, room = place[0] + 9, place[1] + body_px[1], body_px[0] - 18
    if round(room * share) > 0:
        draw.rectangle((x, y, x + round(room * share) - 1, y + BAR_PX - 1), fill=colour)


def write(
    draw: Any, at: tuple[int, int], text: str, size: int, colour: str, *, bold: bool = False, to: str = "la"
) -> None:
    """One line of text; ``to`` as Pillow's anchor."""
    draw.text(at, text, font=font(size, bold), fill=colour, anchor=to)


def wrapped(text: str, size: int, room_px: int) -> list[str]:
    """Lines that fit; a word that is longer than a line is cut."""
    lines: list[str] = []
    for word in _plain(text).split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and font(size).getlength(longer) <= room_px:
            lines[-1] = longer
        else:
            lines.append(clipped(word, size, room_px))
    return lines


def clipped(text: str, size: int, room_px: int, *, bold: bool = False) -> str:
    """The text as far as it fits, with an ellipsis where it does not."""
    text = _plain(text)
    if font(size, bold).getlength(text) <= room_px:
        return text
    text = text[:room_px]
    while text and font(size, bold).getlength(text + "…") > room_px:
        text = text[:-1]
    return text + "…"


def _plain(text: str) -> str:
    """Without what does not print: a new line would make a line two."""
    return "".join(sign if sign.isprintable() else " " for sign in text)


def _lines(draw: Any, top: int, lines: list[tuple[str, int, bool, str]]) -> None:
    for text, size, bold, colour in lines:
        write(
            draw, (EDGE_PX, top), clipped(text, size, draw.im.size[0] - 2 * EDGE_PX, bold=bold), size, colour, bold=bold
        )
        top += _line_px(size)


def _line_px(size: int) -> int:
    return round(1.45 * size)


@lru_cache(maxsize=16)
def font(size: int, bold: bool = False) -> Any:
    """DejaVu Sans, which matplotlib brings along: the same picture on every machine."""
    import matplotlib
    from PIL import ImageFont

    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)
