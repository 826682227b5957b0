"""A video as a film file, where ffmpeg is at hand."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

from opsim.report.animated import HOLD_S
from opsim.report.video import Report, Video
from opsim.report.video_frames import Film

RATE_HZ = 30.0
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
    film = Film(video, RATE_HZ)
    wide, high = film.sheet.picture.size
    command = [program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{wide}x{high}"]
    command += ["-r", f"{RATE_HZ:g}", "-i", "-", "-an", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
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
        for _ in range(round(HOLD_S * RATE_HZ)):
            running.stdin.write(frame.tobytes())
        running.stdin.close()
    except BrokenPipeError:
        return
