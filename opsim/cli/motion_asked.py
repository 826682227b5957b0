"""What is asked of ``opsim motion show``, and everything that speaks against it, said at once."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

MOST = 20
MOST_BESIDE = 13
"""Recorded and emulated together have the letters A to Z."""
RASTER = (".png", ".gif", ".mp4")
"""What is drawn by matplotlib, or by Pillow, which comes with it."""
ENDINGS = {"strips": (".png", ".svg"), "video": (".html", ".gif", ".mp4"), "beside": (".html",)}


@dataclass(frozen=True)
class Asked:
    """The options as they were given; None where one was not."""

    out: Path | None = None
    n: int | None = None
    video: bool = False
    beside: str | None = None
    where: str | None = None
    people: str | None = None
    person: str | None = None

    @property
    def kind(self) -> str:
        """Which picture: strips, video or beside."""
        return "beside" if self.beside is not None else "video" if self.video else "strips"

    def checked(self, library: str, task: str | None) -> tuple[Any, Path]:
        """The emulator and the file to write, whose folder is made. Raises ValueError with every mistake."""
        from opsim.cli.motion_files import chosen, found, overwritten, ready

        wrong = [*_together(self), *_number(self), *_ending(self)]
        model, out = None, self.out
        try:
            model = chosen(library, task)
            wrong += _person(model, self.person)
            out = out or Path(f"{Path(model.task).name}{ENDINGS[self.kind][0]}")
            wrong += overwritten(out, library=[found(library)], recording=[self.beside or ""])
        except ValueError as error:
            wrong.append(str(error))
        if out is not None and not _ending(self):
            wrong += _written(ready, out, self.kind)
        if wrong or model is None or out is None:
            raise ValueError("\n".join(wrong))
        return model, out


def _together(asked: Asked) -> list[str]:
    """Options that only go with others, or not with each other."""
    wrong = []
    if asked.video and asked.beside is not None:
        wrong.append("--video: found together with --beside, expected one of them")
    if asked.where is not None and asked.beside is None:
        wrong.append("--where: found without --beside, expected --beside RECORDING.npz")
    if asked.people is not None and asked.kind == "strips":
        wrong.append("--people: found without --video or --beside, expected one of them")
    if asked.person is not None and not asked.video:
        wrong.append("--person: found without --video, expected --video")
    if asked.person is not None and asked.people is not None:
        wrong.append("--person: found together with --people, expected one of them")
    return wrong


def _number(asked: Asked) -> list[str]:
    if asked.n is None:
        return []
    if asked.beside is not None and asked.n > MOST_BESIDE:
        return [f"-n: found {asked.n}, expected at most {MOST_BESIDE} with --beside (letters A to Z)"]
    return [] if 1 <= asked.n <= MOST else [f"-n: found {asked.n}, expected 1 to {MOST}"]


def _ending(asked: Asked) -> list[str]:
    """The ending says what is written; one that belongs to another kind of picture names the option for it."""
    if asked.out is None or asked.out.suffix.lower() in ENDINGS[asked.kind]:
        return []
    suffix, known = asked.out.suffix, " or ".join(ENDINGS[asked.kind])
    if asked.kind == "strips" and suffix.lower() in ENDINGS["video"]:
        also = " or --beside RECORDING.npz" if suffix.lower() == ".html" else ""
        return [f"{asked.out}: found the ending {suffix!r}, expected {known}, or --video{also}: it is for what moves"]
    return [
        f"{asked.out}: found the ending {suffix!r}, expected {known} with --{asked.kind}".replace(" with --strips", "")
    ]


def _person(model: Any, person: str | None) -> list[str]:
    try:
        if person is not None:
            model.known_worker(person)
    except ValueError as error:
        return [f"--person: {error}"]
    return []


def _written(ready: Any, out: Path, kind: str) -> list[str]:
    """What keeps the file from being written: its folder, or that nothing here can draw it or encode it."""
    from opsim.report.extras import need_matplotlib
    from opsim.report.video_mp4 import missing_encoder

    try:
        ready(out, *ENDINGS[kind])
        if out.suffix.lower() in RASTER:
            need_matplotlib(f"{out.suffix[1:].upper()} files")
    except ValueError as error:
        return [str(error)]
    return list(filter(None, [missing_encoder(out)]))
