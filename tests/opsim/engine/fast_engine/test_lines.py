"""Moving lines in the compiled engine: people walk with their jobs and back, and the line stands and runs.

Indexed lines in the compiled engine: late jobs, calls, and whatever makes the line stand.

Job rotation on both engines: by the clock, by count, by rule, with people who come and go.

Work that two neighbours share, as SimPy's engine leaves it from one to the other.

Teams: called, gathered, at work and broken up as in SimPy's engine.
"""

import pytest
from made.moving_line import moving_line
from twins import twins

from opsim.log import AWAY, BREAK, FINISH, FULL, IS_DOWN, REWORK, SENT_ON, STANDS, TEAM, UNFINISHED, WAIT, WALK, WORK

UNEVEN = (
    ("w1: {walk: 1.1 m/s, skills: {s1: 1.0}}", "w1: {walk: 1.1 m/s, skills: {s1: 1.0, s2: 0.8}}"),
    ("w2: {walk: 1.1 m/s", "w2: {walk: 0.4 m/s"),
)
"""Two can do the work of the second station, and one of them is slow on his feet."""
SECOND = "{kind: moving, stations: [gap, s3], takt: 60 s, length: 6 m, unfinished: send_on}"


@pytest.mark.parametrize("unfinished", ["send_on", "stop"])
@pytest.mark.parametrize(("upstream", "drift"), [(0, 0), (2, 1.5), (7, 8)])
def test_walks_meetings_and_limits_are_the_same_to_the_bit(upstream, drift, unfinished):
    log = twins(moving_line(upstream, drift, unfinished), *UNEVEN)
    assert log.of(WALK)["worker"].size > 20
    if not drift:
        assert (UNFINISHED in log.of(STANDS)["cause"]) == (unfinished == "stop")
        assert (log.of(SENT_ON)["job"].size > 0) == (unfinished == "send_on")


def test_two_lines_one_after_the_other_keep_their_own_time_alike():
    """The limit of the last station is beyond the end of its line: its alarm comes when the job is on the next one."""
    log = twins(
        moving_line(1, 20, "send_on"),
        *UNEVEN,
        ("[s1, s2, gap, s3], takt", "[s1, s2], takt"),
        (", lengths: {s2: 9 m, gap: 2.5 m}", ""),
        ("products:", f"  more: {SECOND}\nproducts:"),
    )
    assert log.of(SENT_ON)["job"].size > 0


def test_a_job_that_cannot_leave_the_line_stops_it_alike():
    log = twins(
        moving_line(1, 1, "send_on"),
        *UNEVEN,
        ("stations: {s1", "stations: {after: {at: d, tasks: [t4], buffer: 1}, s1"),
        ("tasks:\n", "tasks:\n  t4: {fixed: 80 s, automatic: true}\n"),
        ("[s1, s2, gap, s3]}}", "[s1, s2, gap, s3, after]}}"),
    )
    assert FULL in log.of(STANDS)["cause"]


LINE = """
opsim: 1
name: indexed
run: {start: Mon 06:00, horizon: 3000 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m]}}
tasks: {t1: {fixed: 30 s}, t2: {dist: lognormal, mean: 50 s, cv: 0.3}, t3: {fixed: 20 s, repeat: 2}}
stations: {s1: {at: a, tasks: [t1]}, s2: {at: b, tasks: [t2]}, s3: {at: a, tasks: [t3]}}
lines: {final: {kind: indexed, stations: [s1, s2, s3], takt: 60 s}}
products: {x: {route: [s1, s2, s3]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}, w3: {skills: {s3: 1.0}}}
"""
ON = ("takt: 60 s", "takt: 60 s, unfinished: send_on")


def causes(log):
    """Why the line stood."""
    return set(log.of(STANDS)["cause"].tolist())


def test_a_line_waits_for_the_last_one_alike():
    assert causes(twins(LINE)) == {UNFINISHED}


def test_jobs_are_sent_on_alike():
    log = twins(LINE, ON)
    assert log.of(SENT_ON)["job"].size > 3
    assert causes(log) == set()


