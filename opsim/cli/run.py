"""``opsim run``: every variant of a scenario, replicated, with its report.

The table of a run: a row a figure, a column a variant.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from opsim.cli.app import mistakes
from opsim.cli.progress import engine_option

if TYPE_CHECKING:
    pass


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

    from opsim.cli.app import print_json
    from opsim.cli.run_variants import run_variants

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
    from opsim.study.intervals import read_precision

    return [read_precision(text) for text in wanted]


def _reached(variant: str, one: dict[str, Any], n: int) -> str:
    found = "not known" if one["found"] is None else f"known within {100 * one['found']:.2g} %"
    words = f"{variant}: {one['figure']} is {found} after {n} replications, wanted: {100 * one['wanted']:.2g} %"
    return words if one["reached"] else f"{words}: not reached"


def _reports(variants: dict[str, Any], results: dict[str, Any]) -> dict[str, Path]:
    """Write the reports, unless each is there of just these results: one that is new stands in all of them."""
    from opsim.study.run import opened

    paths = {name: result.folder / "report.html" for name, result in results.items()}
    if not all(path.exists() for path in paths.values()):
        from opsim.cli.report import write_reports

        write_reports({name: opened(of, variants[name]) for name, of in results.items()}, results, paths)
    return paths


def _replays(variants: dict[str, Any], results: dict[str, Any]) -> dict[str, Any]:
    """Of the first replication of each variant, a page each."""
    from opsim.cli.view import Wanted, draw_replay
    from opsim.study.run import opened

    runs = {name: opened(result, variants[name]) for name, result in results.items()}
    return {
        name: draw_replay(Wanted({name: run}, 0, None, run.result.folder / "replay.html")) for name, run in runs.items()
    }


def _as_json(name: str, result: Any, report: Path, replays: dict[str, Any]) -> dict[str, Any]:
    from opsim.study.results_folder import engine_said

    said = {"variant": name, "folder": str(result.folder), "engine": engine_said(result.folder), "report": str(report)}
    return said | ({"replay": str(replays[name].wanted.out)} if name in replays else {}) | {"summary": result.summary}


_ALWAYS = ("work", "blocked", "loaded")
_WHERE_LARGE = {
    "station_states": (
        *("setup", "down", "repair", "parts", "tool", "place", "pickup", "away", "takt", "line_stop", "pause"),
        "waiting",
    ),
    "worker_states": ("setup", "walk", "held", "behind", "team", "tool", "absent"),
}
"""States beside those of ``_ALWAYS``, shown where some variant has more of them than ``_LARGE``; the report has all."""
_LARGE = 0.05
_BY_STOP = (
    *("stops_per_h", "down_s", "wait_for_repair_s", "stop_share"),
    *("incomplete_share", "line_stopped_share", "handoff_position", "experience"),
)
Cells = dict[str, dict[str, Any]]


def print_results(title: str, results: dict[str, Any]) -> None:
    """One row a figure, one column a variant; of states those that matter (``_ALWAYS``, ``_WHERE_LARGE``), and how many
    are left out.
    """
    from opsim.cli.app import print_table
    from opsim.kpi.parts import part_name
    from opsim.report.numbers import kpi_name, largest_mean, plus_minus

    hours = any("scheduled_h" in result.summary for result in results.values())
    found: dict[str, dict[tuple[str, str], Cells]] = {}
    for name, result in results.items():
        for row in result.summary["kpis"]:
            if row["headline"]:
                found.setdefault(row["kpi"], {}).setdefault((row["subject"], row["part"]), {})[name] = row
    rows, left_out = [], []
    for kpi, by_subject in found.items():
        kept = {of: c for of, c in by_subject.items() if matters(kpi, of[1], c) and not _says_again(of, by_subject)}
        left_out += list(_left_out(kpi, [c for of, c in by_subject.items() if of not in kept]))
        largest = largest_mean(row for cells in kept.values() for row in cells.values())
        for of, cells in kept.items():
            texts = [plus_minus(cells[name], largest) if name in cells else "" for name in results]
            named = of[0], part_name(kpi, of[1])
            rows.append((kpi_name(kpi, hours), " ".join(filter(None, named)), *texts))
    heading = _heading(title, [result.summary for result in results.values()])
    print_table(heading, ("figure", "of", *results), without_repeats(rows), words=2)
    for line in left_out:
        click.echo(line)


def _left_out(kpi: str, rows: Sequence[Mapping[str, Mapping[str, Any]]]) -> Iterator[str]:
    """How many states that there are in some variant are not shown, and where they are."""
    from opsim.report.numbers import kpi_name

    n = sum(any((row["mean"] or 0) > 0 for row in cells.values()) for cells in rows)
    if kpi in _WHERE_LARGE and n:
        rows_are = "row is" if n == 1 else "rows are"
        which = f"waiting, breaks, and states of at most {100 * _LARGE:g} %"
        yield f"{kpi_name(kpi)}: {n} {rows_are} not shown here ({which}); the report has all"


def matters(kpi: str, part: str, cells: Mapping[str, Mapping[str, Any]]) -> bool:
    """Whether a row is shown. cells : by variant, the row of its summary."""
    from opsim.report.sections.common import SHOWN_WHERE_ANY, is_shown

    if not part or part in _ALWAYS or kpi in _BY_STOP:
        return True
    if kpi.startswith("exposure_by_") and part.endswith("_at_most"):
        return False
    if kpi in SHOWN_WHERE_ANY:
        return is_shown(kpi, part, cells.values())
    return part in _WHERE_LARGE.get(kpi, ()) and any((row["mean"] or 0) > _LARGE for row in cells.values())


def _says_again(of: tuple[str, str], found: Mapping[tuple[str, str], Cells]) -> bool:
    """Whether a row is one of at most that is the same as at least in all variants."""
    from opsim.report.sections.common import says_again

    own = {part: cells for (subject, part), cells in found.items() if subject == of[0]}
    beside = {part: [cells.get(name, {}) for name in found[of]] for part, cells in own.items()}
    return says_again(of[1], list(found[of].values()), beside)


def without_repeats(rows: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Rows whose first cell is left out where it is that of the row above."""
    return [("", *row[1:]) if i and row[0] == rows[i - 1][0] else row for i, row in enumerate(rows)]


def _heading(title: str, summaries: list[dict[str, Any]]) -> str:
    counts = sorted({summary["replications"] for summary in summaries})
    count = " to ".join(str(n) for n in dict.fromkeys((counts[0], counts[-1])))
    noun = "replication" if counts == [1] else "replications"
    first = summaries[0]
    return f"{title}: {count} {noun}, seed {first['seed']}, mean ± half-width of the {first['confidence']:.0%} interval"
