"""A finished run opened again: its rows, and the plan they came from, so that bodies can be drawn again.

The engine of one run: taken before its first replication, and looked at again where more of them come.

One variant of a scenario, from what was read to a results folder.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from opsim.engine import SIMPY
from opsim.engine.choice import Choice
from opsim.kpi.catalogue import read_asked
from opsim.plan import Plan, compile_plan
from opsim.results import Result, lacking_rows, read_object
from opsim.study.engine_choice import Chosen, compiled_for, engine_of
from opsim.study.intervals import FEWEST, MOST, Precision, replicate_until
from opsim.study.replication import Once, Progress, Replicated, missing, replicate, together
from opsim.study.results_folder import MANIFEST, RESOLVED, digest, manifest_of, say_engine

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded

NEEDED = {"libraries": "the library", "recorded": "the file"}
"""What a manifest holds the hashes of, in words."""


@dataclass(frozen=True)
class Reopened:
    """A variant's results folder with what it was run from.

    loaded : the variant as its ``scenario.resolved.yaml`` reads, under its own name; manifest : as it was written
    """

    result: Result
    loaded: Any
    manifest: dict[str, Any]

    @cached_property
    def plan(self) -> Any:
        """Compiled with the seed of the run."""

        return compile_plan(self.loaded, seed=self.result.summary["seed"])

    def log(self, replication: int = 0) -> Any:
        """The rows of one replication. Raises ValueError where the run has none such, OSError where it is broken."""
        from opsim.log_parquet import read_events

        if gone := lacking_rows(self.result):
            raise ValueError(gone)
        files = self.result.events_files
        if not 0 <= replication < len(files):
            raise ValueError(f"replication {replication}: {self.result.folder} holds 0 to {len(files) - 1}")
        return read_events(files[replication], digest(self.manifest))


def opened(result: Result, loaded: Loaded) -> Reopened:
    """A run that has just ended, as it was read. Raises OSError or ValueError where its manifest cannot be read."""
    return Reopened(result, loaded, _manifest(result.folder))


def reopened(folder: Path) -> Reopened:
    """The results of one variant of a run.

    Raises OSError where a file is missing, ValueError where the folder holds no run, or where a library or a file of
    times is no longer the one it was run with: other bodies would be shown than those whose times were spent.
    """
    from dataclasses import replace

    from opsim.scenario import read_scenarios

    result = Result.load(folder)
    manifest = _manifest(folder)
    loaded = next(iter(read_scenarios(folder / RESOLVED).values()))
    loaded = replace(loaded, variant=result.summary["variant"])
    if changed := _changed(manifest, manifest_of(loaded, result.summary["seed"])):
        raise ValueError(f"{folder}: {'; '.join(changed)} since it was run; run it again, or put back what there was")
    return Reopened(result, loaded, manifest)


def _manifest(folder: Path) -> dict[str, Any]:
    return read_object(folder / MANIFEST, "the manifest of a run")


def _changed(held: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Everything that is not as it was, in words."""
    found = []
    for kind, what in NEEDED.items():
        old, new = held.get(kind) or {}, now[kind]
        found += [f"{what} {name} has changed" for name in {**old, **new} if old.get(name) != new.get(name)]
    return found


class EngineOfRun:
    """Ready for replications 0 .. n-1 of a folder: written down, told of and compiled, where any is to be made."""

    def __init__(
        self, choice: Choice, loaded: Loaded, plan: Plan, folder: Path, processes: int | None, chosen: Chosen | None
    ):
        """chosen : is told the engine before anything is run"""
        self._choice, self._loaded, self._plan, self._folder = choice, loaded, plan, folder
        self._processes, self._chosen = processes, chosen
        self._is_ready, self._runs = False, 0

    def upto(self, n: int) -> Choice:
        """For the first n replications. Raises OSError where it cannot be written down."""
        left = missing(self._folder, n)
        self._runs += left
        if left and not self._is_ready:
            self._take(self._choice)
        elif left and self._choice.may_pay:
            again = engine_of(self._choice.asked, self._loaded, self._plan, self._runs, processes=self._processes)
            if again.engine != self._choice.engine:
                self._take(again)
        return self._choice

    def _take(self, choice: Choice) -> None:
        self._choice, self._is_ready = choice, True
        say_engine(self._folder, choice)
        compiled_for(choice, self._plan, self._chosen)


