"""``opsim run``: every variant of a scenario, replicated, with its report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

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
@click.option("--horizon", metavar="TIME", help="Instead of the file's own, such as '8 h'.")
@click.option("--overwrite", is_flag=True, help="Remove what the results folder holds of another run (or of this one).")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    file: str,
    out: Path | None,
    names: tuple[str, ...],
    horizon: str | None,
    wanted: tuple[str, ...],
    as_json: bool,
    **how: Any,
) -> None:
    """Run a scenario FILE: its variants, each replicated, into one folder a variant with events, figures and report."""
    from opsim.cli.console import print_json
    from opsim.cli.run_table import print_results
    from opsim.cli.running import run_variants

    with mistakes():
        how["precision"] = _precisions(wanted)
    _, variants, results = run_variants(file, out, names=names, horizon=horizon, **how)
    with mistakes(OSError):
        reports = _reports(variants, results)
    if as_json:
        print_json({"results": [_as_json(name, results[name], reports[name]) for name in results]})
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
    """Write the report of each variant that has none of just these results; strips of one model are drawn once."""
    from opsim.report import bodies_section, curves_section, days_section, scenario_strips, walks_section, write_report

    reports: dict[str, Path] = {}
    drawn: dict[tuple[str, str], bytes] = {}
    for name, result in results.items():
        reports[name] = path = result.folder / "report.html"
        if path.exists():
            continue
        strips = scenario_strips(variants[name], result.summary["tasks"], drawn)
        walks = walks_section(variants[name], result)
        days = days_section(variants[name], result)
        bodies = bodies_section(variants[name], result)
        curves = curves_section(variants[name], result)
        write_report(result, path, strips, walks, days, bodies, curves)
    return reports


def _as_json(name: str, result: Any, report: Path) -> dict[str, Any]:
    return {"variant": name, "folder": str(result.folder), "report": str(report), "summary": result.summary}
