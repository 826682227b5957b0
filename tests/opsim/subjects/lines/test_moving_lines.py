"""Moving lines: against plain recursions (``naive.line``), and by hand: 6 m stretches at 0.1 m/s are passed in 60 s."""

import numpy as np
import pytest
from made.moving_line import moving_line
from naive.line import Line, grid
from plans import plan, ran

from opsim.engine.draws import Draws
from opsim.engine.floor.run import run_plan
from opsim.kpi.table import figures
from opsim.laws.audit import audit
from opsim.log import FINISH, QUEUE, SENT_ON, STANDS, WALK, WORK

N = 40


@pytest.mark.parametrize("unfinished", ["send_on", "stop"])
@pytest.mark.parametrize(("upstream", "drift"), [(0, 0), (1.5, 0), (0, 2), (2, 1.5), (7, 8)])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_every_begin_and_end_is_that_of_the_recursion(seed, upstream, drift, unfinished):
    p = plan(moving_line(upstream, drift, unfinished, seed))
    log = run_plan(p)
    audit(log, p)
    ranks = [1, 2, 3]  # natural order: gap, s1, s2, s3
    luck = [Draws(p, 0).durations(task, worker) for worker, task in enumerate(range(3))]
    times = [[grid(next(luck[i]) / p.workers[i].rating[ranks[i]]) for _ in range(N)] for i in range(3)]
    line = Line([0.0, 6.0, 17.5], [6.0, 15.0, 23.5], 0.1, 60.0, 1.1, upstream, drift, unfinished == "send_on")
    worked = line.work(times)
    compared = 0
    for i, rank in enumerate(ranks):
        rows = log.where((log["kind"] == WORK) & (log["station"] == rank))
        seen = {j: (b, e) for j, b, e in zip(rows["job"].tolist(), rows["start_s"].tolist(), rows["end_s"].tolist())}
        for j, one in enumerate(worked[i]):
            if one.end_s < 2400 and one.begin_s < one.end_s:
                assert seen[j] == pytest.approx((one.begin_s, one.end_s), abs=1e-9), (rank, j)
                compared += 1
            elif one.end_s < 2400:
                assert j not in seen
    assert compared > 80
    if unfinished == "send_on":
        cut = {(ranks[i], j) for i in range(3) for j in range(N) if worked[i][j].cut and worked[i][j].end_s < 2400}
        sent = log.of(SENT_ON)
        assert set(zip(sent["station"].tolist(), sent["job"].tolist())) == cut
    else:
        stood = log.of(STANDS)
        rows = list(zip(stood["start_s"].tolist(), stood["end_s"].tolist()))
        assert rows == [(a, min(b, 2400.0)) for a, b in line.stops if a < 2400]


HAND = """
opsim: 1
name: by hand
run: {horizon: 600 s, seed: 1}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 25 s}, u: {fixed: 10 s}}
stations: {s: {at: a, tasks: [t]}, e: {at: a, tasks: [u]}}
lines: {l: {kind: moving, stations: [s, e], takt: 60 s, length: 6 m, unfinished: send_on}}
products: {large: {route: [s, e], lot: 3}, small: {route: [s, e], lot: 1}}
release: {kind: saturated, sequence: [large, small]}
workers: {w: {walk: 0.9 m/s, skills: {s: 1.0}}, x: {skills: {e: 1.0}}}
"""


def works(log, station, job):
    rows = log.where((log["kind"] == WORK) & (log["station"] == station) & (log["job"] == job))
    return rows["start_s"].min(), rows["end_s"].max()


