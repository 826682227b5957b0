"""Random crews obey all laws; nobody overtakes, nobody else works there, and the line never stands for good."""

import json
from itertools import combinations

import numpy as np
import pytest
from made_brigades import scenario
from plans import plan, ran

from opsim.engine.floor import run_plan
from opsim.log import FINISH, JOB_KINDS, WORK

FEW, MANY = range(12), range(12, 160)


def left_s(log, made):
    """{station: {job: when it left it}} of jobs that went on from there, or are done with the line."""
    found: dict[int, dict[int, float]] = {}
    rows = log.of(*JOB_KINDS)
    for i in range(len(rows)):
        station, job, product = (int(rows[name][i]) for name in ("station", "job", "product"))
        out = made.products[product].route[-1].stations == (station,) and station != made.crews[0].stations[-1]
        if station >= 0 and not out:  # who goes out in the middle of the line is in nobody's way
            found.setdefault(station, {})[job] = float(rows["end_s"][i])
    return {station: {job: s for job, s in jobs.items() if s < log.horizon_s} for station, jobs in found.items()}


def check(seed):
    log, made = ran(scenario(seed))
    (crew,) = made.crews
    work = log.of(WORK)
    manned = work["worker"][work["worker"] >= 0]
    assert set(manned.tolist()) <= set(crew.workers)
    left = left_s(log, made)
    for before, after in combinations(crew.stations, 2):
        both = sorted(set(left.get(before, ())) & set(left.get(after, ())))
        first = np.array([left[before][job] for job in both])
        then = np.array([left[after][job] for job in both])
        order = np.lexsort([then, first])
        apart = np.diff(first[order]) > 0
        assert np.all(np.diff(then[order])[apart] >= 0), f"seed {seed}: overtaken after station {after}"
    if "saturated" in scenario(seed) and '"scrap"' not in scenario(seed):
        assert log["end_s"][log["kind"] == FINISH].max(initial=0) > 0.8 * log.horizon_s, f"seed {seed} stands still"


@pytest.mark.parametrize("seed", FEW)
def test_a_random_crew_obeys_all_laws(seed):
    check(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [MANY[start::4] for start in range(4)])
def test_many_random_crews_obey_all_laws(seeds):
    for seed in seeds:
        check(seed)


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_declaration_decides_nothing(seed):
    made = json.loads(scenario(seed))
    turned = {key: dict(reversed(block.items())) if isinstance(block, dict) else block for key, block in made.items()}
    logs = [run_plan(plan(json.dumps(one))) for one in (made, turned)]
    for name in ("kind", "start_s", "end_s", "worker", "station", "job", "task"):
        assert np.array_equal(logs[0][name], logs[1][name])
