"""``opsim merge``: shards of one study put together."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes


@click.command("merge")
@click.argument("folders", metavar="FOLDER...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Folder.  [default: FOLDER, where there is one]")
@click.option("--file", metavar="FILE", help="The scenario, where it is not where it was.")
@click.option("--overwrite", is_flag=True, help="Remove what the folder holds of another study (or this one).")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(folders: tuple[Path, ...], out: Path | None, file: str | None, overwrite: bool, as_json: bool) -> None:
    """Finish a study that was computed in shards (--shard i/n), from the FOLDERs of all of them.

    What comes out is what one command without shards would have written, byte for byte.
    """
    from opsim.cli.app import stopped, stops_once
    from opsim.cli.study import show

    try:
        with stops_once(), mistakes():
            to = _out(folders, out, overwrite)
            kind, told = _merged(folders, to, file, overwrite)
    except KeyboardInterrupt as stop:
        raise stopped(stop, "the shards are as they were") from None
    show(kind, told, to, as_json)


def _out(folders: tuple[Path, ...], out: Path | None, overwrite: bool) -> Path:
    if out is None and len(folders) > 1:
        raise ValueError("several folders: say with -o where the whole study goes")
    to = folders[0] if out is None else out
    if overwrite and to.resolve() in [folder.resolve() for folder in folders]:
        raise ValueError(f"--overwrite would remove {to}, which is to be merged")
    return to


def _merged(folders: tuple[Path, ...], out: Path, file: str | None, overwrite: bool) -> tuple[Any, Any]:
    """(kind, told); nothing is written before everything is there."""
    from opsim.cli.study import said_damaged, write_study
    from opsim.cli.study_options import asked_again, header_for, kind_of
    from opsim.study.jobs import Answers
    from opsim.study.jobs.folder import OtherStudy, open_study
    from opsim.study.jobs.header import made_differ, write_together
    from opsim.study.jobs.job import Missing
    from opsim.study.jobs.merge import copy_answers, journals_of, missing_words, one_header, one_journal

    held = one_header(folders)
    kind = kind_of(held.kind)
    asked = asked_again(kind, held, file)
    header = header_for(kind, asked, tuple(held.words), held.replications)
    if differ := made_differ(held.made_from, header.made_from):
        raise OtherStudy(f"{folders[0]} was made from something else than is here now: {'; '.join(differ)}")
    files = journals_of(folders)
    with closing(one_journal(files)) as journal:
        said_damaged(journal)
        answers = Answers(asked.source, journal, compute=False)
        try:
            told = kind.study(asked, answers)
        except Missing as missing:
            raise ValueError(missing_words(missing, held, folders, files)) from None
        with open_study(out, header, asked.loaded.resolved, overwrite=overwrite) as study:
            write_together(journals_of([*folders, out]), out)
            copy_answers(answers, journal, study.journal)
            write_study(kind, asked, told, answers, out)
    return kind, told
