"""Hand-over: somebody is wanted, comes, and takes over; or what happens instead. By hand arithmetic, in minutes."""

import pytest
from made.shops import ran
from opsim_minutes import minutes
from plans import ran as ran_alone

from opsim.log import BAD, BREAK, FINISH, HELD, NO_CAUSE, SCRAP, SETUP, STANDS, TOOL, WALK, WORK

HEAD = """
opsim: 1
name: relief
run: {start: Mon 06:00, horizon: 60 min}
layout: {places: {bay: [0 m, 0 m], shed: [120 m, 0 m]}}
release: {kind: schedule, file: orders.csv}
"""
CELL = """
tasks: {weld: {fixed: 10 min}}
stations: {bench: {at: bay, tasks: [weld]}}
products: {part: {route: [bench]}, top: {route: [bench], priority: 2}}
shifts:
  early: {from: 06:00, to: 14:00, breaks: {tea: {at: 06:06, lasts: 5 min}}, at_break: hand_over}
  other: {from: 06:00, to: 14:00, breaks: {tea: {at: 06:07, lasts: 5 min}}, at_break: hand_over}
workers:
  ana: {shift: early, skills: {bench: 1.0}}
  ben: {walk: 1 m/s, home: shed, skills: {bench: 1.0}}
"""
ANA, BEN, CEM = range(3)
DORA = CEM
CEM_TOO = ("  ben:", "  cem: {skills: {bench: 0.5}, walk: 0.5 m/s, home: shed}\n  ben:")


def relieved(tmp_path, orders, *edits):
    text = CELL
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return ran(tmp_path, text, orders, HEAD)


def test_who_is_on_the_way_takes_over_on_arrival(tmp_path):
    log = relieved(tmp_path, "0,part")
    assert minutes(log, WALK, BEN) == [(6, 8)]
    assert minutes(log, WORK, ANA) == [(0, 8)] and minutes(log, WORK, BEN) == [(8, 10)]
    assert minutes(log, BREAK, ANA) == [(8, 13)]


def test_of_several_the_rule_of_allocation_sends_one(tmp_path):
    """Cem, who is there, though he is slower."""
    log = relieved(tmp_path, "0,part", ("  ben:", "  cem: {skills: {bench: 0.5}}\n  ben:"))
    assert minutes(log, WORK, CEM) == [(6, 14)] and minutes(log, WALK, BEN) == []


def test_who_is_relieved_at_once_goes_to_his_break_before_he_goes_home(tmp_path):
    home = ("ana: {", "ana: {home: shed, walk: 2 m/s, "), ("workers:", "allocation: {idle: home}\nworkers:")
    log = relieved(tmp_path, "0,part", *home, ("home: shed, skills", "floater: true, skills"))
    assert minutes(log, WORK, ANA) == [(1, 6)] and minutes(log, WORK, BEN) == [(6, 11)]
    assert minutes(log, WALK, ANA)[:1] == [(0, 1)] and minutes(log, BREAK, ANA) == [(6, 11)]


def test_who_is_on_the_way_and_has_to_go_himself_is_replaced(tmp_path):
    """Ben sets out at 6 min and has his break at 7; Cem, who walks for 4 min, is sent then, and comes too late."""
    log = relieved(tmp_path, "0,part", ("ben: {", "ben: {shift: other, "), CEM_TOO)
    assert minutes(log, WALK, BEN) == [(6, 8)] and minutes(log, BREAK, BEN) == [(8, 13)]
    assert minutes(log, WALK, CEM) == [(7, 11)]
    assert minutes(log, WORK, ANA) == [(0, 10)] and minutes(log, BREAK, ANA) == [(10, 15)]


def test_a_breakdown_in_between_lets_the_leaver_go_at_once(tmp_path):
    jam = "tasks: [weld], maintenance: {oil: {every: 100 h, first: 7 min, lasts: 6 min, when: at_once}}"
    log = relieved(tmp_path, "0,part", ("tasks: [weld]", jam))
    assert minutes(log, WORK, ANA)[0] == (0, 7) and minutes(log, BREAK, ANA) == [(7, 12)]
    assert minutes(log, WALK, BEN) == [(6, 8)]
    assert minutes(log, FINISH) == [(16, 16)]  # 0.7 was done when it stopped; it stands until 13


def test_a_job_that_is_scrapped_before_the_taker_comes_leaves_him_free(tmp_path):
    jam = "tasks: [weld], breakdowns: {jam: {every: {fixed: 7 min}, repair: {fixed: 30 min}, job: scrap}}"
    log = relieved(tmp_path, "0,part", ("tasks: [weld]", jam))
    assert minutes(log, SCRAP) == [(7, 7)] and minutes(log, WORK, BEN) == []
    assert minutes(log, WALK, BEN) == [(6, 8)] and minutes(log, BREAK, ANA) == [(7, 12)]


def test_a_job_that_is_pre_empted_before_the_taker_comes_is_the_takers_in_turn(tmp_path):
    """The urgent part comes at 7 min: Ana is free, and Ben, there at 8, does it until 18; Ana does the rest of hers."""
    log = relieved(tmp_path, "0,part 420,top", ("tasks: [weld]", "tasks: [weld], preempt: resume"))
    assert minutes(log, BREAK, ANA) == [(7, 12)] and minutes(log, WORK, ANA)[0] == (0, 7)
    assert minutes(log, WORK, BEN)[0] == (8, 18)
    assert max(minutes(log, FINISH)) == (21, 21)


