"""The sheet on which bodies of a film move: title, captions, the words on where it comes from, and where bodies go."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from opsim.report.palette import INK, MUTED
from opsim.report.person import LEFT, RIGHT
from opsim.report.video import Video

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
