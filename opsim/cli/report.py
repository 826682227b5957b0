"""``opsim report``: the report of a run once more, from what lies in its folder.

Writing the reports of a run: one file a variant, and a word on whatever could not be made.

What ``report``, ``view``, ``export`` and ``sql`` may not write over: the files that results are.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes


@click.command("report")
@click.argument("folder", metavar="RESULTS", type=click.Path(path_type=Path))
@click.option("--scenario", "names", multiple=True, metavar="NAME", help="Only this variant; may be given again.")
@click.option(
    "-o", "--out", metavar="FILE", type=click.Path(path_type=Path), help="Of one variant.  [default: its report.html]"
)
@click.option("--svg", metavar="FOLDER", type=click.Path(path_type=Path), help="Write every figure as an SVG file too.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(folder: Path, names: tuple[str, ...], out: Path | None, svg: Path | None, as_json: bool) -> None:
    """Write the report of each variant in the RESULTS of a run (or of one of its variants) again; nothing is run."""
    from opsim.cli.app import print_json
    from opsim.study.run import reopened

    with mistakes():
        beside, chosen = _variants(folder, names)
        paths = _paths(chosen, out)
        folders = None if svg is None else {name: svg / name if len(chosen) > 1 else svg for name in chosen}
        _check(beside, chosen, paths, folders or {})
        if svg is not None:
            from opsim.report.page import need_matplotlib

            need_matplotlib("figures as SVG files")
        runs = {name: reopened(result.folder) for name, result in chosen.items()}
        drawn = write_reports(runs, beside, paths, folders)
    if as_json:
        print_json({"reports": [_as_json(name, paths[name], drawn.get(name)) for name in paths]})
        return
    for name, path in paths.items():
        click.echo(f"report {name}: {path}")
        if folders is not None:
            click.echo(f"figures {name}: {len(drawn[name])} files in {folders[name]}")


def _variants(folder: Path, names: tuple[str, ...]) -> tuple[dict[str, Any], dict[str, Any]]:
    """(all variants of the run, those whose reports are wanted). Raises ValueError for names that are not there."""
    from opsim.problems import did_you_mean
    from opsim.results import variants_in

    found = variants_in(folder)
    if wrong := [name for name in names if name not in found]:
        raise ValueError("\n".join(f"{folder}: no variant {name!r}; {did_you_mean(name, found)}" for name in wrong))
    alone = (folder / "summary.json").is_file()
    beside = _beside(folder, next(iter(found.values()))) if alone else found
    return beside, {name: found[name] for name in found if name in names or not names}


def _beside(folder: Path, one: Any) -> dict[str, Any]:
    """The variants of the run that a variant's folder belongs to, as the folders beside it tell."""
    from opsim.results import variants_in

    same = ("scenario", "file", "seed")
    return {
        name: result
        for name, result in variants_in(folder.resolve().parent).items()
        if all(result.summary.get(key) == one.summary.get(key) for key in same)
    }


def _paths(chosen: dict[str, Any], out: Path | None) -> dict[str, Path]:
    if out is None:
        return {name: result.folder / "report.html" for name, result in chosen.items()}
    if len(chosen) > 1:
        names = ", ".join(chosen)
        raise ValueError(f"-o {out} is for one report, and there are {len(chosen)}: {names}; --scenario says which")
    return dict.fromkeys(chosen, out)


def _check(beside: dict[str, Any], chosen: dict[str, Any], paths: dict[str, Path], folders: dict[str, Path]) -> None:
    """Raises ValueError with all that is wrong with files to write and rows to read. Where no rows are, none are."""
    from opsim.cli.motion.files import wrong_folder
    from opsim.results import lacking_rows

    wrong = [words for path in paths.values() for words in wrong_page(path, beside)]
    wrong += [words for folder in folders.values() for each in (folder.parent, folder) for words in wrong_folder(each)]
    wrong += [words for result in chosen.values() if result.events_files and (words := lacking_rows(result))]
    if wrong:
        raise ValueError("\n".join(dict.fromkeys(wrong)))


def write_reports(
    runs: Mapping[str, Any],
    results: Mapping[str, Any],
    paths: Mapping[str, Path],
    svg: Mapping[str, Path] | None = None,
) -> dict[str, list[Path]]:
    """Write the report of each run to its path; returns the SVG files of each, where folders for them are given.

    results : of all variants, which stand beside each other in every report. Raises OSError, and ValueError where
    figures are wanted as SVG and matplotlib is not there.
    """
    from opsim.report import materials, write_report

    drawn: dict[str, list[Path]] = {}
    for name, material in materials(runs, results):
        written = write_report(material, paths[name])
        for reason, which in written.contents.missing:
            click.echo(f"warning: {name}: the report lacks {which}, which could not be made: {reason}", err=True)
        if svg is not None:
            from opsim.report.render import write_figures

            drawn[name] = write_figures(written.contents, svg[name])
    return drawn


def _as_json(name: str, path: Path, drawn: list[Path] | None) -> dict[str, Any]:
    figures = {} if drawn is None else {"figures": [str(one) for one in drawn]}
    return {"variant": name, "report": str(path), **figures}


def wrong_page(out: Path, held: Mapping[str, Any]) -> list[str]:
    """What keeps a page from being written; held : the Results that lie around. Its folder is made."""
    from opsim.cli.motion.files import ready

    try:
        ready(out, ".html")
    except ValueError as error:
        return [str(error)]
    return over_results(out, held)


def over_results(out: Path, held: Mapping[str, Any]) -> list[str]:
    """That ``out`` is a file of the results, by whatever path, in words."""
    from opsim.cli.motion.files import overwritten

    return overwritten(out, result=[file for result in held.values() for file in files_of(result)])


def files_of(result: Any) -> list[Path]:
    """The files that a variant's results are."""
    from opsim.results import events_in
    from opsim.study.results_folder import FINISHED, MANIFEST, RESOLVED

    named = (result.folder / name for name in (MANIFEST, RESOLVED, "summary.json", FINISHED))
    return [result.kpis_file, *named, *events_in(result.folder)]
