"""Runs the variants of the scenario files and gathers the figures of every replication."""

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import lru_cache
from multiprocessing import get_context

import numpy as np
from known_answers.cases import HERE, Case
from known_answers.from_log import FROM_LOG

from opsim.engine import SIMPY
from opsim.engine.choice import Run, able_to, runner_of
from opsim.kpi import figures
from opsim.laws.audit import audit
from opsim.plan import Plan, compile_plan
from opsim.scenario import read_scenarios

ASKED = ("throughput_per_h", "time_in_system_s", "work_in_progress")
Runs = dict[tuple[str, str], dict[str, np.ndarray]]


def simulate(
    cases: Sequence[Case],
    *,
    few: bool = False,
    processes: int = 1,
    done: Callable | None = None,
    engine: str = SIMPY,
    audited: bool = True,
) -> Runs:
    """Figures by (file, variant) and name, (replications,) each: as many as the files say, or the cases' few.

    ``done(n, total)`` is called after each replication; ``audited`` ones obey all laws. Raises NotFast where the fast
    engine is asked for and cannot.
    """
    variants = {(case.file, case.variant): case.few for case in cases}
    names = {key: [*ASKED] for key in variants}
    for case in cases:
        names[case.file, case.variant] += [case.kpi] if case.kpi in FROM_LOG else []
    jobs = [
        (engine, audited, file, variant, replication, tuple(dict.fromkeys(names[file, variant])))
        for (file, variant), n in variants.items()
        for replication in range(n if few else _loaded(file, variant).scenario.run.replications)
    ]
    found: dict[tuple[str, str], list[dict[str, float]]] = {}
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        results = pool.map(_one, jobs) if processes > 1 else map(_one, jobs)
        for n, ((_, _, file, variant, _, _), figure) in enumerate(zip(jobs, results), 1):
            found.setdefault((file, variant), []).append(figure)
            if done is not None:
                done(n, len(jobs))
    return {key: {name: np.array([r[name] for r in rows]) for name in names[key]} for key, rows in found.items()}


@lru_cache(2)  # the jobs of a variant follow each other, and the fast engine keeps the floor of a Plan
def plan_of(file: str, variant: str) -> Plan:
    """What a variant of a file says."""
    return compile_plan(_loaded(file, variant))


def _loaded(file: str, variant: str):
    return read_scenarios(HERE / f"{file}.yaml", [variant])[variant]


@lru_cache(2)
def _runner(engine: str, file: str, variant: str) -> Run:
    return runner_of(able_to(engine, plan_of(file, variant)))


def _one(job: tuple[str, bool, str, str, int, tuple[str, ...]]) -> dict[str, float]:
    engine, audited, file, variant, replication, names = job
    plan = plan_of(file, variant)
    log = _runner(engine, file, variant)(plan, replication)
    if audited:
        audit(log, plan)
    found = {f.kpi: f.value for f in figures(log, plan) if f.kpi in ASKED and not f.subject and not f.part}
    return found | {name: FROM_LOG[name](log, plan) for name in names if name in FROM_LOG}
