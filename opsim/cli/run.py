"""``opsim run``: every variant of a scenario, replicated, with its report.

Running every variant of a scenario into a folder each, with an answer in words to whatever may stop it.

The table of a run: a row a figure, a column a variant.

Writing the reports of a run: one file a variant, and a word on whatever could not be made.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from opsim.cli.app import mistakes
from opsim.cli.progress import engine_option, telling
from opsim.engine import SIMPY

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


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


class Failed(click.ClickException):
    """Not the user's mistake, said in words all the same: exit code 1."""

    exit_code = 1

    def show(self, file: Any = None) -> None:
        click.echo(self.format_message(), err=True)


def run_variants(
    file: str,
    out: Path | None,
    *,
    names: tuple[str, ...] = (),
    horizon: str | None = None,
    check: Callable[[dict[str, Any]], None] | None = None,
    **how: Any,
) -> tuple[Path, dict[str, Any], dict[str, Any]]:
    """(results folder, variants as read, their Results); everything that is wrong is found before the first run.

    check : may raise ValueError of the variants as read; how : arguments of ``run_scenario``; engine : by its name
    """
    from opsim.cli.app import stops_once
    from opsim.threads import freeze, lean

    lean()
    with mistakes():
        variants, plans = _variants(file, names, horizon)
        if check is not None:
            check(variants)
        out = out if out is not None else Path("results") / next(iter(variants.values())).file.stem
        engines = _engines(variants, plans, out, how)
        _refuse_study(out, variants)
        out.mkdir(parents=True, exist_ok=True)
        if not how.get("overwrite"):
            _refuse_other_runs(variants, out, how.get("seed"), _way_out(out, how))
    freeze()
    said = set[str]() if len({one.words for one in engines.values()}) == 1 else None  # else each variant says its own
    with stops_once():
        return (
            out,
            variants,
            {
                name: _run(name, loaded, out / name, how | {"engine": engines[name]}, said)
                for name, loaded in variants.items()
            },
        )


def _refuse_study(out: Path, variants: dict[str, Any]) -> None:
    """The folder of a study is not mixed with results of a run, nor removed for them."""
    from opsim.study.jobs.folder import holds_study

    for folder in (out, *(out / name for name in variants)):
        if holds_study(folder):
            raise ValueError(f"{folder} holds a study, not results of 'opsim run'; take another folder with -o")


def _variants(file: str, names: tuple[str, ...], horizon: str | None) -> tuple[dict[str, Any], dict[str, Any]]:
    """The variants and their Plans: a broken library or file of times is so found before the first run."""
    from opsim.plan import compile_plan
    from opsim.scenario import read_scenarios

    changes = {} if horizon is None else {"run.horizon": horizon}
    loaded = read_scenarios(file, list(names) or None, changes, "command line")
    return loaded, {name: compile_plan(variant) for name, variant in loaded.items()}


def _engines(variants: dict[str, Any], plans: dict[str, Any], out: Path, how: dict[str, Any]) -> dict[str, Any]:
    """The engine of each variant. Raises ScenarioError with all that the fast engine does not run, if it is asked."""
    from opsim.study.engine_choice import engines_of
    from opsim.study.intervals import FEWEST
    from opsim.study.replication import missing

    least = FEWEST if how.get("precision") else how.get("replications")
    runs = {name: least or loaded.scenario.run.replications for name, loaded in variants.items()}
    if not how.get("overwrite"):
        runs = {name: missing(out / name, n) for name, n in runs.items()}
    both = {name: (loaded, plans[name]) for name, loaded in variants.items()}
    return engines_of(how.get("engine") or SIMPY, both, runs, processes=how.get("processes"))


def _way_out(out: Path, how: dict[str, Any]) -> str:
    """What to do about another run in the folder: not every verb can remove it."""
    if "overwrite" in how:
        return "take another folder with -o, or --overwrite to remove what is there"
    return f"take another folder with -o, or 'opsim compare {out}' to compare what is there"


def _refuse_other_runs(variants: dict[str, Any], out: Path, seed: int | None, way_out: str) -> None:
    """All folders that hold another run are said at once, before anything is run or removed."""
    from opsim.study.results_folder import other_run

    found = [
        other_run(out / name, loaded, loaded.scenario.run.seed if seed is None else seed)
        for name, loaded in variants.items()
    ]
    if words := [words for words in found if words is not None]:
        raise ValueError("\n".join([*words, way_out]))


def _run(name: str, loaded: Loaded, folder: Path, how: dict[str, Any], said: set[str] | None) -> Any:
    from opsim.cli.app import stopped
    from opsim.cli.progress import progress
    from opsim.study import run_scenario
    from opsim.study.intervals import NoSuchFigure
    from opsim.study.results_folder import Busy, OtherRun

    kept = f"finished replications are kept in {folder}; the same command goes on from there"
    try:
        with mistakes(OSError, OtherRun, Busy, NoSuchFigure), failures(kept), progress(f"run {name}") as report:
            chosen = telling(f"run {name}", report, said)
            return run_scenario(loaded, folder=folder, progress=report, meanwhile=_report_modules, chosen=chosen, **how)
    except KeyboardInterrupt as stop:
        raise stopped(stop, kept) from None


@contextmanager
def failures(kept: str) -> Iterator[None]:
    """What is neither the user's mistake nor to be met with a traceback. Set OPSIM_TRACEBACK=1 to see where."""
    from opsim.engine.endless import EndlessInstant
    from opsim.laws.audit import BrokenLog
    from opsim.pool import ProcessLost

    try:
        yield
    except (ProcessLost, MemoryError, BrokenLog, EndlessInstant) as error:
        if os.environ.get("OPSIM_TRACEBACK"):
            raise
        said = {
            ProcessLost: f"{error}; {kept}; try --processes 1",
            MemoryError: f"out of memory; {kept}; try --processes 1",
            BrokenLog: f"a run contradicts itself, which is a mistake in opsim: please report it\n{error}\n{kept}",
            EndlessInstant: f"the simulation does not move on in time\n{error}\n{kept}",
        }
        raise Failed(next(words for kind, words in said.items() if isinstance(error, kind))) from None


def _report_modules() -> None:
    """What the end of ``opsim run`` takes long to import, while other processes compute."""
    from importlib import import_module

    from opsim.report.page import template
    from opsim.report.render import modules

    for name in ("rich.table", "opsim.report.render", *modules()):
        import_module(name)
    template("report.html.jinja")


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
