"""A moving body drawn frame by frame for films: the same shapes, order and camera as the page's script draws.

The frames of a film, one after the other, as Pillow pictures.

A video as an animated GIF, with Pillow.

A video as a film file, where ffmpeg is at hand.

A video written as what its ending says: an offline page, a GIF, or a film where there is an encoder.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from opsim.files import whole_file, write_text
from opsim.report.plot.animation import (
    BAR_ROOM,
    FRAME,
    HOLD_S,
    Report,
    Video,
    bar,
    body_width_px,
    page_of,
    sheet_of,
    write,
)
from opsim.report.plot.body import (
    COLOURS,
    FLOOR_M,
    SQUARE_M,
    Camera,
    Shape,
    body,
    body_parts,
    camera_of,
    outer_tangents,
)
from opsim.report.plot.plotly import INK, MUTED
from opsim.report.sections.motions import CARD_RATE_HZ, Card

FINER = 3
"""Drawn this many times as large, then made smaller: Pillow draws hard edges."""
GRID, SHADOW = "#dde2e8", (40, 46, 54)


class BodyPainter:
    """Draws the bodies of one skeleton into pictures of ``width_px``, seen by ``camera``."""

    def __init__(self, skeleton: Any, camera: Camera, width_px: int) -> None:
        self.camera, self.table = camera, body(skeleton)
        self.size_px = (width_px, round(width_px * camera.height_per_width))
        self.size = (self.size_px[0] * FINER, self.size_px[1] * FINER)
        self.scale = self.size[0] / (2 * camera.wide_m)

    def picture(self, joints_m: np.ndarray, usual_m: np.ndarray) -> Any:
        """A Pillow picture of joints (J, 3); ``usual_m`` (J, 3) are their means, which steady the order of limbs."""
        from PIL import Image, ImageDraw

        large = Image.new("RGB", self.size, "white")
        draw = ImageDraw.Draw(large, "RGBA")
        middle = joints_m[self.table["root"], :2] if self.camera.follow else np.array(self.camera.middle_m)
        self._ground(draw, middle)
        self._shadows(draw, joints_m, middle)
        rim = max(1.5 * FINER, 0.012 * self.scale)
        seen, often = self._seen(joints_m, middle), self._seen(usual_m, middle)
        for part in body_parts(self.table, seen, often, self.scale / 1000):
            _fill(draw, part.shapes, "white", rim)
            _fill(draw, part.shapes, self.table["colours"][part.colour], 0.0)
        return large.reduce(FINER)

    def _seen(self, points_m: np.ndarray, middle: np.ndarray) -> np.ndarray:
        """Points (..., 3) -> (..., 3): x and y in the picture, and nearness in metres."""
        across, high, near = np.moveaxis(self.camera.see(points_m, middle), -1, 0)
        return np.stack([self.size[0] / 2 + self.scale * across, self.size[1] - self.scale * high, near], axis=-1)

    def _ground(self, draw: Any, middle: np.ndarray) -> None:
        reach = self.camera.wide_m - 0.04
        for axis in (0, 1):
            first, last = (np.array([-reach, reach]) + middle[axis]) / SQUARE_M
            for k in range(int(np.ceil(first)), int(np.floor(last)) + 1):
                half = np.sqrt(max(0.0, reach**2 - (k * SQUARE_M - middle[axis]) ** 2))
                ends = np.full((2, 3), FLOOR_M)
                ends[:, axis], ends[:, 1 - axis] = k * SQUARE_M, middle[1 - axis] + np.array([-half, half])
                line = [tuple(end) for end in self._seen(ends, middle)[:, :2]]
                draw.line(line, fill=GRID, width=max(FINER, round(0.004 * self.scale)))

    def _shadows(self, draw: Any, joints_m: np.ndarray, middle: np.ndarray) -> None:
        for foot in self.table["feet"]:
            below = np.append(joints_m[foot, :2], FLOOR_M)
            x, y, _ = self._seen(below, middle)
            dark = 0.28 * np.exp(-max(joints_m[foot, 2], 0.0) / 0.12)
            wide, high = 0.075 * self.scale, 0.02 * self.scale
            draw.ellipse([x - wide, y - high, x + wide, y + high], fill=(*SHADOW, round(255 * dark)))


def _fill(draw: Any, shapes: list[Shape], colour: str, rim: float) -> None:
    """Fill the shapes, each larger by ``rim`` pixels all round."""
    for kind, what in shapes:
        if kind == "inside":
            draw.polygon([tuple(corner) for corner in what], fill=colour)
        elif kind == "disc":
            _disc(draw, what[0], what[1] + rim, colour)
        else:
            a, b, a_px, b_px = what
            _taper(draw, a, b, a_px + rim, b_px + rim, colour)


def _disc(draw: Any, centre: np.ndarray, radius_px: float, colour: str) -> None:
    draw.ellipse([*(centre - radius_px), *(centre + radius_px)], fill=colour)


def _taper(draw: Any, a: np.ndarray, b: np.ndarray, a_px: float, b_px: float, colour: str) -> None:
    """Two discs and what lies between their outer tangents."""
    _disc(draw, a, a_px, colour)
    _disc(draw, b, b_px, colour)
    corners = outer_tangents(a, b, a_px, b_px)
    if len(corners):
        draw.polygon([tuple(corner) for corner in corners], fill=colour)


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
    place = min(at_s * CARD_RATE_HZ, len(card.positions_m) - 1.0)
    low = min(int(place), len(card.positions_m) - 2)
    return np.asarray((low + 1 - place) * card.positions_m[low] + (place - low) * card.positions_m[low + 1])


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


MP4_RATE_HZ = 30.0
ENCODER = "ffmpeg"


def missing_encoder(path: Path) -> str:
    """What to do where ``path`` is wanted as .mp4 and no encoder is found; nothing where one is."""
    if path.suffix.lower() != ".mp4" or shutil.which(ENCODER):
        return ""
    return (
        f"{path}: found no program {ENCODER} on the PATH, which writes .mp4; expected it installed (apt-get install "
        f"ffmpeg, brew install ffmpeg, winget install ffmpeg), or the ending .html or .gif, which need nothing more"
    )


def write_mp4(video: Video, path: Path, report: Report) -> None:
    """Pipe the frames through ffmpeg. Raises ValueError where there is none, or with its own words where it fails."""
    program = shutil.which(ENCODER)
    if program is None:
        raise ValueError(missing_encoder(Path("video.mp4")))
    film = Film(video, MP4_RATE_HZ)
    wide, high = film.sheet.picture.size
    command = [program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{wide}x{high}"]
    command += ["-r", f"{MP4_RATE_HZ:g}", "-i", "-", "-an", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
    command += ["-metadata", f"title={video.task}: {video.lead}", "-f", "mp4", str(path)]
    with tempfile.TemporaryFile() as complaint:
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=complaint, stderr=complaint) as running:
            _fed(running, film, report)
        if running.returncode:
            complaint.seek(0)
            said = complaint.read().decode(errors="replace").strip().splitlines() or ["no word why"]
            raise ValueError(f"{ENCODER} ended with {running.returncode}: {said[-1]}")


def _fed(running: subprocess.Popen, film: Film, report: Report) -> None:
    """Every frame, the last one as long as the page's player waits; an encoder that has gone hears no more."""
    assert running.stdin is not None
    try:
        for frame in film.frames(report):
            running.stdin.write(frame.tobytes())
        for _ in range(round(HOLD_S * MP4_RATE_HZ)):
            running.stdin.write(frame.tobytes())
        running.stdin.close()
    except BrokenPipeError:
        return


ENDINGS = (".html", ".gif", ".mp4")


def write_video(video: Video, path: str | Path, report: Report | None = None) -> Path:
    """Write what the ending of ``path`` says and return it; the same video gives the same page and GIF to the byte.

    report : called with (frames done, frames in all) while a GIF or film is drawn
    Raises ValueError for another ending, for .mp4 where no encoder is at hand (see ``video_mp4``) or where it fails,
    and for a body that leaves the stage.
    """
    path, tell = Path(path), report or (lambda *_: None)
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise ValueError(f"{path}: found the ending {path.suffix!r}, expected {' or '.join(ENDINGS)}")
    if ending == ".html":
        write_text(path, video_html(video))
        return path
    with whole_file(path) as temporary:
        (write_gif if ending == ".gif" else write_mp4)(video, temporary, tell)
    return path


def video_html(video: Video) -> str:
    """The page as text."""
    words = {"task": video.task, "lead": video.lead, "notes": video.notes, "first_apart": True}
    return page_of("video.html.jinja", video.cards, video.captions, video.skeleton, words)
