"""One variant of a scenario, from what was read to a results folder."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from opsim.kpi.better import read_asked
from opsim.plan import compile_plan
from opsim.results import Result
from opsim.study.assumed.assumptions import Asked
from opsim.study.precision import MOST, Precision, replicate_until
from opsim.study.replicate import Progress, Replicated, replicate


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
) -> Result:
    """Run all replications of a scenario that was read and write the results folder (without its report).

    replications, seed : instead of the scenario's own
    overwrite : remove what the folder holds first; else finished replications of the same run are gone on with. Fewer
        replications than are finished: the results are of the first ones, the other rows stay for later
    precision : run as many replications as these figures need, at least 10 and at most ``replications`` (or 1,000)
    Raises OtherRun where the folder holds another run, OSError where it cannot be written, BrokenLog where a run
    contradicts itself, ProcessLost where a process is killed, ValueError where postures cannot be had.
    """
    from opsim.study.folder import open_folder, say_replications
    from opsim.study.manifest import digest
    from opsim.study.summary import summary_of, write_kpis
    from opsim.whole import write_json

    make_plan = partial(compile_plan, loaded, seed=seed)
    plan = make_plan()
    own = MOST if precision else loaded.scenario.run.replications
    n = own if replications is None else replications
    manifest = open_folder(folder, loaded, plan.seed, n, overwrite=overwrite)
    beside = (*(one.kpi for one in precision), *(read_asked(text).kpi for text in loaded.scenario.frontier or ()))
    outputs = (*loaded.scenario.outputs, *beside)

    def run(first: int, upto: int) -> list[Replicated]:
        made_from = digest(manifest)
        return replicate(
            make_plan,
            upto,
            folder,
            first=first,
            made_from=made_from,
            processes=processes,
            progress=progress,
            outputs=outputs,
        )

    done, reached = replicate_until(precision, n, run) if precision else (run(0, n), [])
    asked = Asked(seed, len(done) if precision else replications, "; ".join(one.words for one in reached))
    say_replications(folder, loaded, plan.seed, len(done))
    write_kpis(done, folder / "kpis.parquet")
    write_json(folder / "summary.json", summary_of(loaded, plan, done, asked, reached))
    return Result.load(folder)
