"""The shipped ``walking_cell.yaml``: what it shows of walking."""

import functools

import numpy as np
import pytest

from opsim.engine.floor.run import run_plan
from opsim.ergonomics.walking import walk_again
from opsim.history import walks_of
from opsim.kpi import figures
from opsim.kpi.catalogue import WALKING
from opsim.log import WALK
from opsim.plan import compile_plan
from opsim.report.sections.walking import FootWalk as Walk
from opsim.results import Result
from opsim.scenario import read_scenarios
from opsim.study import run_scenario

N = 2


@functools.cache
def ran(variant):
    """Plan, logs and figures of the first replications."""
    plan = compile_plan(read_scenarios("walking_cell", [variant])[variant])
    logs = [run_plan(plan, replication) for replication in range(N)]
    return plan, logs, [{f[:3]: f.value for f in figures(log, plan, WALKING)} for log in logs]


@pytest.mark.slow
def test_walking_minutes_are_the_time_of_walking_rows_and_shelves_nearer_save_a_third():
    minutes = {}
    for variant in ("base", "near"):
        plan, logs, found = ran(variant)
        rows = [log.of(WALK).clipped_s(*plan.window_s).sum() for log in logs]
        hours = len(plan.workers) * (plan.horizon_s - plan.warm_up_s) / 3600
        minutes[variant] = np.mean([one["walking_min_per_h", "", ""] for one in found])
        assert minutes[variant] == pytest.approx(np.mean(rows) / 60 / hours, rel=1e-9)
        assert all(one["walking_measured_share", "", ""] == 1 for one in found)
    assert 0.55 < minutes["near"] / minutes["base"] < 0.8


@pytest.mark.slow
def test_steps_follow_the_worker():
    """jon is taller and faster by half: constant walk ratio says 1.5 ** 0.5 * (1.92 / 1.58) ** 0.75 = 1.42 times."""
    _, _, found = ran("base")
    for one in found:
        ratio = one["step_length_m", "jon", ""] / one["step_length_m", "ida", ""]
        assert 1.2 < ratio < 1.6 and one["cadence_per_min", "jon", ""] > one["cadence_per_min", "ida", ""]
        assert 0 < one["trunk_flexion_mean_deg", "", "walking"] < 15


@pytest.mark.slow
def test_feet_of_walks_of_a_run_do_not_slide_and_walks_are_as_long_as_the_way():
    plan, logs, _ = ran("base")
    walks = walks_of(logs[0], plan)
    for row in range(0, walks.k.size, walks.k.size // 12):
        rank, metres, seconds = int(walks.worker[row]), float(walks.distance_m[row]), float(walks.whole_s[row])
        drawn = walk_again(plan, 0, rank, int(walks.k[row]), metres)
        n_times = round(60 * seconds) + 1
        joints_m, contact = (drawn.decoded(what, n_times=n_times) for what in ("positions_m", "contact"))
        shown = Walk("somebody", "there", metres, seconds, joints_m, contact, drawn.block.skeleton)
        assert shown.slide_mm < 3
        assert shown.along_m[-1, list(shown.skeleton.parents).index(-1), 0] == pytest.approx(metres, abs=0.03)


@pytest.mark.slow
def test_one_and_two_processes_measure_the_same_walks(tmp_path):
    loaded = read_scenarios("walking_cell", ["base"], {"run.horizon": "30 min"})["base"]
    here, there = (run_scenario(loaded, folder=tmp_path / str(n), processes=n, replications=3).folder for n in (1, 2))
    one, two = (Result.load(folder).kpis() for folder in (here, there))
    assert np.array_equal(
        [list(row.values()) for row in one.values()], [list(r.values()) for r in two.values()], equal_nan=True
    )
