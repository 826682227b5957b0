"""How far people walk."""

import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.log import WALK
from tests.opsim.kpi.made_logs import found, made, row

FAR = """
opsim: 1
name: a long walk
run: {horizon: 500 s}
layout: {places: {a: [0 m, 0 m], b: [1000 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {s: {at: b, tasks: [t], buffer: 0}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {w: {skills: {s: 1.0}, home: a, walk: 1 m/s}, z: {skills: {s: 1.0}, home: a, walk: 0.7 m/s}}
"""


def walked_m(log, p):
    return [found(log, p)["walked_m", worker.name, ""] for worker in p.workers]


def test_a_walk_cut_by_the_horizon_counts_as_far_as_it_went():
    p = plan(FAR)
    assert walked_m(run_plan(p), p) == [500, 0]


def test_a_walk_across_the_end_of_the_warm_up_counts_from_there():
    p = plan(FAR.replace("500 s", "2000 s, warm_up: 400 s"))
    assert walked_m(run_plan(p), p) == [600, 0]


def test_a_whole_walk_is_the_whole_way_although_time_has_a_grid():
    p = plan(FAR.replace("500 s", "2000 s").replace("w: {skills: {s: 1.0}, ", "w: {skills: {}, "))
    assert walked_m(run_plan(p), p) == [0, 1000]


def test_a_way_of_no_length_is_none():
    p = plan(FAR)
    assert walked_m(made([row(WALK, 0, 5, worker=0, places=(0, 0))], p), p) == pytest.approx([0, 0])
