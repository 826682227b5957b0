"""Indexed lines by hand: 30, 50 and 40 s of work at a takt of 60 s; who is late, and what keeps the line."""

from itertools import accumulate

import numpy as np
import pytest
from plans import plan, ran

from opsim.engine.draws import Draws
from opsim.engine.floor.run import run_plan
from opsim.kpi.table import figures
from opsim.laws.audit import audit
from opsim.log import (
    AWAY,
    FINISH,
    FULL,
    HELD,
    IS_DOWN,
    LINE_STOP,
    SENT_ON,
    STANDS,
    TAKT,
    UNFINISHED,
    WORK,
)

LINE = """
opsim: 1
name: indexed
run: {start: Mon 06:00, horizon: 1000 s, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m]}}
tasks: {t1: {fixed: 30 s}, t2: {fixed: 50 s}, t3: {fixed: 40 s}}
stations: {s1: {at: a, tasks: [t1]}, s2: {at: a, tasks: [t2]}, s3: {at: a, tasks: [t3]}}
lines: {final: {kind: indexed, stations: [s1, s2, s3], takt: 60 s}}
products: {x: {route: [s1, s2, s3]}}
release: {kind: saturated}
workers: {w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}, w3: {skills: {s3: 1.0}}}
"""
LATE = ("t2: {fixed: 50 s}", "t2: {fixed: 70 s}")
ON = ("takt: 60 s", "takt: 60 s, unfinished: send_on")
JOKER = ("w1: {", "joker: {walk: 1 m/s, home: b, skills: {s2: 2.0}}, w1: {")


def andon(does, at="44 s"):
    return ("takt: 60 s", f"takt: 60 s, unfinished: send_on, andon: {{workers: [joker], at: {at}, does: {does}}}")


def works(log, station=None, job=None):
    rows = log.where(log["kind"] == WORK)
    for column, value in (("station", station), ("job", job)):
        rows = rows if value is None else rows.where(rows[column] == value)
    columns = ("worker", "start_s", "end_s", "progress_from", "progress_to")
    return list(zip(*(rows[column].tolist() for column in columns)))


def stood(log):
    rows = log.of(STANDS)
    return list(zip(rows["cause"].tolist(), rows["start_s"].tolist(), rows["end_s"].tolist()))


def values(log, p):
    return {(f.kpi, f.subject, f.part): f.value for f in figures(log, p)}


def test_all_jobs_move_at_the_same_instants_a_takt_apart():
    log, _ = ran(LINE)
    assert log.of(FINISH)["end_s"].tolist() == [180.0 + 60 * n for n in range(14)]
    starts = {start for _, start, *_ in works(log)}
    assert starts == {60.0 * n for n in range(17)}
    assert stood(log) == []


def test_who_is_done_waits_for_the_line_and_figures_say_so():
    log, p = ran(LINE, ("1000 s", "600 s, warm_up: 180 s"))
    found = values(log, p)
    assert found["station_states", "s2", "takt"] == pytest.approx(10 / 60)
    assert found["station_states", "s2", "work"] == pytest.approx(50 / 60)
    assert found["queue_length", "s2", ""] == 0.0
    assert ("incomplete_share", "final", "") not in found


def test_the_line_stands_until_the_last_is_done_and_the_next_takt_begins_then():
    log, p = ran(LINE, LATE)
    assert stood(log)[:2] == [(UNFINISHED, 120.0, 130.0), (UNFINISHED, 190.0, 200.0)]
    assert works(log, 0)[:4] == [(0, n, n + 30, 0.0, 1.0) for n in (0.0, 60.0, 130.0, 200.0)]
    held = log.where((log["kind"] == HELD) & (log["station"] == 0))
    pairs = list(zip(held["cause"].tolist(), held["start_s"].tolist(), held["end_s"].tolist()))
    assert pairs[1:3] == [(TAKT, 90.0, 120.0), (LINE_STOP, 120.0, 130.0)]
    found = values(log, p)
    assert found["line_stopped_share", "final", "unfinished"] == found["line_stopped_share", "final", ""] == 0.13


def test_a_job_that_is_late_goes_on_unfinished_and_is_bad():
    log, p = ran(LINE, LATE, ON)
    assert works(log, 1)[:2] == [(1, 60.0, 120.0, 0.0, 60 / 70), (1, 120.0, 180.0, 0.0, 60 / 70)]
    assert log.of(SENT_ON)["end_s"].tolist() == [60.0 * n for n in range(2, 17)]
    found = values(log, p)
    assert found["incomplete_share", "final", ""] == found["incomplete_share", "final", "s2"] == 1.0
    assert found["incomplete_share", "final", "s1"] == 0.0
    assert found["throughput_per_h", "", ""] == 0.0


