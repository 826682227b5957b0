"""``opsim run``: every variant of a scenario, replicated, with its report."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from opsim.cli.verbs import Interrupted, mistakes


@click.command("run")
@click.argument("file")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Results folder.  [default: results/<file's name>]")
@click.option("--scenario", "names", multiple=True, metavar="NAME", help="Only this variant; may be given again.")
@click.option("--replications", type=click.IntRange(min=1), help="Instead of the file's own.")
@click.option("--seed", type=click.IntRange(min=0), help="Instead of the file's own.")
@click.option("--processes", type=click.IntRange(min=1), help="Processes to use.  [default: as many as pay]")
@click.option("--horizon", metavar="TIME", help="Instead of the file's own, such as '8 h'.")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    file: str, out: Path | None, names: tuple[str, ...], horizon: str | None, as_json: bool, **how: Any
) -> None:
    """Run a scenario FILE: its variants, each replicated, into one folder a variant with events, figures and report."""
    from opsim.cli.console import print_json

    with mistakes():
        variants = _variants(file, names, horizon)
        out = out if out is not None else Path("results") / next(iter(variants.values())).file.stem
        out.mkdir(parents=True, exist_ok=True)
    results = {}
    for name, loaded in variants.items():
        results[name] = _run(name, loaded, out / name, how)
    with mistakes(OSError):
        reports = _reports(variants, results)
    if as_json:
        print_json({"results": [_as_json(name, results[name], reports[name]) for name in results]})
        return
    _print_results(next(iter(variants.values())).scenario.name, results)
    for name, report in reports.items():
        click.echo(f"report {name}: {report}")


def _variants(file: str, names: tuple[str, ...], horizon: str | None) -> dict[str, Any]:
    """The variants, each planned once, so that a broken library or file of times is found before the first run."""
    from opsim.plan import compile_plan
    from opsim.scenario import read_scenarios

    loaded = read_scenarios(file, list(names) or None)
    if horizon is not None:
        loaded = {name: _until(variant, horizon) for name, variant in loaded.items()}
    for variant in loaded.values():
        compile_plan(variant)
    return loaded


def _until(loaded: Any, horizon: str) -> Any:
    """The variant with another horizon, as if it stood in the file."""
    from opsim.units import parse

    horizon_s, run = parse(horizon, "time"), loaded.scenario.run
    if horizon_s <= run.warm_up_s:
        raise ValueError(f"--horizon {horizon}: must be longer than the warm-up of {run.warm_up_s:g} s")
    scenario = loaded.scenario.model_copy(update={"run": run.model_copy(update={"horizon_s": horizon_s})})
    resolved = {**loaded.resolved, "run": {**loaded.resolved["run"], "horizon": horizon}}
    return replace(loaded, scenario=scenario, resolved=resolved)


def _run(name: str, loaded: Any, folder: Path, how: dict[str, Any]) -> Any:
    from opsim.cli.progress import progress
    from opsim.study import run_scenario

    try:
        with mistakes(OSError), progress(f"run {name}") as report:
            return run_scenario(loaded, folder=folder, progress=report, **how)
    except KeyboardInterrupt:
        kept = f"finished replications are kept in {folder}; the same command goes on from there"
        raise Interrupted(f"stopped; {kept}") from None


def _reports(variants: dict[str, Any], results: dict[str, Any]) -> dict[str, Path]:
    """Write the report of each variant; strips of one model are drawn once."""
    from opsim.report import scenario_strips, write_report

    reports: dict[str, Path] = {}
    drawn: dict[tuple[str, str], bytes] = {}
    for name, result in results.items():
        strips = scenario_strips(variants[name], result.summary["tasks"], drawn)
        reports[name] = write_report(result, result.folder / "report.html", strips)
    return reports


def _as_json(name: str, result: Any, report: Path) -> dict[str, Any]:
    return {"variant": name, "folder": str(result.folder), "report": str(report), "summary": result.summary}


def _print_results(title: str, results: dict[str, Any]) -> None:
    """One row a figure, one column a variant; the states of workers and stations as far as they are work or blocked."""
    from opsim.cli.console import print_table
    from opsim.report.words import kpi_name, largest_mean, plus_minus

    found: dict[str, dict[tuple[str, str], dict[str, Any]]] = {}
    for name, result in results.items():
        for row in result.summary["kpis"]:
            if row["headline"] and row["part"] in ("", "work", "blocked"):
                found.setdefault(row["kpi"], {}).setdefault((row["subject"], row["part"]), {})[name] = row
    rows = []
    for kpi, by_subject in found.items():
        largest = largest_mean(row for cells in by_subject.values() for row in cells.values())
        for of, cells in by_subject.items():
            texts = [plus_minus(cells[name], largest) if name in cells else "" for name in results]
            rows.append((kpi_name(kpi), " ".join(filter(None, of)), *texts))
    print_table(
        _heading(title, next(iter(results.values())).summary),
        ("figure", "of", *results),
        _without_repeats(rows),
        words=2,
    )


def _heading(title: str, summary: dict[str, Any]) -> str:
    n = summary["replications"]
    count = "1 replication" if n == 1 else f"{n} replications"
    return f"{title}: {count}, seed {summary['seed']}, mean ± half-width of the {summary['confidence']:.0%} interval"


def _without_repeats(rows: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    return [("", *row[1:]) if i and row[0] == rows[i - 1][0] else row for i, row in enumerate(rows)]