def test_a_set_up_is_handed_over_too(tmp_path):
    edit = ("tasks: [weld]", "tasks: [weld], setup: {otherwise: 4 min, first: top}")
    log = relieved(tmp_path, "300,part", edit)
    assert minutes(log, SETUP, ANA) == [(5, 8)] and minutes(log, SETUP, BEN) == [(8, 9)]
    assert minutes(log, WORK, BEN) == [(9, 19)]


def test_two_who_want_to_go_are_relieved_one_after_the_other(tmp_path):
    """Both are to go at 6 min; Ben takes over from Ana at once, and from 10 min on from Dora, who has 3 min to go."""
    edits = (
        ("tasks: [weld]", "tasks: [weld], servers: 2"),
        ("home: shed, ", "floater: true, "),
        ("  ben:", "  dora: {shift: early, skills: {bench: 1.0}}\n  ben:"),
    )
    log = relieved(tmp_path, "0,part 180,part", *edits)
    assert minutes(log, BREAK, ANA) == [(6, 11)] and minutes(log, BREAK, DORA) == [(10, 15)]
    assert minutes(log, WORK, BEN) == [(6, 10), (10, 13)]


def test_the_share_that_is_left_is_the_takers_own_time(tmp_path):
    log = relieved(tmp_path, "0,part", ("home: shed, skills: {bench: 1.0}", "home: shed, skills: {bench: 0.25}"))
    assert minutes(log, WORK, BEN) == [(8, 16)] and minutes(log, HELD) == []


GUN = (
    ("bench: {at: bay, tasks: [weld]}", "bench: {at: bay, tasks: [weld]}, desk: {at: bay, tasks: [weld]}"),
    ("top: {route: [bench], priority: 2}", "top: {route: [desk]}"),
    ("home: shed, skills", "skills"),
    ("  ben:", "  cem: {skills: {desk: 1.0}}\n  ben:"),
    ("workers:", "tools: {gun: {n: 1}}\nworkers:"),
)


def test_tools_go_from_hand_to_hand_whoever_waits_for_them(tmp_path):
    """Cem's job has waited for the gun since 1 min; Ben takes it over from Ana at 6."""
    log = relieved(tmp_path, "0,part 60,top", *GUN, ("{fixed: 10 min}", "{fixed: 10 min, needs: {gun: 1}}"))
    assert minutes(log, WORK, ANA) == [(0, 6)] and minutes(log, WORK, BEN) == [(6, 10)]
    assert minutes(log, WORK, CEM) == [(10, 20)]


def test_a_tool_in_the_hands_goes_to_the_other_hands(tmp_path):
    """The gun is held from 0.5 to 0.8 of it: by Ana from 5 to 6 min, by Ben until 8, then by Cem, who waits from 6."""
    hold = ("{fixed: 10 min}", "{fixed: 10 min, hold: {tool: gun, from: 0.5, to: 0.8}}")
    log = relieved(tmp_path, "0,part 60,top", *GUN, hold)
    assert minutes(log, TOOL) == [(5, 8), (8, 11)]
    assert minutes(log, WORK, BEN) == [(6, 10)] and minutes(log, WORK, CEM) == [(1, 6), (8, 13)]


LINE = """
opsim: 1
name: relief on a moving line
run: {start: Mon 06:00, horizon: 119 s}
layout: {places: {bay: [0 m, 0 m]}}
tasks: {weld: {fixed: 100 s}}
stations: {bench: {at: bay, tasks: [weld]}}
lines: {final: {kind: moving, stations: [bench], takt: 120 s, length: 12 m}}
products: {part: {route: [bench]}}
release: {kind: saturated}
shifts: {early: {from: 06:00, to: 06:01, at_end: hand_over}}
workers:
  ana: {shift: early, skills: {bench: 1.0}}
  ben: {walk: 0.2 m/s, skills: {bench: {pace: 1.0, quality: 1.0e-9}}}
"""


def seconds(log, kind, worker):
    rows = log.where((log["kind"] == kind) & (log["worker"] == worker))
    return list(zip(rows["start_s"].tolist(), rows["end_s"].tolist()))


@pytest.mark.parametrize(("walk", "meets_s"), [("0.2 m/s", None), ("0.3 m/s", 90.0), ("0.7 m/s", 70.0)])
def test_on_a_moving_line_who_is_relieved_works_on_until_the_taker_is_at_the_job(walk, meets_s):
    """At 60 s the job is 6 m down the line and moves at 0.1 m/s: he gains on it by what he is faster than that."""
    log, _ = ran_alone(LINE, ("walk: 0.2 m/s", f"walk: {walk}"))
    assert seconds(log, WORK, ANA) == [(0, meets_s or 100)]
    assert seconds(log, WALK, BEN)[0] == (60, meets_s or 100)
    assert seconds(log, WORK, BEN) == ([(meets_s, 100)] if meets_s else [])
    assert not len(log.of(STANDS))


@pytest.mark.parametrize(("walk", "bad"), [("0.2 m/s", False), ("0.3 m/s", True)])
def test_who_never_came_to_the_job_on_the_line_leaves_no_defect_in_it(walk, bad):
    log, _ = ran_alone(LINE, ("walk: 0.2 m/s", f"walk: {walk}"), ("horizon: 119 s", "horizon: 121 s"))
    assert log.of(FINISH)["cause"].tolist() == [BAD if bad else NO_CAUSE]
