"""What is measured of the fast engine in a process of its own: ``python -m bench.fast_runs WHAT ...`` prints numbers.

first_row SCENARIO : clock seconds of reading the scenario, importing the engine, making ready, the first run; CPU too
memory             : MB of a floor of 100 stations and 100 workers
replications ENGINE N : N replications of a line on 2 cores; clock seconds, CPU seconds, jobs finished in each
"""

import json
import os
import re
import resource
import subprocess
import sys
from functools import cache, partial
from pathlib import Path
from time import perf_counter

N_STATIONS, BUFFER, MEAN, HORIZON = 20, 5, "60 s", "8 h"
BEGAN = perf_counter()


def first_row(file: str, text: str = "") -> dict:
    from opsim.plan import compile_plan
    from opsim.scenario.read import scenarios_in

    path = Path(file)
    plan = compile_plan(scenarios_in(text.encode() or path.read_bytes(), path)["base"])
    read = perf_counter()
    from opsim.engine.fast_engine import ready, run_plan

    imported = perf_counter()
    compiled = []
    cpu_s = [_cpu_s()]
    ready(plan, lambda _done, total: compiled.append(total))
    made = perf_counter()
    cpu_s.append(_cpu_s())
    rows = len(run_plan(plan, 0))
    ran = perf_counter()
    cpu_s.append(_cpu_s())
    run_plan(plan, 1)
    return {
        "read_s": read - BEGAN,
        "import_s": imported - read,
        "ready_s": made - imported,
        "run_s": ran - made,
        "again_s": perf_counter() - ran,
        "before_cpu_s": cpu_s[0],
        "ready_cpu_s": cpu_s[1] - cpu_s[0],
        "run_cpu_s": cpu_s[2] - cpu_s[1],
        "rows": rows,
        "compiled": max(compiled, default=0),
    }


def line_text(n_stations: int = N_STATIONS, horizon: str = HORIZON) -> str:
    """A saturated line, a worker each, lognormal tasks."""
    from plans import line

    text = line(n_stations, BUFFER, horizon=horizon, warm_up="0 s", mean=MEAN)
    return text.replace("exponential, mean: 60 s", "lognormal, mean: 60 s, cv: 0.3, between_share: 0.4")


def memory() -> dict:
    """MB of the arena after a run of 8 h, of its frozen copy, of the log, and by which the process has grown."""
    from bench import test_plant
    from plans import plan

    from opsim.engine.fast_engine import ready, run_plan
    from opsim.engine.fast_engine.run import machine_of

    test_plant.N_STATIONS = test_plant.N_WORKERS = 100
    of_plant = {blocks: plan(_with_skills(test_plant.plant(blocks=blocks))) for blocks in (False, True)}
    plans = {"line": plan(line_text(100)), "plant": of_plant[False], "plant with blocks": of_plant[True]}
    found = {}
    for name, made in plans.items():
        ready(made)
        run_plan(plan(line_text(2, "1 h")))  # what is read and loaded once is not this floor's
        before = _resident_mb()
        log = run_plan(made, 0)
        rows, log_mb = len(log), sum(column.nbytes for column in log.columns.values()) / 2**20
        del log
        arena = machine_of(made).build.arena
        frozen = sum(copy.nbytes for _, copy in arena._frozen[0])
        found[name] = {
            "rows": rows,
            "arena_mb": arena.n_bytes / 2**20,
            "frozen_mb": frozen / 2**20,
            "log_mb": log_mb,
            "grown_mb": _resident_mb() - before,
        }
    return found


def _with_skills(text: str) -> str:
    """Each worker for four stations far apart."""
    for w in range(100):
        skills = ", ".join(f"s{(w + 27 * k) % 100}: 1.0" for k in range(4))
        text = re.sub(rf"^  w{w}: .*$", f"  w{w}: {{skills: {{{skills}}}}}", text, flags=re.MULTILINE)
    return text


def _resident_mb() -> float:
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / 2**20


def replications(engine: str, n: str, first: str = "1") -> dict:
    """By an engine, in processes. Nothing is kept of a log but the number of jobs."""
    from opsim.pool import pooled
    from opsim.threads import can_fork

    prepare = partial(_prepared, engine, line_text())
    prepare()(0)  # compiled, loaded, and its luck known, as a study's first replication does
    started, cpu_s, can = perf_counter(), _cpu_s(), can_fork()
    finished = dict(pooled(prepare, range(int(first), int(first) + int(n)), 2))
    clock_s = perf_counter() - started
    assert len(finished) == int(n)
    jobs = [finished[number] for number in sorted(finished)]
    return {"clock_s": clock_s, "cpu_s": _cpu_s() - cpu_s, "jobs": jobs, "forked": can}


def _prepared(engine: str, text: str):
    """Called in each process once; processes that are forked have all of it."""
    from numpy import count_nonzero

    from opsim.log import FINISH

    if engine == "fast":
        from opsim.engine.fast_engine import run_plan
    else:
        from opsim.engine.floor.run import run_plan
    made = _plan(text)
    return lambda number: (number, int(count_nonzero(run_plan(made, number)["kind"] == FINISH)))


@cache
def _plan(text: str):
    from plans import plan

    return plan(text)


def _cpu_s() -> float:
    """Of this process, all its threads, and of processes that have ended."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


def in_a_process(*words, cache: Path | None = None) -> dict:
    """What a function here finds in a process of its own, and ``whole_s``, its clock seconds with the interpreter's."""
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"} | ({"NUMBA_CACHE_DIR": str(cache)} if cache else {})
    tests = str(Path(__file__).parents[1])
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, [tests, os.environ.get("PYTHONPATH", "")]))
    started = perf_counter()
    command = [sys.executable, "-m", "bench.fast_runs", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout) | ({"whole_s": perf_counter() - started} if words[0] == "first_row" else {})


if __name__ == "__main__":
    function, *arguments = sys.argv[1:]
    if function == "first_row" and arguments == ["line"]:
        arguments = ["line.yaml", line_text()]
    print(json.dumps({"first_row": first_row, "memory": memory, "replications": replications}[function](*arguments)))