def test_a_station_that_is_down_and_a_full_one_behind_stop_the_line_alike():
    jam = "breakdowns: {jam: {every: {fixed: 400 s}, repair: {fixed: 70 s}}}"
    log = twins(
        LINE,
        ON,
        ("s2: {at: b, tasks: [t2]}", f"s2: {{at: b, tasks: [t2], {jam}}}, after: {{at: b, tasks: [t4], buffer: 0}}"),
        ("t1: {", "t4: {fixed: 75 s, automatic: true}, t1: {"),
        ("{route: [s1, s2, s3]}", "{route: [s1, s2, s3, after]}"),
    )
    assert causes(log) >= {IS_DOWN, FULL}


def test_a_line_on_which_nobody_is_stands_alike():
    shift = "shifts: {early: {from: 06:00, to: 14:00, at_break: resume, breaks: {tea: {at: 06:20, lasts: 5 min}}}}\n"
    log = twins(
        LINE + shift, *((f"{name}: {{skills", f"{name}: {{shift: early, skills") for name in ("w1", "w2", "w3"))
    )
    assert causes(log) >= {AWAY}


@pytest.mark.parametrize("cards", ["", "cards: {conwip: {n: 2}}\n"])
def test_jobs_that_arrive_between_two_moves_come_on_alike(cards):
    log = twins(LINE + cards, ("kind: saturated", "kind: poisson, every: 80 s"), ON)
    assert log.of(FINISH)["job"].size > 15


CELL = """
opsim: 1
name: rotation
run: {start: Mon 06:00, horizon: 40 min, seed: 1}
layout: {places: {here: [0 m, 0 m], there: [6 m, 0 m]}}
tasks: {do: {dist: lognormal, mean: 9 s, cv: 0.4}, look: {fixed: 6 s}}
stations:
  a: {at: here, tasks: [do], buffer: 1}
  b: {at: there, tasks: [do, look], buffer: 1}
  c: {at: here, tasks: [look], buffer: 1}
  d: {at: there, tasks: [look], buffer: 2}
products: {p: {share: 0.6, route: [a, c]}, q: {share: 0.4, route: [b, d]}}
sources: {s: {kind: saturated, products: [p]}, t: {kind: poisson, every: 20 s, products: [q]}}
shifts:
  early: {from: 06:00, to: 06:20, overtime: {most: 5 min}, breaks: {tea: {at: 06:07, lasts: 2 min}}}
  late: {from: 06:15, to: 07:00, breaks: {tea: {at: 06:31, lasts: 90 s, place: there}}}
workers:
  u: {walk: 2 m/s, shift: early, skills: {a: 1, b: 1, c: 1, d: 1}}
  v: {walk: 1 m/s, shift: late, skills: {a: 0.8, b: 1, c: 1, d: 1}}
  w: {walk: 2 m/s, skills: {b: 1, c: 1.2, d: 1}}
  x: {like: w, absence: 0.5, shift: early}
rotations: {turn: {workers: [w, u, x, v], posts: [a, [b, c], []], every: 100 s}}
"""
CHANGES = {
    "by the clock": "every: 100 s",
    "by count": "after: 7",
    "by count, to whom it was shortest": "after: 5, rule: least_time",
    "to whom it was shortest": "every: 64 s, rule: least_time",
    "in turn": "rule: in_turn",
    "to the least exposed": "every: 100 s, rule: least_exposed",
}


@pytest.mark.parametrize("how", CHANGES)
def test_people_change_posts_as_they_do_in_the_reference(how):
    log = twins(CELL, ("every: 100 s", CHANGES[how]))
    assert len(log.of(FINISH)) > 100 and len(log.of(BREAK)) and len(log.of(WALK))


def test_two_rotations_leave_each_his_own_stations_and_posts_are_fewer_or_more_than_people():
    one, other = "workers: [w, u], posts: [a, d, []], every: 70 s", "workers: [x, v], posts: [[b, d], c], after: 3"
    two = f"{{turn: {{{one}}}, other: {{{other}}}}}"
    log = twins(CELL, ("{turn: {workers: [w, u, x, v], posts: [a, [b, c], []], every: 100 s}}", two))
    assert len(log.of(FINISH)) > 100


