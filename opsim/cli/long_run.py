"""``opsim long-run``: what one long replication, or a few, say of the steady state."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes
from opsim.cli.progress import engine_option


@click.command("long-run")
@click.argument("of", metavar="FILE|RESULTS")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Results folder, where a FILE is run first.")
@click.option("--scenario", "name", metavar="NAME", help="The variant to look at.  [default: base, or the first]")
@click.option("--horizon", metavar="TIME", help="Of a FILE, instead of its own, such as '200 h'.")
@click.option("--replications", type=click.IntRange(min=1), help="Of a FILE.  [default: 1]")
@click.option("--seed", type=click.IntRange(min=0), help="Of a FILE, instead of its own.")
@engine_option(None)
@click.option("--processes", type=click.IntRange(min=1), help="Processes to use for a FILE.  [default: as many as pay]")
@click.option("--warm-up", metavar="TIME", help="Leave out so much of the start.  [default: own, or MSER-5 if longer]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(of: str, out: Path | None, name: str | None, warm_up: str | None, as_json: bool, **how: Any) -> None:
    """Judge a long run: batch means with intervals, Welch's curve, and whether to believe it.

    A scenario FILE is run first, one long replication by default; RESULTS is the folder of a run, or of one variant.
    """
    from opsim.cli.app import print_json
    from opsim.cli.progress import progress
    from opsim.cli.run_variants import Failed
    from opsim.cli.study import print_study
    from opsim.files import write_json
    from opsim.report.page import write_study_page
    from opsim.report.studies.steady_state import long_run_page
    from opsim.study.long_run.steady_state import as_json as told
    from opsim.study.long_run.steady_state import look

    with mistakes():
        warm_up_s = _seconds(warm_up)
        result = _result(of, out, name, how)
    with mistakes(), progress("read") as report:
        run = look(result, warm_up_s, report)
    page, summary, failed = long_run_page(run), told(run), ""
    path: Path | None = result.folder / "long_run.html"
    try:
        write_study_page(page, result.folder / "long_run.html")
        write_json(result.folder / "long_run.json", summary)
    except OSError as error:
        path, failed = None, f"{result.folder}: cannot be written: {error.strerror or error}"
    if as_json:
        print_json(summary | {"page": None if path is None else str(path)})
    else:
        print_study(page, path)
    if failed:
        raise Failed(failed)


def _seconds(text: str | None) -> float | None:
    if text is None:
        return None
    from opsim.units import parse

    try:
        seconds = parse(text, "time")
    except ValueError as error:
        raise ValueError(f"--warm-up: {error}") from None
    if seconds < 0:
        raise ValueError(f"--warm-up: expected a time from 0 s on, found {text!r}")
    return seconds


def _result(of: str, out: Path | None, name: str | None, how: dict[str, Any]) -> Any:
    """The Result to look at: read, or run first."""
    folder = Path(of)
    if folder.is_dir():
        given = [f"--{key}" for key, value in {"out": out, **how}.items() if value is not None]
        if given:
            raise ValueError(f"{', '.join(given)}: only where a scenario FILE is run; {of} is a folder of results")
        return _of_folder(folder, name)
    from opsim.cli.run_variants import run_variants
    from opsim.scenario import read_scenarios

    known = read_scenarios(of)
    chosen = _chosen(known, name, of)
    how = {**how, "replications": how["replications"] or 1}
    out = out if out is not None else Path("results") / f"{known[chosen].file.stem}_long_run"
    _, _, results = run_variants(of, out, names=(chosen,), **how)
    return results[chosen]


def _of_folder(folder: Path, name: str | None) -> Any:
    from opsim.results import variants_in

    results = variants_in(folder)
    if name is None and len(results) > 1 and "base" not in results:
        raise ValueError(f"{folder}: several variants, say which with --scenario: {', '.join(results)}")
    return results[_chosen(results, name, str(folder))]


def _chosen(known: Any, name: str | None, where: str) -> str:
    from opsim.problems import did_you_mean

    if name is not None and name not in known:
        raise ValueError(f"{where}: no variant {name!r}; {did_you_mean(name, known, otherwise='there are')}")
    return name if name is not None else "base" if "base" in known else str(next(iter(known)))
