"""Running every variant of a scenario into a folder each, with an answer in words to whatever may stop it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from opsim.cli.app import mistakes
from opsim.cli.progress import telling
from opsim.engine import SIMPY

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


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
