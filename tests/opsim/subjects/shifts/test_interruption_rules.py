"""The rules of interruption on one worked example, every time by hand.

Ana welds a part of 10 min from 0; her break comes at 6 min and lasts 5 min. Ben, who takes twice her time, is busy at
another place until 7 min, and walks for 1 min. Times are in minutes; Ana's first performance has k = 0.

| rule       | Ana welds    | her break | Ben welds                    | done |
|------------|--------------|-----------|------------------------------|------|
| finish     | 0-10         | 10-15     |                              | 10   |
| resume     | 0-6, 11-15   | 6-11      |                              | 15   |
| resume_any | 0-6          | 6-11      | 0.4 of his 20 min, 8-16      | 16   |
| hand_over  | 0-8          | 8-13      | 0.2 of his 20 min, 8-12      | 12   |
| restart    | 0-6, lost    | 6-11      | all of his 20 min, 8-28      | 28   |
| finish_job | 0-10, then a check of 2 min to 12; break 12-17              | 12   |
"""

import pytest
from made.shops import ran

from opsim.log import AWAY, BREAK, FINISH, HELD, NO_WORKER, WALK, WORK

HEAD = """
opsim: 1
name: interrupted
run: {start: Mon 06:00, horizon: 40 min}
layout: {places: {bay: [0 m, 0 m], shed: [60 m, 0 m]}}
release: {kind: schedule, file: orders.csv}
"""
CELL = """
tasks: {weld: {fixed: 10 min}, sweep: {fixed: 7 min}, check: {fixed: 2 min}}
stations: {bench: {at: bay, tasks: [weld]}, yard: {at: shed, tasks: [sweep]}}
products: {part: {route: [bench]}, heap: {route: [yard]}}
shifts: {early: {from: 06:00, to: 14:00, breaks: {tea: {at: 06:06, lasts: 5 min}}, at_break: RULE}}
workers:
  ana: {shift: early, skills: {bench: 1.0}}
  ben: {walk: 1 m/s, skills: {bench: 0.5, yard: 1.0}, home: shed}
"""
ANA, BEN, BENCH = 0, 1, 0


def interrupted(tmp_path, rule, *edits, orders="0,part 0,heap"):
    text = CELL.replace("RULE", rule)
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return ran(tmp_path, text, orders, HEAD)


def minutes(log, kind, worker=None, station=None, cause=None):
    """(from, to) in minutes of the rows of a kind, in time."""
    keep = log["kind"] == kind
    for column, value in (("worker", worker), ("station", station), ("cause", cause)):
        if value is not None:
            keep = keep & (log[column] == value)
    return sorted(zip((log["start_s"][keep] / 60).tolist(), (log["end_s"][keep] / 60).tolist()))


def pieces(log):
    """(worker, k, from, to) of all pieces of the weld, in time: how much of it was done."""
    rows = log.where((log["kind"] == WORK) & (log["station"] == BENCH))
    columns = (rows[name].tolist() for name in ("start_s", "worker", "k", "progress_from", "progress_to"))
    return [row[1:] for row in sorted(zip(*columns))]


EXPECTED = {
    "finish": ([(0, 10)], [(10, 15)], [], 10),
    "finish_job": ([(0, 10)], [(10, 15)], [], 10),
    "resume": ([(0, 6), (11, 15)], [(6, 11)], [], 15),
    "resume_any": ([(0, 6)], [(6, 11)], [(8, 16)], 16),
    "hand_over": ([(0, 8)], [(8, 13)], [(8, 12)], 12),
    "restart": ([(0, 6)], [(6, 11)], [(8, 28)], 28),
}


@pytest.mark.parametrize("rule", EXPECTED)
def test_the_worked_example_goes_as_by_hand(tmp_path, rule):
    log = interrupted(tmp_path, rule)
    ana, pause, ben, done = EXPECTED[rule]
    assert minutes(log, WORK, ANA) == ana
    assert minutes(log, BREAK, ANA) == pause
    assert minutes(log, WORK, BEN, BENCH) == ben
    assert max(end for _, end in minutes(log, FINISH)) == done


@pytest.mark.parametrize("rule", EXPECTED)
def test_a_task_of_its_own_rule_is_left_by_that(tmp_path, rule):
    other = "restart" if rule == "finish" else "finish"
    log = interrupted(tmp_path, other, ("{fixed: 10 min}", f"{{fixed: 10 min, interruption: {rule}}}"))
    assert minutes(log, WORK, ANA) == EXPECTED[rule][0] and minutes(log, WORK, BEN, BENCH) == EXPECTED[rule][2]


def test_pieces_say_how_much_was_done_and_whose_performance_it_is(tmp_path):
    assert pieces(interrupted(tmp_path, "resume")) == [(ANA, 0, 0, 0.6), (ANA, 0, 0.6, 1)]
    assert pieces(interrupted(tmp_path, "resume_any")) == [(ANA, 0, 0, 0.6), (BEN, 0, 0.6, 1)]
    assert pieces(interrupted(tmp_path, "hand_over")) == [(ANA, 0, 0, 0.8), (BEN, 0, 0.8, 1)]
    assert pieces(interrupted(tmp_path, "restart")) == [(ANA, 0, 0, 0.6), (BEN, 0, 0, 1)]


