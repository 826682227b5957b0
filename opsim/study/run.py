"""One variant of a scenario, from what was read to a results folder."""

from functools import partial
from pathlib import Path

from opsim.plan import compile_plan
from opsim.results import Result
from opsim.study.replicate import Progress, replicate


def run_scenario(
    loaded,
    *,
    folder: Path,
    processes: int | None = None,
    replications: int | None = None,
    seed: int | None = None,
    progress: Progress | None = None,
) -> Result:
    """Run all replications of a scenario that was read and write the results folder (without its report).

    A folder that holds finished replications of exactly this scenario, seed and library is gone on with.
    Raises OSError where the folder cannot be written, BrokenLog where a run contradicts itself.
    """
    from opsim.study.manifest import manifest_of, open_folder
    from opsim.study.summary import summary_of, write_kpis
    from opsim.whole import write_json

    make_plan = partial(compile_plan, loaded, seed=seed)
    plan = make_plan()
    n = loaded.scenario.run.replications if replications is None else replications
    open_folder(folder, loaded, manifest_of(loaded, plan))
    done = replicate(make_plan, n, folder, processes=processes, progress=progress)
    write_kpis(done, folder / "kpis.parquet")
    write_json(folder / "summary.json", summary_of(loaded, plan, done))
    return Result.load(folder)
