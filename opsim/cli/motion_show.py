"""``opsim motion show``: a task of a library as strips of stick figures, or moving beside recordings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import mistakes

MOST_BESIDE = 13
"""Recorded and emulated together have the letters A to Z."""


@click.command("show")
@click.argument("library")
@click.argument("task", required=False)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="A .png or .svg file.  [default: <task>.png]")
@click.option(
    "-n", "n", type=click.IntRange(min=1, max=20), help="Drawn performances.  [default: 3, with --beside 4 and 4]"
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True)
@click.option(
    "--beside",
    metavar="RECORDING.npz",
    help="An .html page instead: recorded performances of this file beside emulated ones, moving and unlabelled.",
)
@click.option("--where", help="Which repetitions of --beside, as for a fit.  [default: the correct ones]")
@click.option(
    "--people",
    type=click.Choice(["new", "recorded"]),
    help="Whom the emulated ones of --beside are of: others, or the people of the fit.  [default: new]",
)
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    library: str,
    task: str | None,
    out: Path | None,
    n: int | None,
    seed: int,
    beside: str | None,
    where: str | None,
    people: str | None,
    as_json: bool,
) -> None:
    """Draw a TASK of a LIBRARY along real time: the mean performance above drawn ones.

    With --beside, write a page on which recorded and emulated performances move side by side, and one guesses.
    """
    from opsim.cli.motion_files import chosen, ready
    from opsim.provenance import behind

    with mistakes():
        _refuse(out, n, beside, where, people)
        model = chosen(library, task)
        ending = ".png" if beside is None else ".html"
        out = out if out is not None else Path(f"{Path(model.task).name}{ending}")
        ready(out, *([".html"] if beside is not None else [".png", ".svg"]))
        report = model.report
        title = f"{model.task}: emulated from {behind(report.source, report.n_sequences, report.n_workers)}"
        if beside is None:
            said = _strips(model, out, n or 3, seed, title)
        else:
            said = _page(model, out, beside, where, n or 4, people or "new", seed)
    _tell({"task": model.task, "out": str(out), "seed": seed, "source": report.source, **said}, title, as_json)


def _refuse(out: Path | None, n: int | None, beside: str | None, where: str | None, people: str | None) -> None:
    """Raises ValueError with all that does not go together."""
    ending = "" if out is None else out.suffix.lower()
    wrong = []
    if beside is None:
        given = [f"--{name}" for name, value in (("where", where), ("people", people)) if value is not None]
        wrong += [f"{name}: found without --beside, expected --beside RECORDING.npz" for name in given]
        if ending == ".html":
            wrong.append(f"{out}: a page shows recordings beside what is emulated; expected --beside RECORDING.npz")
    elif out is not None and ending != ".html":
        wrong.append(f"{out}: found the ending {out.suffix!r}, expected .html with --beside")
    if beside is not None and n is not None and n > MOST_BESIDE:
        wrong.append(f"-n: found {n}, expected at most {MOST_BESIDE} with --beside (letters A to Z)")
    if wrong:
        raise ValueError("\n".join(wrong))


def _strips(model: Any, out: Path, n: int, seed: int, title: str) -> dict[str, Any]:
    from opsim.report import draw_strips

    draw_strips(model, out, n_samples=n, seed=seed, title=title)
    return {"samples": n}


def _page(model: Any, out: Path, file: str, where: str | None, n: int, people: str, seed: int) -> dict[str, Any]:
    from opsim.cli.motion_beside import beside
    from opsim.report.animated import LETTERS, write_animated

    made = beside(model, file, where=where, n=n, people=people, seed=seed)
    write_animated(made.cards, model.skeleton, out, task=model.task, notes=made.notes)
    cards = [
        {"card": letter, "real": card.is_real, "who": card.who, "duration_s": round(card.duration_s, 3)}
        for letter, card in zip(LETTERS, made.cards)
    ]
    return {"samples": n, "notes": dict(made.notes), "cards": cards}


def _tell(said: dict[str, Any], title: str, as_json: bool) -> None:
    """For people, without the answers: they are to guess."""
    from opsim.cli.console import print_json

    if as_json:
        print_json(said)
        return
    click.echo(title)
    for topic, words in said.get("notes", {"source": said["source"]}).items():
        click.echo(f"{topic}: {words}")
    click.echo(f"{'page' if 'cards' in said else 'picture'}: {said['out']}")
