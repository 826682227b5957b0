"""Runs the variants of the scenario files and gathers the figures of every replication."""

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
from known_answers.cases import HERE, Case
from known_answers.from_log import FROM_LOG

from opsim.engine.simpy_engine import run_plan
from opsim.kpi import figures
from opsim.laws import audit
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios

ASKED = ("throughput_per_h", "time_in_system_s", "work_in_progress")
Runs = dict[tuple[str, str], dict[str, np.ndarray]]


def simulate(cases: Sequence[Case], *, few: bool = False, processes: int = 1, done: Callable | None = None) -> Runs:
    """Figures by (file, variant) and name, (replications,) each: as many as the files say, or the cases' few.

    ``done(n, total)`` is called after each replication.
    """
    variants = {(case.file, case.variant): case.few for case in cases}
    names = {key: [*ASKED] for key in variants}
    for case in cases:
        names[case.file, case.variant] += [case.kpi] if case.kpi in FROM_LOG else []
    jobs = [
        (file, variant, replication, tuple(dict.fromkeys(names[file, variant])))
        for (file, variant), n in variants.items()
        for replication in range(n if few else _plan(file, variant)[1])
    ]
    found: dict[tuple[str, str], list[dict[str, float]]] = {}
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        results = pool.map(_one, jobs) if processes > 1 else map(_one, jobs)
        for n, ((file, variant, _, _), figure) in enumerate(zip(jobs, results), 1):
            found.setdefault((file, variant), []).append(figure)
            if done is not None:
                done(n, len(jobs))
    return {key: {name: np.array([r[name] for r in rows]) for name in names[key]} for key, rows in found.items()}


def _plan(file: str, variant: str):
    loaded = read_scenarios(HERE / f"{file}.yaml", [variant])[variant]
    return compile_plan(loaded), loaded.scenario.run.replications


def _one(job: tuple[str, str, int, tuple[str, ...]]) -> dict[str, float]:
    file, variant, replication, names = job
    plan = _plan(file, variant)[0]
    log = run_plan(plan, replication)
    audit(log, plan)
    found = {f.kpi: f.value for f in figures(log, plan) if f.kpi in ASKED and not f.subject and not f.part}
    return found | {name: FROM_LOG[name](log, plan) for name in names if name in FROM_LOG}
