"""``opsim run``: every variant of a scenario, replicated, with its report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from opsim.cli.engine_option import engine_option
from opsim.cli.verbs import mistakes


@click.command("run")
@click.argument("file")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Results folder.  [default: results/<file's name>]")
@click.option("--scenario", "names", multiple=True, metavar="NAME", help="Only this variant; may be given again.")
@click.option("--replications", type=click.IntRange(min=1), help="Instead of the file's own.")
@click.option(
    "--precision",
    "wanted",
    multiple=True,
    metavar="FIGURE=PER CENT",
    help="As many replications as this needs, such as throughput_per_h=1%; --replications is then the most.",
)
@click.option("--seed", type=click.IntRange(min=0), help="Instead of the file's own.")
@click.option("--processes", type=click.IntRange(min=1), help="Processes to use.  [default: as many as pay]")
@engine_option()
@click.option("--horizon", metavar="TIME", help="Instead of the file's own, such as '8 h'.")
@click.option("--overwrite", is_flag=True, help="Remove what the results folder holds of another run (or of this one).")
@click.option("--replay", is_flag=True, help="Write replay.html too, as 'opsim view' does: the first replication.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    file: str,
    out: Path | None,
    names: tuple[str, ...],
    horizon: str | None,
    wanted: tuple[str, ...],
    replay: bool,
    as_json: bool,
    **how: Any,
) -> None:
    """Run a scenario FILE: its variants, each replicated, into one folder a variant with events, figures and report."""
    from shlex import quote

    from opsim.cli.console import print_json
    from opsim.cli.run_table import print_results
    from opsim.cli.running import run_variants

    with mistakes():
        how["precision"] = _precisions(wanted)
    out, variants, results = run_variants(file, out, names=names, horizon=horizon, **how)
    with mistakes(OSError, ValueError):
        reports = _reports(variants, results)
    replays = _replays(variants, results) if replay else {}
    if as_json:
        print_json({"results": [_as_json(name, results[name], reports[name], replays) for name in results]})
        return
    print_results(next(iter(variants.values())).scenario.name, results)
    for name, result in results.items():
        for one in result.summary["precision"]:
            click.echo(_reached(name, one, result.summary["replications"]))
    for name, result in results.items():
        for warning in result.summary["warnings"]:
            click.echo(f"warning: {name}: {warning}", err=True)
    for name, report in reports.items():
        click.echo(f"report {name}: {report}")
    for name, drawn in replays.items():
        for line in drawn.words():
            click.echo(line.replace("replay:", f"replay {name}:", 1))
    if not replay:
        click.echo(f"to see it move: opsim view {quote(str(out))}")


def _precisions(wanted: tuple[str, ...]) -> list[Any]:
    if not wanted:
        return []
    from opsim.study.precision import read_precision

    return [read_precision(text) for text in wanted]


def _reached(variant: str, one: dict[str, Any], n: int) -> str:
    found = "not known" if one["found"] is None else f"known within {100 * one['found']:.2g} %"
    words = f"{variant}: {one['figure']} is {found} after {n} replications, wanted: {100 * one['wanted']:.2g} %"
    return words if one["reached"] else f"{words}: not reached"


def _reports(variants: dict[str, Any], results: dict[str, Any]) -> dict[str, Path]:
    """Write the reports, unless each is there of just these results: one that is new stands in all of them."""
    from opsim.cli.reporting import write_reports
    from opsim.study.reopened import opened

    paths = {name: result.folder / "report.html" for name, result in results.items()}
    if not all(path.exists() for path in paths.values()):
        write_reports({name: opened(of, variants[name]) for name, of in results.items()}, results, paths)
    return paths


def _replays(variants: dict[str, Any], results: dict[str, Any]) -> dict[str, Any]:
    """Of the first replication of each variant, a page each."""
    from opsim.cli.replay_drawn import draw_replay
    from opsim.cli.view_asked import Wanted
    from opsim.study.reopened import opened

    runs = {name: opened(result, variants[name]) for name, result in results.items()}
    return {
        name: draw_replay(Wanted({name: run}, 0, None, run.result.folder / "replay.html")) for name, run in runs.items()
    }


def _as_json(name: str, result: Any, report: Path, replays: dict[str, Any]) -> dict[str, Any]:
    from opsim.study.folder import engine_said

    said = {"variant": name, "folder": str(result.folder), "engine": engine_said(result.folder), "report": str(report)}
    return said | ({"replay": str(replays[name].wanted.out)} if name in replays else {}) | {"summary": result.summary}