def test_on_the_last_second_is_in_time():
    log, _ = ran(LINE, ("t2: {fixed: 50 s}", "t2: {fixed: 60 s}"), ON)
    assert not len(log.of(SENT_ON))


def test_tasks_that_were_not_begun_are_left_out_and_the_rest_of_the_line_goes_on():
    log, _ = ran(LINE, ("s2: {at: a, tasks: [t2]}", "s2: {at: a, tasks: [t2, t3, t1]}"), ON)
    assert [work[1:] for work in works(log, 1, 0)] == [(60.0, 110.0, 0.0, 1.0), (110.0, 120.0, 0.0, 0.25)]
    assert works(log, 2, 0) == [(2, 120.0, 160.0, 0.0, 1.0)]


def test_nobody_there_is_unfinished_too():
    shift = "shifts: {early: {from: 06:00, to: 14:00, breaks: {coffee: {at: 06:02, lasts: 3 min}}}}\n"
    log, _ = ran(LINE + shift, ON, ("w2: {", "w2: {shift: early, "))
    # his break is from 120 s to 300 s: the jobs that are there in these takts go on as they came
    assert log.of(SENT_ON)["job"].tolist() == [1, 2, 3]
    assert 4 in log.where((log["kind"] == WORK) & (log["station"] == 1))["job"]


def test_somebody_who_is_called_takes_over_and_the_other_is_free():
    log, _ = ran(LINE, LATE, andon("take_over"), JOKER)
    # called at 60 + 44 s, 3 m away: there at 107 s. 23 s are left of 70 s, of his own 35 s therefore 11.5 s
    assert works(log, 1, 0) == [(2, 60.0, 107.0, 0.0, 47 / 70), (0, 107.0, 118.5, 47 / 70, 1.0)]
    assert not len(log.of(SENT_ON))
    assert works(log, 1, 1)[1][1] == 164.0  # he stands there already


def test_somebody_who_is_called_helps_and_both_are_done_at_once():
    log, _ = ran(LINE, LATE, andon("help"), JOKER)
    # 23 s are left for one and 11.5 s for the other: 23/3 s together
    end_s = 107 + 23 / 3
    rows = works(log, 1, 0)
    assert rows[0] == (2, 60.0, 107.0, 0.0, 47 / 70)
    assert rows[1] == pytest.approx((2, 107.0, end_s, 47 / 70, 1.0), abs=1e-6)
    helped = [row for row in works(log, 1, -1) if row[1] == 107.0]
    assert helped == [(0, *rows[1][1:])]


def test_who_helps_is_free_where_the_work_is_broken_off_and_the_rest_is_for_one_again():
    jam = "s2: {at: a, breakdowns: {jam: {every: {fixed: 110 s}, by: clock, repair: {fixed: 20 s}}},"
    log, _ = ran(LINE, LATE, andon("help"), JOKER, ("s2: {at: a,", jam))
    # 3 s together are 9 s of one's work: at 110 s 14 s are left for one; from 130 s on he is helped again
    row = works(log, 1, 0)[1]
    assert row[1:3] == (107.0, 110.0)
    assert row[4] == pytest.approx(1 - 14 / 70)
    assert works(log, 1, 0)[2][:3] == pytest.approx((2, 130.0, 130 + 14 / 3), abs=1e-5)


def test_who_helps_and_has_to_go_leaves_the_other_one_alone_with_the_rest():
    shift = "shifts: {early: {from: 06:00, to: 14:00, breaks: {coffee: {at: 06:01:50, lasts: 5 min}}}}\n"
    log, _ = ran(LINE + shift, LATE, andon("help"), JOKER, ("joker: {", "joker: {shift: early, "))
    # together from 107 s on; at 110 s, when his break begins, 14 s are left for one: beyond the 120 s of the takt
    rows = works(log, 1, 0)
    assert [row[1:3] for row in rows] == [(60.0, 107.0), (107.0, 110.0), (110.0, 120.0)]
    assert rows[2][3:] == pytest.approx((1 - 14 / 70, 1 - 4 / 70))
    assert next(row[1:3] for row in works(log, 1, -1)) == (107.0, 110.0)