def test_a_worker_drifts_with_a_long_job_and_comes_back_with_a_short_one():
    """Wester & Kilbridge 1964: the displacement of a station grows with long jobs, and short ones take it back."""
    log, p = ran(HAND, ("unfinished: send_on", "unfinished: send_on, drift: 1.5 m"))
    s = p.lines[0].stations[0]
    assert works(log, s, 0) == (0.0, 75.0)  # he is at 7.5 m then, the small one at 1.5 m: 6 m / (0.9 + 0.1) m/s
    assert works(log, s, 1) == (81.0, 106.0)  # at 4.6 m; back at 0 m in 5.1 s, long before the next
    assert works(log, s, 2) == (120.0, 195.0)
    assert not len(log.of(SENT_ON))
    walks = log.where((log["kind"] == WALK) & (log["worker"] == 0))
    assert walks["start_s"][:2].tolist() == [75.0, 106.0]
    assert walks["end_s"][:2] == pytest.approx([81.0, 106 + 4.6 / 0.9], abs=1e-6)


def test_without_drift_the_long_job_leaves_the_stretch_unfinished_and_is_bad():
    log, p = ran(HAND)
    s = p.lines[0].stations[0]
    assert works(log, s, 0) == (0.0, 60.0)
    sent = log.of(SENT_ON)
    assert sent["job"][:3].tolist() == [0, 2, 4]
    assert sent["end_s"][:2].tolist() == [60.0, 180.0]
    found = {(f.kpi, f.subject, f.part): f.value for f in figures(log, p)}
    left = log.where(log["kind"] == FINISH)["job"]
    assert found["incomplete_share", "l", "s"] == pytest.approx(np.mean(left % 2 == 0))
    assert found["incomplete_share", "l", ""] == pytest.approx(np.mean(left % 2 == 0))  # e: 30 s of 60 s
    assert found["line_stopped_share", "l", ""] == 0.0


def test_upstream_of_his_stretch_a_worker_begins_as_soon_as_the_station_before_is_done():
    log, p = ran(
        HAND, ("unfinished: send_on", "unfinished: send_on, upstream: 4 m, drift: 2 m"), ("[large, small]", "[small]")
    )
    _, e = p.lines[0].stations
    # done at 2.5 m after 25 s; in reach of e at 2 m; its worker comes from 6 m: 3.5 m / (1.2 + 0.1) m/s
    assert works(log, e, 0)[0] == pytest.approx(25 + 3.5 / 1.3, abs=1e-6)


def test_a_job_rides_on_to_the_end_of_the_line():
    log, _ = ran(HAND, ("[large, small]", "[small]"))
    assert log.of(FINISH)["end_s"][:3].tolist() == [120.0, 180.0, 240.0]
    assert set(log.where((log["kind"] == QUEUE) & (log["end_s"] < 600))["cause"].tolist()) == {25}  # takt


def test_where_no_job_waits_an_empty_place_moves_on():
    log, _ = ran(
        HAND, ("kind: saturated, sequence: [large, small]", "kind: renewal, every: {fixed: 130 s}, products: [small]")
    )
    # they come at 130, 260, 390, 520 s and onto the line at the next takt, and leave it 120 s later
    assert log.of(FINISH)["end_s"].tolist() == [300.0, 420.0, 540.0]


FULL = (
    ("stations: {s", "stations: {z: {at: a, tasks: [v], buffer: 0}, s"),
    ("tasks: {t", "tasks: {v: {fixed: 100 s, automatic: true}, t"),
    ("route: [s, e], lot: 1", "route: [s, e, z], lot: 1"),
    ("[large, small]", "[small]"),
)


def test_a_job_that_cannot_leave_the_line_stops_it_and_work_goes_on():
    log, p = ran(HAND, *FULL)
    z = [station.name for station in p.stations].index("z")
    stood = log.of(STANDS)
    # the first is at the end at 120 s and takes 100 s; the second at 180 s: the line stands until 220 s, and so on
    assert list(zip(stood["start_s"].tolist(), stood["end_s"].tolist()))[:2] == [(180.0, 220.0), (280.0, 320.0)]
    assert works(log, z, 1) == (220.0, 320.0)
    assert log["cause"][np.flatnonzero(log["kind"] == STANDS)[0]] == 5  # full
    assert works(log, p.lines[0].stations[0], 3)[0] == 220.0  # the fourth comes on when the line moves again