def test_what_was_lost_uses_its_performance_up(tmp_path):
    alone = ("bench: 0.5, ", "")
    assert pieces(interrupted(tmp_path, "restart", alone)) == [(ANA, 0, 0, 0.6), (ANA, 1, 0, 1)]
    assert minutes(interrupted(tmp_path, "restart", alone), WORK, ANA) == [(0, 6), (11, 21)]


def test_the_rest_of_the_same_worker_is_the_same_performance(tmp_path):
    rows = interrupted(tmp_path, "resume")
    rows = rows.where((rows["kind"] == WORK) & (rows["station"] == BENCH))
    assert len(set(rows["performance_id"].tolist())) == 1


def test_the_job_waits_for_who_began_it_or_for_anybody(tmp_path):
    assert minutes(interrupted(tmp_path, "resume"), HELD, cause=AWAY) == [(6, 11)]
    assert minutes(interrupted(tmp_path, "resume_any"), HELD, cause=NO_WORKER) == [(6, 8)]


def test_who_began_goes_on_where_nobody_else_comes(tmp_path):
    log = interrupted(tmp_path, "resume_any", ("bench: 0.5, ", ""))
    assert minutes(log, WORK, ANA) == [(0, 6), (11, 15)] and {k for _, k, _, _ in pieces(log)} == {0}


def test_a_hand_over_that_nobody_comes_to_is_finished(tmp_path):
    log = interrupted(tmp_path, "hand_over", ("bench: 0.5, ", ""))
    assert minutes(log, WORK, ANA) == [(0, 10)] and minutes(log, BREAK, ANA) == [(10, 15)]


def test_who_comes_too_late_to_take_over_is_free(tmp_path):
    """Ben sets out at 9 min, since he has 9 to sweep, and Ana is done when he comes."""
    log = interrupted(tmp_path, "hand_over", ("sweep: {fixed: 7 min}", "sweep: {fixed: 9 min}"))
    assert minutes(log, WALK, BEN) == [(9, 10)]
    assert minutes(log, WORK, ANA) == [(0, 10)] and minutes(log, WORK, BEN, BENCH) == []


TWO_TASKS = ("tasks: [weld]", "tasks: [weld, check]")


def test_all_tasks_of_the_job_are_finished_or_only_the_one_under_way(tmp_path):
    log = interrupted(tmp_path, "finish_job", TWO_TASKS)
    assert minutes(log, WORK, ANA) == [(0, 10), (10, 12)] and minutes(log, BREAK, ANA) == [(12, 17)]
    log = interrupted(tmp_path, "finish", TWO_TASKS)
    assert minutes(log, WORK, ANA) == [(0, 10)] and minutes(log, BREAK, ANA) == [(10, 15)]
    assert minutes(log, WORK, BEN, BENCH) == [(11, 15)]  # the check, at his pace, after a walk of a minute


def test_a_task_that_would_begin_at_the_very_instant_is_not_begun(tmp_path):
    """The first task ends at 6 min, when the break begins."""
    edits = (TWO_TASKS, ("weld: {fixed: 10 min}", "weld: {fixed: 6 min}"))
    log = interrupted(tmp_path, "finish", *edits)
    assert minutes(log, WORK, ANA) == [(0, 6)] and minutes(log, BREAK, ANA) == [(6, 11)]
    assert minutes(log, WORK, BEN, BENCH) == [(8, 12)]
    log = interrupted(tmp_path, "finish_job", *edits)
    assert minutes(log, WORK, ANA) == [(0, 6), (6, 8)] and minutes(log, BREAK, ANA) == [(8, 13)]


def test_who_took_over_is_relieved_in_turn_when_his_own_break_comes(tmp_path):
    """Ben takes over at 8 min with 4 min to go; his break comes at 10 min, when half of that is done: 0.9 of the weld.
    Ana is free at 13 min. Ben has finished by then, at 12 min, and has his break late.

    With a break of Ana that is over at 11 min she comes back before: 0.95 of it is done, and she does the rest in 30 s.
    """
    late = "late: {from: 06:00, to: 14:00, breaks: {tea: {at: 06:10, lasts: 5 min}}, at_break: hand_over}, early: {"
    edits = (("early: {", late), ("ben: {", "ben: {shift: late, "))
    log = interrupted(tmp_path, "hand_over", *edits)
    assert minutes(log, WORK, BEN, BENCH) == [(8, 12)] and minutes(log, BREAK, BEN) == [(12, 17)]
    log = interrupted(tmp_path, "hand_over", *edits, ("06:06, lasts: 5 min", "06:06, lasts: 3 min"))
    assert minutes(log, WORK, BEN, BENCH) == [(8, 11)] and minutes(log, BREAK, BEN) == [(11, 16)]
    assert minutes(log, WORK, ANA) == [(0, 8), (11, 11.5)]
    assert [piece[0] for piece in pieces(log)] == [ANA, BEN, ANA]
