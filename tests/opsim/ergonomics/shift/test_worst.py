from dataclasses import replace

import numpy as np
import pytest
from plans import ran

from opsim.ergonomics.angles import AT
from opsim.ergonomics.measures import measures_of_positions
from opsim.ergonomics.shift.day import days, fold, scored
from opsim.ergonomics.shift.worst import WorstSeen, clock_of, worst_frames
from opsim.plan.tasks import Handling
from tests.opsim.ergonomics.made_work import BEND, COUNT, Bending, Bends, made_plan
from tests.opsim.kpi.made_logs import made, work

CELL = """
opsim: 1
name: cell
run: {start: Mon 06:30, horizon: 12 min, warm_up: 1 min, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
tasks: {stoop: {emulator: bench/stoop, load: 12 kg}, place: {emulator: bench/place}, label: {fixed: 4 s}}
stations: {low: {at: here, tasks: [stoop, place, label], servers: 2, buffer: 2}}
products: {p: {route: [low]}}
release: {kind: saturated}
workers: {ana: {skills: {low: 1.0}}, ben: {skills: {low: 0.8}}}
"""


@pytest.fixture(scope="module")
def cell():
    log, plan = ran(CELL)
    return log, plan, worst_frames(log, plan, 10)


def test_who_bends_deepest_in_the_middle_is_worst_there():
    plan = made_plan(Bending((30.0, 80.0, 50.0) + (0.0,) * 61, kind=Bends), start_s=6 * 3600.0)
    plan = replace(plan, tasks=(replace(plan.tasks[BEND], handling=Handling(load_kg=12.0)), *plan.tasks[1:]))
    rows = [work(100 * k, 100 * k + 9, 0, worker=0, k=k, task=BEND) for k in range(3)]
    (found,) = worst_frames(made([*rows, work(400, 405, 0, worker=1, k=0, task=COUNT)], plan), plan, 5)
    assert (found.worker, found.task, found.station, found.product, found.k) == ("ana", "bend", "s1", "p", 1)
    assert found.progress == pytest.approx(0.5, abs=0.01) and found.clock == "Mon 06:01:44"
    assert found.measures[AT["trunk_flexion"]] == pytest.approx(80, abs=1) and found.load_kg == 12
    head = found.joints_m[found.skeleton.names.index("head")] - found.joints_m[0]
    assert np.rad2deg(np.arctan2(head[0], head[2])) == pytest.approx(80, abs=1)


def test_nobody_has_two_of_one_task_and_the_worst_come_first(cell):
    *_, found = cell
    assert {(one.worker, one.task) for one in found} == {(w, t) for w in ("ana", "ben") for t in ("stoop", "place")}
    assert len(found) == 4 and [one.rula for one in found] == sorted((one.rula for one in found), reverse=True)
    (first,) = worst_frames(*cell[:2], 1)
    assert (first.worker, first.task, first.at_s) == (found[0].worker, found[0].task, found[0].at_s)


def test_a_list_of_them_reads_in_a_line_each_without_arrays(cell):
    first = cell[2][0]
    assert repr(first).startswith(f"<Worst: {first.worker} at {first.task}, {first.clock}: RULA {first.rula[0]}")
    assert "REBA" in repr(first) and len(repr(first)) < 100 and str(first) == repr(first)


def test_of_each_task_there_may_be_the_worst_alone(cell):
    log, plan, found = cell
    seen = WorstSeen()
    fold(log, plan, [seen])
    alone = [(one.worker, one.task) for one in seen.worst(log, plan, 10, one_a_task=True)]
    first = {one.task: (one.worker, one.task) for one in reversed(found)}
    assert len(alone) == 2 and set(alone) == set(first.values())


def test_no_frame_of_the_worker_at_the_task_is_worse_and_its_time_is_counted(cell):
    log, plan, found = cell
    for one in found:
        rank, task = [w.name for w in plan.workers].index(one.worker), [t.name for t in plan.tasks].index(one.task)
        least, spent_s = 0, 0.0
        for frames in days(log, plan):
            if frames.worker == rank:
                rula = np.where(frames.task == task, scored(frames, plan).rula[:, 0], 0)
                least, spent_s = max(least, int(rula.max())), spent_s + frames.seconds[rula >= one.rula[0]].sum()
        assert least == one.rula[0] and one.seconds == pytest.approx(spent_s)


def test_the_joints_are_those_that_were_measured_and_the_reasons_those_of_the_score(cell):
    _, plan, found = cell
    for one in found:
        again = measures_of_positions(one.joints_m, one.skeleton.names, plan.ergonomics)
        same = [AT[name] for name in ("trunk_flexion", "left_arm_elevation", "right_elbow", "left_hand_up_m")]
        assert np.allclose(again[same], one.measures[same], atol=1e-3)
        assert tuple(one.why["rula"]["score"]) == one.rula and tuple(one.why["reba"]["score"]) == one.reba


def test_clocks_of_long_runs_go_on_to_the_next_day(cell):
    assert clock_of(cell[1], 0) == "Mon 06:30" and clock_of(cell[1], 20 * 3600 + 61) == "Tue 02:31:01"


def test_one_a_task_keeps_the_worst_of_each_in_their_order(cell):
    log, plan, found = cell
    seen = WorstSeen()
    fold(log, plan, [seen])
    kept = seen.worst(log, plan, 10, one_a_task=True)
    first = {one.task: one.row for one in reversed(found)}
    assert [one.row for one in kept] == [one.row for one in found if first[one.task] == one.row] and len(kept) == 2
