"""``opsim motion people``: how the people of recordings differ, and what it is worth to know who works."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import Interrupted, Mistake, mistakes


@click.command("people")
@click.argument("files", nargs=-1, required=True, metavar="FILE.npz...")
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True, help="The folder to write.")
@click.option(
    "--where", help="Which repetitions, such as 'cov_correct==1'; 'all' takes all.  [default: the correct ones]"
)
@click.option("--seed", type=click.IntRange(min=0), default=0, help="Decides the draws.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(files: tuple[str, ...], out: Path, where: str | None, seed: int, as_json: bool) -> None:
    """Leave out each repetition of each recording FILE, and each person, and ask how well draws foretell them.

    Draws of a repetition's own worker, of the same fit for nobody in particular, and of new people; with it how much of
    duration, posture and pace lies between people, and what the recordings' covariates tell of that.
    """
    from opsim.cli.motion.files import no_empty_folders
    from opsim.report.motion.people import PAGE

    with mistakes():
        sets = _read(files, where, out)
    found: list[Any] = []
    failed: list[str] = []
    try:
        with no_empty_folders(out):
            _prepare(out)
            for one in _found(sets, seed, failed):
                found.append(one)
                _write(out, found, seed)
    except KeyboardInterrupt:
        kept = f"{len(found)} of {len(sets)} tasks are in {out / PAGE}" if found else "nothing was finished"
        raise Interrupted(f"stopped; {kept}") from None
    if as_json:
        _print_json(found, out / PAGE)
    elif found:
        _print(found, out / PAGE)
    if failed:
        raise Mistake("\n".join(failed))


def _read(files: Sequence[str], where: str | None, out: Path) -> list[Any]:
    """The repetitions of each file. Raises ValueError with all that speaks against the work, before it is begun."""
    from emulator import read_motions
    from emulator.judge.people import refuse
    from opsim.cli.motion.files import wrong_folder

    chosen = {} if where is None else {"where": None if where == "all" else where}
    sets: list[Any] = []
    wrong: list[str] = []
    for file in files:
        try:
            motions = read_motions(file, **chosen)
            if motions.task in [other.task for other in sets]:
                wrong.append(f"{file}: a second file of the task {motions.task!r}")
            sets.append(motions)
            refuse(motions)
        except (ValueError, OSError) as error:
            wrong.append(str(error))
    wrong += wrong_folder(out)
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))
    return sets


def _prepare(out: Path) -> None:
    from opsim.cli.motion.files import ready

    with mistakes():
        ready(out / "index.html", ".html")


def _found(sets: Sequence[Any], seed: int, failed: list[str]) -> Iterator[Any]:
    """What is found of one task after another; a task that fails is named and takes nothing from the others."""
    from emulator.judge.people import n_steps, people_of, usual_settings
    from opsim.cli.progress import progress

    steps = [n_steps(motions) for motions in sets]
    with progress("people") as report:
        for place, motions in enumerate(sets):
            of_all = partial(_report, report, sum(steps[:place]), sum(steps))
            of_all(0)
            try:
                one = people_of(motions, usual_settings(seed), of_all)
            except ValueError as error:
                failed.append(f"{motions.task}: {str(error).removeprefix(f'{motions.task}: ')}")
                continue
            yield one
        report(sum(steps), sum(steps))


def _report(report: Callable[..., None], before: int, total: int, done: int, *_: Any) -> None:
    """A task's own progress, as that over all tasks."""
    report(before + done, total)


def _write(out: Path, found: Sequence[Any], seed: int) -> None:
    from opsim.report.motion.people import write_people

    with mistakes():
        write_people(out, found, seed)


def _print(found: Sequence[Any], page: Path) -> None:
    from opsim.cli.app import print_table, printable
    from opsim.report.motion.people import MEANING, UNITS, compact, notes, title, total

    for one in found:
        print_table(title(one), *compact(one))
        for note in notes(one):
            click.echo(printable(note))
        click.echo()
    for name, words in MEANING.items():
        click.echo(f"{name:7} {words}")
    click.echo(f"{UNITS}\n\n{total(found)}\npage: {page}")


def _print_json(found: Sequence[Any], page: Path) -> None:
    from opsim.cli.app import print_json
    from opsim.report.motion.people import as_plain, pairs

    closer, judged = pairs(found)
    tasks = {one.task: as_plain(one) for one in found}
    print_json({"page": str(page) if found else None, "pairs": {"closer": closer, "judged": judged}, "tasks": tasks})
