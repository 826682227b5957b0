"""The frames of a film, one after the other, as Pillow pictures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from opsim.report.animated import HOLD_S
from opsim.report.camera import camera_of
from opsim.report.palette import INK
from opsim.report.staged import RATE_HZ, Card
from opsim.report.video import Report, Video
from opsim.report.video_body import BodyPainter
from opsim.report.video_sheet import bar, body_width_px, sheet_of, write

BAR = "#8a929c"


class Film:
    """A video in real time at ``rate_hz``: frames at ``times_s`` (F,), the last where the longest performance ends.

    narrower : share of the room that each body takes, so that a long film stays small
    """

    def __init__(self, video: Video, rate_hz: float, *, narrower: float = 1.0) -> None:
        self.video = video
        self.longest_s = max(card.duration_s for card in video.cards)
        n_frames = int(np.ceil(self.longest_s * rate_hz - 1e-6)) + 1
        self.times_s = np.minimum(np.arange(n_frames) / rate_hz, self.longest_s)
        camera = camera_of([card.positions_m for card in video.cards], video.skeleton)
        self.painter = BodyPainter(video.skeleton, camera, int(narrower * body_width_px(len(video.cards))) - 4)
        wide, high = self.painter.size_px
        self.body_px = (wide + 4, high)
        said = f"Real time, {rate_hz:g} frames a second; the end stays for {HOLD_S:g} s."
        self.sheet = sheet_of(video, self.body_px, f"{said} The floor's squares are 25 cm wide.")
        self.usual = [card.positions_m.mean(axis=0) for card in video.cards]

    def frames(self, report: Report) -> Iterator[Any]:
        """RGB pictures of one size, both sides even; ``report`` hears (done, in all)."""
        for k, at_s in enumerate(self.times_s):
            report(k, len(self.times_s))
            yield self.frame(float(at_s))
        report(len(self.times_s), len(self.times_s))

    def frame(self, at_s: float) -> Any:
        """The picture at one time."""
        from PIL import ImageDraw

        picture = self.sheet.picture.copy()
        draw = ImageDraw.Draw(picture)
        for card, usual, place in zip(self.video.cards, self.usual, self.sheet.places):
            picture.paste(self.painter.picture(posture(card, at_s), usual), (place[0] + 2, place[1]))
            bar(draw, place, self.body_px, min(at_s, card.duration_s) / self.longest_s, BAR)
        write(draw, self.sheet.clock, f"{at_s:.2f} s", 15, INK, bold=True, to="ra")
        return picture


def posture(card: Card, at_s: float) -> np.ndarray:
    """Joints (J, 3) of a card at a time, straight between its frames; after its end the last ones."""
    place = min(at_s * RATE_HZ, len(card.positions_m) - 1.0)
    low = min(int(place), len(card.positions_m) - 2)
    return np.asarray((low + 1 - place) * card.positions_m[low] + (place - low) * card.positions_m[low + 1])
