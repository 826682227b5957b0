"""``opsim motion judge``: schemes judged on held-out repetitions, or as Chen, Park & Srivastava judged theirs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from opsim.cli.judging_held_out import show_held_out
from opsim.cli.verbs import mistakes

FEWEST = 12
"""Repetitions below which sequences cannot be tested against one another."""
USUAL_SPLITS = 5


@click.command("judge")
@click.argument("files", nargs=-1, required=True, metavar="FILE.npz...")
@click.option(
    "--scheme",
    "schemes",
    multiple=True,
    metavar="NAME",
    help="Which to judge; several may be given.  [default: Extrinsic/JointPCA/Smoothed and SIEM/SequentialPCA/MVG]",
)
@click.option("--paper", is_flag=True, help="Instead the paper's tables and figures, our scheme beside theirs.")
@click.option(
    "-o", "--out", type=click.Path(path_type=Path), help="A .csv file or a folder; with --paper the folder to write."
)
@click.option(
    "--page", type=click.Path(path_type=Path), help="A page, FILE.html: recorded and drawn side by side in real time."
)
@click.option(
    "--where", help="Which repetitions, such as 'cov_correct==1'; 'all' takes all.  [default: the correct ones]"
)
@click.option("--splits", type=click.IntRange(1, 100), help="How often to deal out the halves.  [default: 5]")
@click.option("--seed", type=click.IntRange(min=0), default=0, help="Decides the halves and the draws.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    files: tuple[str, ...],
    schemes: tuple[str, ...],
    paper: bool,
    out: Path | None,
    page: Path | None,
    where: str | None,
    splits: int | None,
    seed: int,
    as_json: bool,
) -> None:
    """Judge schemes on each recording FILE: fitted to half of everybody's repetitions, held against the other half.

    Emulators also in real time: speed, jerk, feet, balance, a classifier, and new people beside people left out.

    A name such as SIEM/JointPCA/MVG, for which there is an emulator, means the emulator; all others mean the scheme of
    the paper on aligned postures. Two controls, which copy, must be seen to fail.
    """
    from opsim.cli.judged_table import table_file

    with mistakes():
        sets = _read(files, where, paper, _misfits(schemes, paper, out, splits, page))
    target = out / "index.html" if paper and out is not None else table_file(out)
    with _written(target), _written(page):
        if paper and out is not None:
            _show_paper(sets, out, seed, as_json)
        else:
            show_held_out(sets, schemes, splits or USUAL_SPLITS, seed, target, as_json, page)


@contextmanager
def _written(target: Path | None) -> Iterator[None]:
    """The folder of this file is there, can be written, and is gone again if it stays empty."""
    from opsim.cli.motion_files import no_empty_folders, ready

    if target is None:
        yield
        return
    with no_empty_folders(target.parent):
        with mistakes():
            ready(target, ".csv", ".html")
        yield


def _misfits(schemes: Sequence[str], paper: bool, out: Path | None, splits: int | None, page: Path | None) -> list[str]:
    """Options that are wrong, or do not go together."""
    if not paper:
        from emulator.judge.held_out import unknown_names
        from opsim.cli.judged_table import wrong_table

        wrong_page = [f"{page}: expected a .html file for --page"] if page and page.suffix.lower() != ".html" else []
        return [*unknown_names(schemes), *wrong_table(out), *wrong_page]
    from opsim.cli.motion_files import wrong_folder

    wrong = ["--paper: expected a folder to write into, -o FOLDER"] if out is None else wrong_folder(out)
    given = {"--scheme": bool(schemes), "--splits": splits is not None, "--page": page is not None}
    return wrong + [f"{name}: does not go with --paper, which has schemes of its own" for name in given if given[name]]


def _read(files: Sequence[str], where: str | None, paper: bool, wrong: list[str]) -> list[Any]:
    """The repetitions of each file. Raises ValueError with all that speaks against judging, before anything is done."""
    from emulator import read_motions
    from emulator.judge.held_out_table import refuse

    chosen = {} if where is None else {"where": None if where == "all" else where}
    sets: list[Any] = []
    for file in files:
        try:
            motions = read_motions(file, **chosen)
            if not paper and len(motions) >= FEWEST:
                refuse(motions, ())
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


def _show_paper(sets: Sequence[Any], out: Path, seed: int, as_json: bool) -> None:
    from opsim.cli.console import print_json
    from opsim.cli.judging import judged

    page, tables = judged(sets, out, seed)
    if as_json:
        print_json({"page": str(page), "tables": tables})
        return
    click.echo(f"page: {page}")