def test_nobody_is_called_to_a_job_that_is_done_and_who_comes_too_late_is_free():
    log, _ = ran(LINE, ("t2: {fixed: 50 s}", "t2: {fixed: 46 s}"), andon("take_over"), JOKER, ("1000 s", "160 s"))
    assert all(worker != 0 for worker, *_ in works(log))
    walks = log.where((log["worker"] == 0) & (log["start_s"] == 104.0))
    assert walks["end_s"].tolist() == [107.0]  # called at 104 s, and the job is done at 106 s


def test_who_is_called_serves_the_line_only_when_he_is_called():
    log, _ = ran(LINE, andon("take_over"), ("w1: {", "joker: {skills: {s1: 1.0, s2: 1.0, s3: 1.0}}, w1: {"))
    assert all(start % 60 == 44 for worker, start, *_ in works(log) if worker == 0)


def test_a_station_that_is_down_stops_the_line_and_its_clock():
    jam = "s2: {at: a, breakdowns: {jam: {every: {fixed: 100 s}, by: clock, repair: {fixed: 25 s}}},"
    log, p = ran(LINE, ("s2: {at: a,", jam))
    assert stood(log)[0] == (IS_DOWN, 100.0, 125.0)
    assert works(log, 0)[:3] == [(0, n, n + 30, 0.0, 1.0) for n in (0.0, 60.0, 145.0)]
    assert values(log, p)["line_stopped_share", "final", "down"] > 0


def test_the_line_stands_while_all_its_people_have_a_break():
    shift = "shifts: {early: {from: 06:00, to: 14:00, breaks: {coffee: {at: 06:01:40, lasts: 5 min}}}}\n"
    text = LINE.replace("w1: {", "w1: {shift: early, ").replace("w2: {", "w2: {shift: early, ")
    log, _ = ran(text.replace("w3: {", "w3: {shift: early, ") + shift.replace("06:01:40", "06:02"))
    # the break is at the instant at which the line would move
    assert stood(log) == [(AWAY, 120.0, 420.0)] or stood(log)[0] == (AWAY, 120.0, 420.0)
    assert works(log, 1)[1][1] == 420.0


def test_a_full_station_after_the_line_stops_it():
    log, _ = ran(
        LINE,
        ("{s1: {at: a,", "{z: {at: a, tasks: [v], buffer: 0}, s1: {at: a,"),
        ("{t1: {", "{v: {fixed: 100 s, automatic: true}, t1: {"),
        ("route: [s1, s2, s3]", "route: [s1, s2, s3, z]"),
    )
    assert stood(log)[:2] == [(FULL, 240.0, 280.0), (FULL, 340.0, 380.0)]
    assert log.of(FINISH)["end_s"].tolist() == [280.0 + 100 * n for n in range(8)]


def test_jobs_that_arrive_between_two_moves_come_on_at_the_next_one():
    log, _ = ran(LINE, ("kind: saturated", "kind: renewal, every: {fixed: 90 s}"))
    # at 90 s -> 120 s, 180 s -> 180 s, 270 s -> 300 s, 360 s -> 360 s; each leaves three takts later
    assert log.of(FINISH)["end_s"][:4].tolist() == [300.0, 360.0, 480.0, 540.0]


def test_automatic_stations_and_stations_without_tasks_move_with_the_line():
    log, _ = ran(
        LINE,
        ("t2: {fixed: 50 s}", "t2: {fixed: 50 s, automatic: true}"),
        ("s3: {at: a, tasks: [t3]}", "s3: {at: a, tasks: []}"),
    )
    assert log.of(FINISH)["end_s"].tolist() == [180.0 + 60 * n for n in range(14)]
    assert {worker for worker, *_ in works(log, 1)} == {-1}


def test_a_lot_of_two_takes_twice_as_long_at_each_station():
    log, p = ran(
        LINE,
        (
            "products: {x: {route: [s1, s2, s3]}}",
            "products: {x: {route: [s1, s2, s3]}, y: {route: [s1, s2, s3], lot: 2}}",
        ),
        ("kind: saturated", "kind: saturated, sequence: [x, y]"),
        ON,
    )
    assert set(log.of(SENT_ON)["job"].tolist()) == set(range(1, 15, 2))
    assert values(log, p)["incomplete_share", "final", "s1"] == 0.0


