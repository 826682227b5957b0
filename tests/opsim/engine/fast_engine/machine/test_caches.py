"""Caches of whole runs: none to write to, two processes at once on a cold one, and nothing compiled twice."""

import json
import os
import subprocess
import sys
from hashlib import blake2b
from pathlib import Path

import pytest
from plans import plan

from opsim.engine.fast_engine import ready, run_plan
from opsim.engine.fast_engine.machine import table
from opsim.engine.floor.run import run_plan as simpy_run
from opsim.log import COLUMNS

FLOOR = """
opsim: 1
name: counter
run: {horizon: 2 h, seed: 1}
layout: {places: {counter: [0 m, 0 m]}}
tasks: {serve: {dist: exponential, mean: 90 s}}
stations: {counter: {at: counter, tasks: [serve]}}
products: {customer: {route: [counter]}}
release: {kind: poisson, every: 2 min}
workers: {clerk: {skills: {counter: 1.0}}}
"""
TESTS = Path(__file__).parents[4]
PROGRAM = """
import json
from opsim.checkup import findings
from opsim.engine.fast_engine import ready, run_plan
from tests_of_caches import FLOOR, digest
from plans import plan
made, told = plan(FLOOR), []
ready(made, lambda *so_far: told.append(so_far))
kept = next(one.said for one in findings() if one.what == "compiled code")
print(json.dumps({"digest": digest(run_plan(made)), "compiled": len(told), "kept": kept}))
"""
NO_PLACE = {
    "NUMBA_CACHE_DIR": os.devnull + "/nothing",
    "NUMBA_CACHE_LOCATOR_CLASSES": "UserProvidedCacheLocator",
}


def digest(log):
    return blake2b(b"".join(log[name].tobytes() for name in COLUMNS)).hexdigest()


def begun(**environment):
    """A process that runs the floor by the fast engine."""
    folders = os.pathsep.join((str(Path(__file__).parent), str(TESTS), str(TESTS.parent)))
    program = PROGRAM.replace("tests_of_caches", Path(__file__).stem)
    return subprocess.Popen(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": folders, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def said(process):
    out, wrong = process.communicate()
    assert process.returncode == 0, wrong
    return json.loads(out)


@pytest.mark.slow
def test_with_no_place_to_keep_machine_code_it_runs_and_says_so():
    found = said(begun(**NO_PLACE))
    assert found["digest"] == digest(simpy_run(plan(FLOOR)))
    assert found["compiled"] > 1


@pytest.mark.slow
def test_two_processes_at_once_on_a_cold_cache_are_both_right_and_leave_it_whole(tmp_path):
    right = digest(simpy_run(plan(FLOOR)))
    both = [begun(NUMBA_CACHE_DIR=str(tmp_path)) for _ in range(2)]
    assert [said(one)["digest"] for one in both] == [right, right]
    later = said(begun(NUMBA_CACHE_DIR=str(tmp_path)))
    assert later["digest"] == right
    assert later["compiled"] == 0
    assert not list(tmp_path.rglob("*.steps.*"))


def test_nothing_is_compiled_between_replications_nor_inside_a_sweep(monkeypatch):
    ready(plan(FLOOR))
    monkeypatch.setattr(table, "compiled", lambda *_: pytest.fail("compiled again"))
    monkeypatch.setattr(table, "_link", lambda codes: codes == [] or pytest.fail("read again"))
    for mean in ("90 s", "80 s", "70 s"):
        made = plan(FLOOR.replace("90 s", mean))
        for replication in range(3):
            assert digest(run_plan(made, replication)) == digest(simpy_run(made, replication))
