"""What is asked of ``opsim motion show``, and everything that speaks against it, said at once.

``opsim motion show``: a task of a library as strips of figures, or moving: as a video, or beside recordings.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes

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
        from opsim.cli.motion.files import chosen, found, overwritten, ready

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
    from opsim.report.page import need_matplotlib
    from opsim.report.plot.video import missing_encoder

    try:
        ready(out, *ENDINGS[kind])
        if out.suffix.lower() in RASTER:
            need_matplotlib(f"{out.suffix[1:].upper()} files")
    except ValueError as error:
        return [str(error)]
    return list(filter(None, [missing_encoder(out)]))


@click.command("show")
@click.argument("library")
@click.argument("task", required=False)
@click.option(
    "-o",
    "--out",
    type=click.Path(path_type=Path),
    help="A .png or .svg file; with --video .html, .gif or .mp4; with --beside .html.  [default: <task>.png or .html]",
)
@click.option("-n", "n", type=int, help="Drawn performances, 1 to 20.  [default: 3, with --beside 4 and 4]")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True)
@click.option("--video", is_flag=True, help="The mean performance beside drawn ones, moving on one clock.")
@click.option(
    "--beside",
    metavar="RECORDING.npz",
    help="An .html page instead: recorded performances of this file beside emulated ones, moving and unlabelled.",
)
@click.option("--where", help="Which repetitions of --beside, as for a fit.  [default: the correct ones]")
@click.option(
    "--people",
    type=click.Choice(["new", "recorded"]),
    help="Whom those of --video and --beside are of: others, or the people of the fit.  [default: new]",
)
@click.option(
    "--person", metavar="NAME", help="All of --video by this person of the fit, beside the person's own mean."
)
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(library: str, task: str | None, seed: int, as_json: bool, **options: Any) -> None:
    """Draw a TASK of a LIBRARY along real time: the mean performance above drawn ones.

    Both may be said in one word, as in a scenario: public_movements/deep_squat.

    With --video the mean moves beside drawn ones: an offline page, a GIF or a film, by the ending of -o.
    With --beside, write a page on which recorded and emulated performances move side by side, and one guesses.
    """
    from opsim.cli.motion.files import library_and_task
    from opsim.task_model import behind

    with mistakes():
        asked = Asked(**options)
        model, out = asked.checked(*library_and_task(library, task))
        report = model.report
        title = f"{model.task}: emulated from {behind(report.source, report.n_sequences, report.n_workers)}"
        said = {"strips": _strips, "video": _video, "beside": _beside}[asked.kind](model, out, asked, seed, title)
    _tell({"task": model.task, "out": str(out), "seed": seed, "source": report.source, **said}, title, as_json)


def _strips(model: Any, out: Path, asked: Asked, seed: int, title: str) -> dict[str, Any]:
    from emulator.model.mean_performance import mean_performance
    from opsim.report.plot.body import Strip
    from opsim.report.sections.motions import draw_strips, strips_of

    if getattr(model, "walks", False):
        return _walks(model, out, asked.n or 3, seed, title)
    mean, drawn = mean_performance(model), strips_of(model, n_samples=asked.n or 3, seed=seed)[1:]
    row = Strip("mean performance", mean.positions_m(n_times=61)[0], float(mean.duration_s[0]), mean.mark_s[0])
    draw_strips([row, *drawn], out, skeleton=model.skeleton, mark_names=model.mark_names, title=title)
    return {"samples": len(drawn)}


def _walks(model: Any, out: Path, n: int, seed: int, title: str) -> dict[str, Any]:
    """Walks at their own places, over their footprints."""
    import numpy as np

    from opsim.report.sections.walking import draw_walks, walk_of

    drawn = model.sample(n, np.random.default_rng(seed))
    rows = [walk_of("mean performance", model.typical())]
    rows += [walk_of(f"sample {k + 1}", drawn[k]) for k in range(n)]
    draw_walks(rows, out, model.skeleton, title=title)
    return {"samples": n}


def _video(model: Any, out: Path, asked: Asked, seed: int, _title: str) -> dict[str, Any]:
    from opsim.cli.motion.video import video
    from opsim.cli.progress import progress
    from opsim.report.plot.video import write_video

    made = video(model, n=asked.n or 3, people=asked.people or "new", person=asked.person, seed=seed)
    with progress(f"draw {model.task}") as report:
        write_video(made, out, report)
    cards = [{"card": caption.label, "said": caption.said} for caption in made.captions]
    return {"samples": asked.n or 3, "notes": dict(made.notes), "cards": cards, "bytes": out.stat().st_size}


def _beside(model: Any, out: Path, asked: Asked, seed: int, _title: str) -> dict[str, Any]:
    from opsim.cli.motion.side_by_side import beside
    from opsim.report.plot.animation import LETTERS, write_animated

    n = asked.n or 4
    made = beside(model, str(asked.beside), where=asked.where, n=n, people=asked.people or "new", seed=seed)
    write_animated(made.cards, model.skeleton, out, task=model.task, notes=made.notes)
    cards = [
        {"card": letter, "real": card.is_real, "who": card.who, "duration_s": round(card.duration_s, 3)}
        for letter, card in zip(LETTERS, made.cards)
    ]
    return {"samples": n, "notes": dict(made.notes), "cards": cards}


def _tell(said: dict[str, Any], title: str, as_json: bool) -> None:
    """For people; of the game without the answers: they are to guess."""
    from opsim.cli.app import print_json

    if as_json:
        print_json(said)
        return
    click.echo(title)
    for card in said["cards"] if "bytes" in said else []:
        click.echo(f"{card['card']}: {card['said']}")
    for topic, words in said.get("notes", {"source": said["source"]}).items():
        click.echo(f"{topic}: {words}")
    kind = {".html": "page", ".gif": "GIF", ".mp4": "film"}.get(Path(said["out"]).suffix.lower(), "picture")
    size = f" ({said['bytes'] / 1e6:.1f} MB)" if "bytes" in said else ""
    click.echo(f"{kind}: {said['out']}{size}")
