"""What people do whom nobody calls, ways that come back, and other people in each replication."""

import numpy as np
import pytest
from plans import CELL, line, plan

from opsim.engine.floor.run import run_plan
from opsim.kpi.deadlock import locked
from opsim.laws.audit import CHECKS, audit
from opsim.log import BLOCKED, FINISH, WAIT, WALK, WORK

ROUND = """
opsim: 1
name: round
run: {horizon: 100 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m], c: [3 m, 4 m]}}
tasks: {t: {fixed: 2 s}, rare: {fixed: 50 s, automatic: true}}
stations: {sa: {at: a, tasks: [t]}, sb: {at: b, tasks: [t]}, sc: {at: c, tasks: [t]}}
products: {x: {route: [sa, sb, sc]}}
release: {kind: renewal, every: {fixed: 40 s}}
workers: {w: {walk: 1 m/s, home: a, patrol: [sa, sb, sc], skills: {sa: 1.0, sb: 1.0, sc: 1.0}}}
allocation: {idle: patrol}
"""


def walks(log):
    rows = log.of(WALK)
    return [(int(f), int(t), float(s), float(e)) for f, t, s, e in zip(*(rows[c] for c in WAY))]


WAY = ("place_from", "place_to", "start_s", "end_s")


def test_a_worker_on_patrol_walks_round_and_serves_only_where_he_stands():
    p = plan(ROUND)
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    # a -> b 3 s, b -> c 4 s, c -> a 7 s: at 0 he is at a; the job of 40 s finds him on the way, at a again at 42 s
    assert walks(log)[:5] == [(0, 1, 0, 3), (1, 2, 3, 7), (2, 0, 7, 14), (0, 1, 14, 17), (1, 2, 17, 21)]
    work = log.of(WORK)
    assert work["start_s"][:3].tolist() == [42.0, 47.0, 53.0]
    assert log.of(WAIT)["start_s"].size == 0


def test_a_patrol_without_a_way_waits_for_a_call():
    p = plan(ROUND.replace("b: [3 m, 0 m], c: [3 m, 4 m]", "b: [0 m, 0 m], c: [0 m, 0 m]"))
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    assert len(log.of(WALK)) == 0
    assert log.of(FINISH)["end_s"].tolist() == [46.0, 86.0]


def test_who_goes_home_walks_back_when_nobody_calls():
    p = plan(ROUND.replace("idle: patrol", "idle: home"))
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    assert walks(log)[:3] == [(0, 1, 42, 45), (1, 2, 47, 51), (2, 0, 53, 60)]


@pytest.mark.parametrize("buffer", [0, 2])
def test_a_job_that_comes_back_to_its_own_station_needs_no_other_place(buffer):
    text = line(1, 0, horizon="1000 s", warm_up="0 s").replace("route: [s1]", "route: [s1, s1]")
    p = plan(text.replace("buffer: 1", f"buffer: {buffer}"))
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    assert len(log.of(FINISH)) > 300
    assert len(log.of(BLOCKED)) == 0
    assert locked(log, p) is None


def test_a_loop_of_full_stations_locks_and_is_found():
    text = line(2, 0, horizon="1000 s", warm_up="0 s").replace("route: [s1, s2]", "route: [s1, s2, s1]")
    p = plan(text)
    found = locked(run_plan(p), p)
    assert found is not None
    assert set(found.stations) == {"s1", "s2"}


def test_the_way_drawn_belongs_to_the_job_not_to_the_order_of_events():
    routing = "routing: {start: s1, s1: {s2: 0.7, out: 0.3}, s2: {s1: 0.2, out: 0.8}}"
    text = line(2, 0, horizon="2000 s", warm_up="0 s").replace("route: [s1, s2]", routing).replace("buffer: 0", "")
    text = text.replace("kind: saturated", "kind: poisson, every: 3 s").replace(", buffer: 1", "").replace(", }", "}")
    ways = []
    for speed in ("1 s", "0.5 s"):
        log = run_plan(plan(text.replace("mean: 1 s", f"mean: {speed}", 1)))
        work = log.of(WORK)
        done = set(log.of(FINISH)["job"].tolist())
        ways.append({j: work["station"][work["job"] == j].tolist() for j in done})
    common = ways[0].keys() & ways[1].keys()
    assert len(common) > 500
    assert all(ways[0][j] == ways[1][j] for j in common)
    assert len({tuple(way) for way in ways[0].values()}) > 3


def test_redrawn_people_differ_between_replications_and_fixed_ones_do_not():
    text = CELL.replace("seed: 5", "seed: 5, staffing: redrawn").replace("cv: 0.3, between_share: 0.4", SHARE)
    means = {name: [_lift_mean_s(t, r) for r in range(3)] for name, t in (("redrawn", text), ("fixed", _fixed(text)))}
    assert np.ptp(means["fixed"]) < 1e-9
    assert np.ptp(means["redrawn"]) > 0.5


SHARE = "cv: 0.3, between_share: 1"


def _fixed(text):
    return text.replace("redrawn", "fixed")


def _lift_mean_s(text, replication):
    p = plan(text)
    work = run_plan(p, replication).of(WORK)
    ana = (work["worker"] == 0) & (work["task"] == [task.name for task in p.tasks].index("lift"))
    whole = ana & (work["progress_to"] == 1)
    return float(work.duration_s[whole][0])