WORK_SHARING_LINE = """
opsim: 1
name: chain
run: {horizon: 1500 s, seed: 1}
layout: {places: {hall: [0 m, 0 m], far: [6 m, 0 m]}}
tasks:
  base: {dist: exponential, mean: 4 s}
  lid: {dist: exponential, mean: 5 s, repeat: 2}
  cap: {fixed: 2 s}
  close: {dist: exponential, mean: 6 s}
  look: {fixed: 3 s}
stations:
  front: {at: hall, tasks: [base, lid, cap], buffer: 1, servers: 2, share: {tasks: [lid, cap], with: back, when: RULE}}
  back: {at: far, tasks: [close, look], buffer: 2MORE, share: {tasks: [look], with: end, when: RULE}}
  end: {at: far, tasks: [look], buffer: 1}
products: {part: {route: [front, back, end]}, other: {route: [front, back, end], lot: 2}}
sources: {jobs: {kind: saturated, products: [part, other]}}
workers: {w1: {skills: {front: 1.0}}, w2: {skills: {back: 1.0, end: 0.8}}, w3: {skills: {front: 0.7, end: 1.0}}}
"""


@pytest.mark.parametrize("rule", ["half_full", "full"])
def test_the_same_tasks_are_left_to_the_partner(rule):
    log = twins(WORK_SHARING_LINE.replace("RULE", rule).replace("MORE", ""))
    lid = log.names["task"].index("lid")
    rows = log.of(WORK)
    assert {log.names["station"][rank] for rank in rows["station"][rows["task"] == lid]} == {"front", "back"}


def test_a_job_that_comes_back_gets_the_partners_own_work_alone():
    more = ", inspect: {finds: 0.9, false_alarms: 0.3, then: {rework: back}, most: 2}"
    log = twins(WORK_SHARING_LINE.replace("RULE", "half_full").replace("MORE", more))
    assert len(log.of(REWORK)) > 10


TEAMS_CELL = """
opsim: 1
name: teams
run: {start: Mon 06:00, horizon: 900 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
tools: {jig: {n: 1}}
tasks:
  lift: {dist: lognormal, mean: 10 s, cv: 0.3, team: 2, repeat: 2}
  press: {fixed: 8 s, automatic: attended, team: 2, needs: {jig: 1}}
  pack: {fixed: 4 s}
stations:
  s1: {at: a, tasks: [lift, pack], servers: 2, buffer: 3MORE}
  s2: {at: b, tasks: [pack, press], buffer: 3MORE}
products: {p: {share: 0.5, priority: 1, route: [s1, s2]}, q: {share: 0.5, lot: 2, route: [s2, s1]}}
release: {kind: renewal, every: {fixed: 30 s}}
workers:
  w1: {walk: 1 m/s, skills: {s1: 1.0, s2: 1.0}}
  w2: {walk: 2 m/s, skills: {s1: 0.5, s2: 1.0}}
  w3: {walk: 1 m/s, home: b, skills: {s1: 1.0, s2: 0.8}}
"""
STOPS = (
    *("breakdowns: {jam: {every: {fixed: 17 s}, by: busy, repair: {fixed: 7 s}, job: resume}}",),
    *("maintenance: {clean: {every: 40 s, lasts: 9 s, when: at_once}}", "preempt: resume"),
)


def n_waits(log):
    return len(log.where((log["kind"] == WAIT) & (log["cause"] == TEAM)))


def members(log):
    return log.where((log["kind"] == WORK) & (log["worker"] >= 0) & (log["job"] < 0))


@pytest.mark.parametrize("rule", ["oldest_job", "nearest", "best_skill"])
def test_the_same_people_go_and_wait_for_each_other(rule):
    log = twins(TEAMS_CELL.replace("MORE", "") + f"allocation: {{rule: {rule}}}\n")
    assert n_waits(log) > 50 and len(members(log)) > 50


@pytest.mark.parametrize("stop", STOPS)
def test_a_team_that_is_broken_up_leaves_the_same_rows(stop):
    assert len(members(twins(TEAMS_CELL.replace("MORE", f", {stop}")))) > 40


@pytest.mark.parametrize("rule", ["finish", "finish_job", "resume", "resume_any", "restart"])
def test_a_team_before_a_break(rule):
    breaks = "breaks: {tea: {at: 06:03, lasts: 1 min}, rest: {at: 06:08, lasts: 1 min}}"
    shift = f"shifts: {{day: {{from: 06:00, to: 14:00, at_break: {rule}, {breaks}}}}}\n"
    edits = [(f"{w}: {{walk", f"{w}: {{shift: day, walk") for w in ("w1", "w2")]
    assert len(members(twins(TEAMS_CELL.replace("MORE", "") + shift, *edits))) > 20