def run_scenario(
    loaded: Loaded,
    *,
    folder: Path,
    processes: int | None = None,
    replications: int | None = None,
    seed: int | None = None,
    progress: Progress | None = None,
    overwrite: bool = False,
    precision: Sequence[Precision] = (),
    meanwhile: Callable[[], None] | None = None,
    engine: str | Choice = SIMPY,
    chosen: Chosen | None = None,
) -> Result:
    """Run all replications of a scenario that was read and write the results folder (without its report).

    replications, seed : instead of the scenario's own
    overwrite : remove what the folder holds first; else finished replications of the same run are gone on with. Fewer
        replications than are finished: the results are of the first ones, the other rows stay for later. Results that
        are there of just this run are taken as they are
    precision : run as many replications as these figures need, at least 10 and at most ``replications`` (or 1,000)
    meanwhile : what is best done once while other processes compute
    engine : ``simpy``, ``fast`` or ``auto``, which give the same rows (opsim/engine/choice.py)
    chosen : is told the engine before anything is run; what it gives back is told how far the compiling is
    Raises ScenarioError where the fast engine is asked for and does not run this, OtherRun where the folder holds
    another run, Busy where somebody writes there now, OSError where it cannot be written, BrokenLog where a run
    contradicts itself, ProcessLost where a process is killed, ValueError where postures cannot be had.
    """
    from opsim.files import write_json
    from opsim.study.assumptions import Asked
    from opsim.study.results_folder import (
        LOCK,
        clear_results,
        digest,
        finished,
        locked,
        open_folder,
        say_finished,
        say_replications,
    )
    from opsim.study.summary import summary_of, write_kpis

    make_plan = Once(partial(compile_plan, loaded, seed=seed))
    plan: Plan = make_plan()
    n = replications if replications is not None else MOST if precision else loaded.scenario.run.replications
    least = FEWEST if precision else n
    runs = least if overwrite else missing(folder, least)
    choice = engine_of(engine, loaded, plan, runs, processes=processes)
    with locked(folder / LOCK, f"{folder}: another 'opsim run' writes there now; take another folder with -o, or wait"):
        manifest = open_folder(folder, loaded, plan.seed, n, overwrite=overwrite)
        asks = {"replications": replications, "seed": seed, "precision": [one.name for one in precision]}
        if finished(folder, loaded, manifest, asks):
            return Result.load(folder)
        clear_results(folder)
        run = partial(
            _replicated,
            make_plan,
            folder,
            EngineOfRun(choice, loaded, plan, folder, processes, chosen),
            made_from=digest(manifest),
            processes=processes,
            progress=progress,
            outputs=_outputs(loaded, precision),
            meanwhile=partial(_meanwhile, meanwhile),
        )
        done, reached = replicate_until(precision, n, run) if precision else (run(0, n), [])
        done = together(done)
        asked = Asked(seed, len(done) if precision else replications, "; ".join(one.words for one in reached))
        say_replications(folder, loaded, plan.seed, len(done))
        write_kpis(done, folder / "kpis.parquet")
        write_json(folder / "summary.json", summary_of(loaded, plan, done, asked, reached))
        say_finished(folder, loaded, manifest, asks, len(done))
    return Result.load(folder)


def _outputs(loaded: Loaded, precision: Sequence[Precision]) -> tuple[str, ...]:
    """Figures that are asked for anywhere."""
    frontier = (read_asked(text).kpi for text in loaded.scenario.frontier or ())
    return (*loaded.scenario.outputs, *(one.kpi for one in precision), *frontier)


def _replicated(make_plan: Once, folder: Path, engine: EngineOfRun, first: int, upto: int, **how) -> list[Replicated]:
    return replicate(make_plan, upto, folder, first=first, engine=engine.upto(upto), **how)


def _meanwhile(more: Callable[[], None] | None) -> None:
    """What the end of a run takes long to import."""
    import scipy.special  # noqa: F401

    if more is not None:
        more()