def test_parts_that_are_missing_do_not_stop_a_line_that_sends_on():
    text = LINE.replace("products: {", "stores: {shelf: {at: a, initial: {p: 2}}}\nproducts: {p: {route: [q, shelf]}, ")
    text = text.replace("x: {route: [s1, s2, s3]}", "x: {route: [s1, s2, s3], parts: {s2: {p: 1}}}")
    text = text.replace("stations: {", "stations: {q: {at: a, tasks: [t1]}, ").replace("{s1: 1.0}", "{s1: 1.0, q: 1.0}")
    text = text.replace(
        "release: {kind: saturated}",
        "sources: {xs: {kind: saturated, products: [x]}, ps: {kind: renewal, every: {fixed: 900 s}, products: [p]}}",
    )
    log, p = ran(text, ON)
    found = values(log, p)
    assert len(log.of(SENT_ON)) > 10
    assert found["incomplete_share", "final", "s2"] == found["incomplete_share", "final", ""] > 0.8


RANDOM = (
    ("horizon: 1000 s, seed: 1", "horizon: 20000 s, seed: 5"),
    *(
        (f"t{i}: {{fixed: {s} s}}", f"t{i}: {{dist: gamma, mean: 50 s, cv: 0.3}}")
        for i, s in ((1, 30), (2, 50), (3, 40))
    ),
)


def drawn(p, n=400):
    luck = [Draws(p, 0).durations(i, i) for i in range(3)]
    return np.array([[max(1, round(next(one) * 2**20)) / 2**20 for _ in range(n)] for one in luck])


def test_the_moves_of_a_line_that_stops_are_those_of_the_recursion():
    log, p = ran(LINE, *RANDOM)
    x = drawn(p)
    slowest = [max(x[i, n - i] for i in range(3) if n >= i) for n in range(390)]
    moves = list(accumulate(slowest, lambda at, longest: at + max(60.0, longest), initial=0.0))
    finished = log.of(FINISH)["end_s"].tolist()
    assert finished == pytest.approx([at for at in moves[3:] if at < 20000], abs=1e-9)
    assert len(finished) > 200


def test_jobs_are_incomplete_exactly_where_a_time_drawn_is_beyond_takt():
    log, p = ran(LINE, *RANDOM, ON)
    late = {(i, n) for i, n in zip(*np.nonzero(drawn(p) > 60.0)) if (n + i + 1) * 60 < 20000}
    sent = log.of(SENT_ON)
    assert set(zip(sent["station"].tolist(), sent["job"].tolist())) == late
    assert len(late) > 50


def test_the_order_of_declaration_decides_nothing():
    texts = [LINE.replace("1000 s", "4000 s"), LINE.replace("1000 s", "4000 s")]
    texts[1] = texts[1].replace(
        "{w1: {skills: {s1: 1.0}}, w2: {skills: {s2: 1.0}}", "{w2: {skills: {s2: 1.0}}, w1: {skills: {s1: 1.0}}"
    )
    texts[1] = texts[1].replace(
        "{s1: {at: a, tasks: [t1]}, s2: {at: a, tasks: [t2]}", "{s2: {at: a, tasks: [t2]}, s1: {at: a, tasks: [t1]}"
    )
    assert texts[0] != texts[1]
    logs = []
    for text in texts:
        p = plan(text.replace("t2: {fixed: 50 s}", "t2: {fixed: 65 s}"))
        logs.append(run_plan(p))
        audit(logs[-1], p)
    assert all(np.array_equal(logs[0][name], logs[1][name], equal_nan=name.startswith("p")) for name in logs[0].columns)


CHANGE_OF_SHIFTS = """
opsim: 1
name: help
run: {start: Mon 06:00, horizon: 1 h, seed: 1}
layout: {places: {p: [0 m, 0 m]}}
tasks: {fit: {fixed: 12 s}}
stations: {a: {at: p, tasks: [fit]}}
products: {q: {route: [a]}}
release: {kind: saturated}
shifts: {early: {from: 06:00, to: 06:30, at_end: finish}, late: {from: 06:30, to: 07:00}}
workers:
  ana: {skills: {a: 1}, shift: early}
  ben: {skills: {a: 1}, shift: late}
  joker: {skills: {a: 1}, shift: late}
lines: {line: {kind: indexed, stations: [a], takt: 16 s, andon: {workers: [joker], at: 8 s, does: help}}}
"""


def test_who_is_helped_from_the_end_of_her_shift_on_finishes_what_she_is_at():
    p = plan(CHANGE_OF_SHIFTS)
    log = run_plan(p, 0)
    audit(log, p)
    work = log.of(WORK)
    hers = work.where((work["worker"] == 0) & (work["end_s"] > 1795.0))
    assert list(zip(hers["start_s"], hers["end_s"])) == [(1792.0, 1800.0), (1800.0, 1802.0)]
