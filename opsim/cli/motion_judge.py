"""``opsim motion judge``: the schemes of Chen, Park & Srivastava and ours, judged on recordings as they judged."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import mistakes

FEWEST = 12
"""Repetitions below which sequences cannot be tested against one another."""


@click.command("judge")
@click.argument("files", nargs=-1, required=True, metavar="FILE.npz...")
@click.option("--paper", is_flag=True, required=True, help="The paper's tables and figures, our scheme beside theirs.")
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="The folder to write.")
@click.option("--where", default="all", help="Which repetitions, such as 'cov_correct==1'.  [default: all]")
@click.option("--seed", type=click.IntRange(min=0), default=0, help="Decides the draws.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(files: tuple[str, ...], paper: bool, out: Path, where: str, seed: int, as_json: bool) -> None:
    """Judge the schemes of the paper, and ours, on each recording FILE; write tables, figures and a page."""
    from opsim.cli.console import print_json

    with mistakes():
        sets = _read(files, where)
        _folder(out)
        page, tables = _judged(sets, out, seed)
    if as_json:
        print_json({"page": str(page), "tables": tables})
        return
    click.echo(f"page: {page}")


def _read(files: Sequence[str], where: str) -> list[Any]:
    """The repetitions of each file. Raises ValueError with all that speaks against judging, before anything is done."""
    from emulator import read_motions

    sets: list[Any] = []
    wrong: list[str] = []
    for file in files:
        try:
            motions = read_motions(file, where=None if where == "all" else where)
        except (ValueError, OSError) as error:
            wrong.append(str(error))
            continue
        if len(motions) < FEWEST:
            wrong.append(f"{file}: found {len(motions)} repetitions, expected {FEWEST} or more to be judged")
        if motions.task in [other.task for other in sets]:
            wrong.append(f"{file}: a second file of the task {motions.task!r}")
        sets.append(motions)
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))
    return sets


def _folder(out: Path) -> None:
    from opsim.cli.motion_files import ready

    if out.is_file():
        raise ValueError(f"{out}: found a file, expected a folder to write into")
    ready(out / "index.html", ".html")


def _judged(sets: Sequence[Any], out: Path, seed: int) -> tuple[Path, dict[str, Any]]:
    from opsim.cli.judging import N_STEPS, sections
    from opsim.cli.progress import progress
    from opsim.report.paper.write import write_paper

    made = []
    with progress("judge") as report:
        total = N_STEPS * len(sets)
        for n, (section, label) in enumerate(_steps(sections(sets, seed)), 1):
            report(min(n, total), total, label)
            made += [] if section is None else [section]
    words = [f"{m.task}: {len(m)} repetitions of {len(m.workers)} people, {m.selection}; {m.source}" for m in sets]
    page = write_paper(out, "Schemes of human motion, judged", words, made)
    return page, {s.name: {f"table {t.number}": [list(row) for row in t.rows] for t in s.tables} for s in made}


def _steps(found: Iterator[Any]) -> Iterator[tuple[Any, str]]:
    """Sections as they come, and names of the steps between."""
    for item in found:
        yield (None, item) if isinstance(item, str) else (item, f"{item.name} done")
