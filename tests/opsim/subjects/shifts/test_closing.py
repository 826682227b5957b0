"""What was begun before a station closes is finished, whoever goes on with it. By hand arithmetic, in minutes."""

import pytest
from made.shops import ran
from opsim_minutes import minutes

from opsim.log import CLOSED, FINISH, HELD, OFF, TOOL, WALK, WORK

HEAD = """
opsim: 1
name: closing
run: {start: Mon 06:00, horizon: 60 min}
layout: {places: {bay: [0 m, 0 m], far: [60 m, 0 m], shed: [120 m, 0 m]}}
release: {kind: schedule, file: orders.csv}
"""
CELL = """
tasks: {weld: {fixed: 10 min}}
stations: {bench: {at: bay, tasks: [weld], shift: day}}
products: {part: {route: [bench]}}
shifts: {day: {from: 06:00, to: 06:05}, early: {from: 06:00, to: 06:06, at_end: hand_over}}
workers: {ana: {shift: early, skills: {bench: 1.0}}, ben: {skills: {bench: 0.5}}}
"""
ANA, BEN = range(2)
WALKS = ("{skills: {bench: 0.5}}", "{home: shed, walk: 1 m/s, skills: {bench: 0.5}}")


def closing(tmp_path, orders, *edits, text=CELL):
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return ran(tmp_path, text, orders, HEAD)


def pieces(log):
    """(worker, begin, end) of all work at jobs."""
    rows = log.where((log["kind"] == WORK) & (log["job"] >= 0))
    return sorted(zip(rows["worker"].tolist(), rows["start_s"] / 60, rows["end_s"] / 60), key=lambda piece: piece[1])


def test_who_takes_over_after_closing_goes_on_to_the_end(tmp_path):
    log = closing(tmp_path, "0,part 0,part")
    assert pieces(log) == [(ANA, 0, 6), (BEN, 6, 14)]  # 0.4 of his 20 min
    assert minutes(log, HELD, cause=CLOSED) == [(14, 60)]  # the second one


@pytest.mark.parametrize("ends, comes", [("06:04", 6), ("06:03", 5)])
def test_who_was_on_his_way_or_comes_as_it_closes_takes_over_all_the_same(tmp_path, ends, comes):
    log = closing(tmp_path, "0,part", WALKS, ("to: 06:06", f"to: {ends}"))
    assert minutes(log, WALK, BEN)[0] == (comes - 2, comes)
    assert pieces(log) == [(ANA, 0, comes), (BEN, comes, comes + 2 * (10 - comes))]


def test_at_a_station_that_stops_as_it_closes_nothing_is_gone_on_with(tmp_path):
    resume = ("shift: day}", "shift: day, at_close: resume}")
    assert pieces(closing(tmp_path, "0,part", resume)) == [(ANA, 0, 5)]


def test_at_a_closed_station_that_breaks_down_nothing_is_gone_on_with(tmp_path):
    oil = ("shift: day}", "shift: day, maintenance: {oil: {every: 100 h, first: 6 min, lasts: 6 min, when: at_once}}}")
    log = closing(tmp_path, "0,part", oil, ("to: 06:06", "to: 06:07"))
    assert pieces(log) == [(ANA, 0, 6)] and minutes(log, OFF, ANA) == [(7, 60)]


def test_a_tool_goes_on_with_who_takes_over_after_closing(tmp_path):
    gun = ("{weld: {", "{weld: {needs: {gun: 1}, "), ("\ntasks", "\ntools: {gun: {n: 1}}\ntasks")
    log = closing(tmp_path, "0,part", *gun)
    assert pieces(log) == [(ANA, 0, 6), (BEN, 6, 14)]
    assert sum(end - begin for begin, end in minutes(log, TOOL)) == 14


def test_the_tool_of_a_task_that_waits_for_the_opening_is_put_back(tmp_path):
    """There is one gun. Ana is done with a second of three welds at 8; Ben, at another bench, has it then."""
    edits = (
        ("{weld: {fixed: 10 min}}", "{weld: {fixed: 4 min, repeat: 3, needs: {gun: 1}}}\ntools: {gun: {n: 1}}"),
        ("shift: day}}", "shift: day}, other: {at: bay, tasks: [weld]}}"),
        ("{route: [bench]}}", "{route: [bench]}, else: {route: [other]}}"),
        ("06:06", "14:00"),
        ("{bench: 0.5}", "{other: 1.0}"),
    )
    log = closing(tmp_path, "0,part 0,else", *edits)
    assert pieces(log) == [(ANA, 0, 4), (ANA, 4, 8), (BEN, 8, 12), (BEN, 12, 16), (BEN, 16, 20)]


def test_a_brigade_takes_over_after_closing(tmp_path):
    """Ben, back at 14 from the job he has packed, takes over what Ana began at 10; the bench has closed at 12."""
    text = """
tasks: {weld: {fixed: 10 min}, pack: {fixed: 2 min}}
stations: {bench: {at: bay, tasks: [weld], shift: day}, pack: {at: far, tasks: [pack]}}
products: {part: {route: [bench, pack]}}
shifts: {day: {from: 06:00, to: 06:12}}
crews: {line: {kind: bucket_brigade, stations: [bench, pack], workers: [ana, ben]}}
workers: {ana: {skills: {bench: 1, pack: 1}, walk: 1 m/s}, ben: {skills: {bench: 1, pack: 1}, walk: 1 m/s}}
"""
    log = closing(tmp_path, "0,part 0,part 0,part", text=text)
    assert pieces(log) == [(BEN, 0, 10), (ANA, 10, 14), (BEN, 11, 13), (BEN, 14, 20), (BEN, 21, 23)]
    assert minutes(log, FINISH) == [(13, 13), (23, 23)]


LINE = """
tasks: {t: {fixed: 3 min}, u: {fixed: 8 min}}
stations: {s1: {at: bay, tasks: [t]}, s2: {at: far, tasks: [u], shift: day}}
lines: {final: {kind: indexed, stations: [s1, s2], takt: 6 min, andon: {workers: [joker], at: 4 min, does: take_over}}}
products: {part: {route: [s1, s2]}}
shifts: {day: {from: 06:00, to: 06:11}}
workers: {w1: {skills: {s1: 1}}, w2: {skills: {s2: 1}}, joker: {home: shed, walk: 1 m/s, skills: {s2: 1}}}
"""
JOKER, W1, W2 = range(3)


@pytest.mark.parametrize("closes", ["06:10:30", "06:11", "06:12"])
def test_who_is_called_comes_before_at_or_after_closing_and_goes_on(tmp_path, closes):
    """At 6 the first job comes to s2; the joker is called at 10, is there at 11, and 5 of 8 minutes are done."""
    log = closing(tmp_path, "0,part 0,part", ("06:11", closes), text=LINE)
    assert [piece for piece in pieces(log) if piece[0] != W1] == [(W2, 6, 11), (JOKER, 11, 14)]


@pytest.mark.parametrize("closes", ["06:10:30", "06:11", "06:12"])
def test_who_is_called_to_help_does_before_at_or_after_closing(tmp_path, closes):
    log = closing(tmp_path, "0,part 0,part", ("06:11", closes), ("take_over", "help"), text=LINE)
    assert [piece for piece in pieces(log) if piece[0] != W1] == [(W2, 6, 11), (W2, 11, 12.5)]
