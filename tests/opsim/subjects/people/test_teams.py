"""Teams and attended runs by hand arithmetic: who comes, who waits, and whose time counts."""

import plans
import pytest

from opsim.kpi import figures
from opsim.log import HELD, NO_WORKER, TEAM, WAIT, WALK, WORK

CELL = """
opsim: 1
name: teams
run: {horizon: 60 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tasks: {lift: {fixed: 10 s, team: 2}, pack: {fixed: 4 s}}
stations:
  s1: {at: a, tasks: [lift], buffer: 1}
  s2: {at: b, tasks: [pack], buffer: 1}
products: {part: {route: [s1]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s1: 0.5}}}
"""


def ran(*edits):
    return plans.ran(CELL, *edits)


def spans(log, kind, worker=-1, cause=None):
    keep = (log["kind"] == kind) & (log["worker"] == worker)
    if cause is not None:
        keep &= log["cause"] == cause
    return sorted(zip(log["start_s"][keep].tolist(), log["end_s"][keep].tolist()))


def test_a_team_takes_as_long_as_its_slowest_and_the_others_wait_for_him():
    log, _ = ran()
    assert spans(log, WORK)[:2] == [(0, 20), (20, 40)]
    assert spans(log, WORK, 0)[:2] == [(0, 10), (20, 30)]
    assert spans(log, WORK, 1)[:2] == [(0, 20), (20, 40)]
    assert spans(log, WAIT, 0, TEAM)[:2] == [(10, 20), (30, 40)]


def test_members_have_rows_of_their_own_with_their_own_performances():
    log, _ = ran()
    members = log.where((log["kind"] == WORK) & (log["worker"] >= 0))
    job = log.where((log["kind"] == WORK) & (log["worker"] < 0))
    assert set(members["job"]) == {-1} and set(job["job"]) == {0, 1, 2}
    assert members["k"][members["worker"] == 0].tolist() == [0, 1, 2]
    assert len(set(members["performance_id"]) | set(job["performance_id"])) == len(members) + len(job)


def test_who_is_there_first_waits_for_who_has_to_walk():
    log, _ = ran(("w2: {skills: {s1: 0.5}}", "w2: {home: b, walk: 2 m/s, skills: {s1: 0.5}}"))
    assert spans(log, WALK, 1) == [(0, 3)]
    assert spans(log, WAIT, 0, TEAM)[0] == (0, 3)
    assert spans(log, HELD, cause=TEAM) == [(0, 3)]
    assert spans(log, WORK)[0] == (3, 23)


def test_nobody_is_sent_before_the_whole_team_is_free():
    """A box is packed by w2 from 2 to 6 s; the part of 4 s waits, and so does w1, free for anything else, until 6 s."""
    log, _ = ran(
        ("w2: {skills: {s1: 0.5}}", "w2: {home: b, walk: 6 m/s, skills: {s1: 1.0, s2: 1.0}}"),
        ("{part: {route: [s1]}}", "{part: {share: 0.5, route: [s1]}, box: {share: 0.5, route: [s2]}}"),
        ("{kind: saturated}", "{kind: renewal, every: {fixed: 2 s}, sequence: [box, part]}"),
    )
    assert spans(log, HELD, cause=NO_WORKER)[0] == (4, 6)
    assert spans(log, WAIT, 0)[:2] == [(0, 6), (6, 7)]
    assert spans(log, WAIT, 0, TEAM)[0] == spans(log, WALK, 1)[0] == (6, 7)
    assert (7, 17) in spans(log, WORK)


def test_a_team_stays_together_for_the_repeats_of_its_task():
    log, _ = ran(("team: 2", "team: 2, repeat: 3"), ("w2: {", "w3: {skills: {s1: 1.0}}, w2: {"))
    assert spans(log, WORK)[:3] == [(0, 10), (10, 20), (20, 30)]
    first = {w for w in range(3) if spans(log, WORK, w)[:3] == [(0, 10), (10, 20), (20, 30)]}
    assert len(first) == 2


def test_two_teams_that_share_people_never_lock():
    """Both tasks take both workers: each is done in turn, since nobody waits at one for somebody at the other."""
    log, _ = ran(
        ("pack: {fixed: 4 s}", "pack: {fixed: 4 s, team: 2}"),
        ("{s1: 1.0}", "{s1: 1.0, s2: 1.0}"),
        ("{s1: 0.5}", "{s1: 1.0, s2: 1.0}"),
        ("[s1]", "[s1, s2]"),
        ("60 s", "600 s"),
    )
    assert len(spans(log, WORK)) > 30


def test_a_stop_breaks_a_team_up_and_a_team_does_the_rest():
    jam = (
        "s1: {at: a,",
        "s1: {at: a, breakdowns: {jam: {every: {fixed: 15 s}, by: busy, repair: {fixed: 5 s}, job: resume}},",
    )
    log, _ = ran(jam)
    assert spans(log, WORK)[:2] == [(0, 15), (20, 25)]
    assert spans(log, WORK, 0)[:2] == [(0, 10), (20, 22.5)]
    rest = log.where((log["kind"] == WORK) & (log["start_s"] == 20))
    assert set(rest["progress_from"]) == {0.75}


def test_states_of_workers_tell_waiting_for_the_team_apart():
    log, p = ran()
    found = {(f.kpi, f.subject, f.part): f.value for f in figures(log, p)}
    assert found["worker_states", "w1", "team"] == pytest.approx(0.5)
    assert found["worker_states", "w2", "work"] == pytest.approx(1.0)
    assert found["station_states", "s1", "work"] == pytest.approx(1.0)


def test_an_attended_run_takes_the_station_s_time_and_keeps_the_worker():
    log, _ = ran(("team: 2", "automatic: attended"), ("s1: 1.0", "s1: 3.0"))
    assert sorted(spans(log, WORK, 0) + spans(log, WORK, 1))[:3] == [(0, 10), (10, 20), (20, 30)]
    assert not spans(log, WORK)


def test_an_attended_run_of_a_team_has_one_time_for_all():
    log, _ = ran(("team: 2", "automatic: attended, team: 2"))
    assert spans(log, WORK) == spans(log, WORK, 0) == spans(log, WORK, 1)
    assert spans(log, WORK)[:2] == [(0, 10), (10, 20)]


def test_attended_and_unattended_runs_are_the_same_runs():
    times = ("fixed: 10 s", "dist: gamma, mean: 10 s, cv: 0.5")
    alone, attended = (ran(times, ("team: 2", f"automatic: {how}"))[0].of(WORK) for how in ("true", "attended"))
    assert alone.duration_s.tolist() == attended.duration_s.tolist()
    assert set(alone["worker"]) == {-1} and set(attended["worker"]) <= {0, 1}
