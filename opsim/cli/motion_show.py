"""``opsim motion show``: a task of a library as strips of figures, or moving: as a video, or beside recordings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.motion_asked import Asked
from opsim.cli.verbs import mistakes


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

    With --video the mean moves beside drawn ones: an offline page, a GIF or a film, by the ending of -o.
    With --beside, write a page on which recorded and emulated performances move side by side, and one guesses.
    """
    from opsim.provenance import behind

    with mistakes():
        asked = Asked(**options)
        model, out = asked.checked(library, task)
        report = model.report
        title = f"{model.task}: emulated from {behind(report.source, report.n_sequences, report.n_workers)}"
        said = {"strips": _strips, "video": _video, "beside": _beside}[asked.kind](model, out, asked, seed, title)
    _tell({"task": model.task, "out": str(out), "seed": seed, "source": report.source, **said}, title, as_json)


def _strips(model: Any, out: Path, asked: Asked, seed: int, title: str) -> dict[str, Any]:
    from emulator.model.mean_performance import mean_performance
    from opsim.report.strips import draw_strips, strips_of
    from opsim.report.view import Strip

    if getattr(model, "walks", False):
        return _walks(model, out, asked.n or 3, seed, title)
    mean, drawn = mean_performance(model), strips_of(model, n_samples=asked.n or 3, seed=seed)[1:]
    row = Strip("mean performance", mean.positions_m(n_times=61)[0], float(mean.duration_s[0]), mean.mark_s[0])
    draw_strips([row, *drawn], out, skeleton=model.skeleton, mark_names=model.mark_names, title=title)
    return {"samples": len(drawn)}


def _walks(model: Any, out: Path, n: int, seed: int, title: str) -> dict[str, Any]:
    """Walks at their own places, over their footprints."""
    import numpy as np

    from opsim.report.walks import draw_walks, walk_of

    drawn = model.sample(n, np.random.default_rng(seed))
    rows = [walk_of("mean performance", model.typical())]
    rows += [walk_of(f"sample {k + 1}", drawn[k]) for k in range(n)]
    draw_walks(rows, out, model.skeleton, title=title)
    return {"samples": n}


def _video(model: Any, out: Path, asked: Asked, seed: int, _title: str) -> dict[str, Any]:
    from opsim.cli.motion_video import video
    from opsim.cli.progress import progress
    from opsim.report.video_files import write_video

    made = video(model, n=asked.n or 3, people=asked.people or "new", person=asked.person, seed=seed)
    with progress(f"draw {model.task}") as report:
        write_video(made, out, report)
    cards = [{"card": caption.label, "said": caption.said} for caption in made.captions]
    return {"samples": asked.n or 3, "notes": dict(made.notes), "cards": cards, "bytes": out.stat().st_size}


def _beside(model: Any, out: Path, asked: Asked, seed: int, _title: str) -> dict[str, Any]:
    from opsim.cli.motion_beside import beside
    from opsim.report.animated import LETTERS, write_animated

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
    from opsim.cli.console import print_json

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
