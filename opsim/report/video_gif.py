"""A video as an animated GIF, with Pillow."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from opsim.report.animated import HOLD_S
from opsim.report.body import COLOURS
from opsim.report.palette import INK, MUTED
from opsim.report.video import Report, Video
from opsim.report.video_body import GRID
from opsim.report.video_frames import BAR, Film
from opsim.report.video_sheet import BAR_ROOM, FRAME

RATE_HZ = 20.0
"""A GIF counts in hundredths of a second: 20 or 25 frames a second are exact, 30 are not."""
MOST_BYTES, BYTES_PER_PIXEL = 4e6, 0.04
"""What a film should stay below, and what a pixel of a body costs in a frame (seen: 0.014 to 0.053, walking most)."""
SMALLEST_SHARE = 0.5
SHADES, WHITEST = 12, 244
"""Of each ink; nothing nearly white, since Pillow finds the nearest colour to a few levels only."""


def write_gif(video: Video, path: Path, report: Report) -> None:
    """Write the video with one palette for all frames; it runs for ever."""
    film = Film(video, RATE_HZ)
    film = Film(video, RATE_HZ, narrower=_share(film))
    palette = _palette()
    pictures = (frame.quantize(palette=palette, dither=0) for frame in film.frames(report))
    first = next(pictures)
    first.save(
        path,
        format="GIF",
        save_all=True,
        append_images=pictures,
        duration=_durations_ms(film),
        loop=0,
        comment=f"{video.task}: {video.lead}".encode(),
    )


def _durations_ms(film: Film) -> list[int]:
    """The last frame stays while the page's player waits."""
    return [round(1000 / RATE_HZ)] * (len(film.times_s) - 1) + [round(1000 * HOLD_S)]


def _share(film: Film) -> float:
    """Of the room that a body may take, so that the file stays small: pixels grow with its square."""
    wide, high = film.body_px
    bytes_ = BYTES_PER_PIXEL * wide * high * len(film.video.cards) * len(film.times_s)
    return float(np.clip(np.sqrt(MOST_BYTES / bytes_), SMALLEST_SHARE, 1.0))


def _palette() -> Any:
    """Every colour that is drawn, in shades towards the white that surrounds it: the same ones in every frame."""
    from PIL import Image, ImageColor

    inks = np.array(
        [ImageColor.getrgb(ink) for ink in dict.fromkeys((*COLOURS, INK, MUTED, GRID, BAR, BAR_ROOM, FRAME))]
    )
    shades = np.linspace(0.0, 1.0, SHADES, endpoint=False)[:, None, None]
    colours = np.rint((1 - shades) * inks + shades * 255).astype(int).reshape(-1, 3)
    colours = colours[colours.min(axis=1) < WHITEST]
    palette = Image.new("P", (1, 1))
    palette.putpalette([255, 255, 255, *colours.ravel().tolist()])
    return palette
