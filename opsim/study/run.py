"""One variant of a scenario, from what was read to a results folder."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from opsim.engine.choice import SIMPY, Choice
from opsim.kpi.better import read_asked
from opsim.plan import Plan, compile_plan
from opsim.results import Result
from opsim.study.assumed.assumptions import Asked
from opsim.study.engine_choice import Chosen, engine_of
from opsim.study.engine_of_run import EngineOfRun
from opsim.study.precision import FEWEST, MOST, Precision, replicate_until
from opsim.study.replicate import Once, Progress, missing, replicate
from opsim.study.replicated import Replicated, together


def run_scenario(
    loaded,
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
    from opsim.study.finished import finished, say_finished
    from opsim.study.folder import LOCK, clear_results, open_folder, say_replications
    from opsim.study.lock import locked
    from opsim.study.manifest import digest
    from opsim.study.summary import summary_of, write_kpis
    from opsim.whole import write_json

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


def _outputs(loaded, precision: Sequence[Precision]) -> tuple[str, ...]:
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
