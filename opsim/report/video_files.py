"""A video written as what its ending says: an offline page, a GIF, or a film where there is an encoder."""

from __future__ import annotations

from pathlib import Path

from opsim.report.animated import page_of
from opsim.report.video import Report, Video
from opsim.report.video_gif import write_gif
from opsim.report.video_mp4 import write_mp4
from opsim.whole import whole_file, write_text

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
