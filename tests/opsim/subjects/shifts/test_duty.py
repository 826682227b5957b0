"""When people are there: by hand arithmetic, in minutes unless it says otherwise."""

import pytest
from made.shops import ran
from opsim_minutes import minutes

from opsim.log import ABSENT, AWAY, BREAK, FINISH, HELD, NO_WORKER, OFF, WAIT, WALK, WORK

HEAD = """
opsim: 1
name: duty
run: {start: Mon 06:00, horizon: 60 min}
layout: {places: {bay: [0 m, 0 m], shed: [60 m, 0 m]}}
release: {kind: schedule, file: orders.csv}
"""
CELL = """
tasks: {weld: {fixed: 7 min}}
stations: {bench: {at: bay, tasks: [weld]}}
products: {part: {route: [bench]}}
shifts: {early: {from: 06:00, to: 06:20}, late: {from: 06:20, to: 06:40}}
workers: {ana: {shift: early, skills: {bench: 1.0}}}
"""
ANA, BEN = 0, 1


def worked(tmp_path, orders, *edits, head=HEAD):
    text = CELL
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return ran(tmp_path, text, orders, head)


MANY = " ".join(["0,part"] * 100)
BOTH = ("{bench: 1.0}}}", "{bench: 1.0}}, ben: {shift: late, skills: {bench: 1.0}}}")


def at_end(rule):
    return "early: {", f"early: {{at_end: {rule}, "


@pytest.mark.parametrize(("rule", "ana", "ben"), [
    ("finish", [(0, 7), (7, 14), (14, 21)], [(21, 28), (28, 35), (35, 42)]),
    ("hand_over", [(0, 7), (7, 14), (14, 20)], [(20, 21), (21, 28), (28, 35), (35, 42)]),
    ("resume_any", [(0, 7), (7, 14), (14, 20)], [(20, 21), (21, 28), (28, 35), (35, 42)]),
    ("restart", [(0, 7), (7, 14), (14, 20)], [(20, 27), (27, 34), (34, 41)]),
    ("resume", [(0, 7), (7, 14), (14, 20)], []),  # Ana is back tomorrow, and the job keeps the only server
])  # fmt: skip
def test_two_shifts_meet_by_the_rule(tmp_path, rule, ana, ben):
    log = worked(tmp_path, MANY, BOTH, at_end(rule))
    assert minutes(log, WORK, ANA) == ana
    assert minutes(log, WORK, BEN) == ben
    assert minutes(log, OFF, BEN)[0] == (0, 20)


def test_who_is_off_is_gone_and_comes_at_his_home(tmp_path):
    day = ("early: {from: 06:00, to: 06:20}", "early: {from: 06:10, to: 06:30}")
    home = ("skills:", "home: shed, walk: 1 m/s, skills:")
    log = worked(tmp_path, "0,part", day, home)
    assert minutes(log, OFF) == [(0, 10), (30, 60)] and minutes(log, WALK) == [(10, 11)]
    assert minutes(log, WORK) == [(11, 18)] and minutes(log, HELD, cause=NO_WORKER) == [(0, 11)]


def test_a_job_kept_over_night_is_gone_on_with_in_the_next_shift_of_its_worker(tmp_path):
    head = HEAD.replace("60 min", "25 h")
    log = worked(tmp_path, MANY, at_end("resume"), head=head)
    assert minutes(log, HELD, cause=AWAY) == [(20, 1440), (1460, 1500)]
    assert minutes(log, WORK)[2:5] == [(14, 20), (1440, 1441), (1441, 1448)]


def test_overtime_lasts_while_jobs_on_the_floor_need_him(tmp_path):
    over = ("early: {", "early: {overtime: {most: 15 min}, ")
    log = worked(tmp_path, "0,part 0,part 0,part 0,part", over)
    assert minutes(log, WORK) == [(0, 7), (7, 14), (14, 21), (21, 28)] and minutes(log, OFF) == [(28, 60)]
    log = worked(tmp_path, MANY, over)  # what is begun at 28 min is cut by the end of overtime at 35, exactly done
    assert minutes(log, WORK)[-1] == (28, 35) and minutes(log, OFF) == [(35, 60)]
    log = worked(tmp_path, "0,part", over)
    assert minutes(log, OFF) == [(20, 60)]


def test_overtime_ends_by_the_rule_of_the_end_of_the_shift(tmp_path):
    over = ("early: {", "early: {overtime: {most: 12 min}, at_end: RULE, ")
    for rule, last in (("finish", (28, 35)), ("resume", (28, 32)), ("restart", (28, 32))):
        log = worked(tmp_path, MANY, (over[0], over[1].replace("RULE", rule)))
        assert minutes(log, WORK)[-1] == last and minutes(log, OFF) == [(last[1], 60)]


def test_who_stays_waits_for_a_job_that_is_still_to_come_to_him(tmp_path):
    """The oven is done at 25 min; Ana, off at 20, stays and packs until 27."""
    edits = (
        ("weld: {fixed: 7 min}", "bake: {fixed: 25 min, automatic: true}, pack: {fixed: 2 min}"),
        ("bench: {at: bay, tasks: [weld]}", "oven: {at: bay, tasks: [bake]}, bench: {at: bay, tasks: [pack]}"),
        ("route: [bench]", "route: [oven, bench]"),
        ("early: {", "early: {overtime: {most: 15 min}, "),
    )
    log = worked(tmp_path, "0,part", *edits)
    assert minutes(log, WAIT) == [(0, 25)] and minutes(log, WORK, ANA) == [(25, 27)]
    assert minutes(log, OFF) == [(27, 60)]


def test_nobody_stays_for_what_those_on_duty_can_do(tmp_path):
    """Late begins when early ends, in whichever order their names stand."""
    over = ("early: {", "early: {overtime: {most: 15 min}, at_end: hand_over, ")
    for ben in ("ben", "abe"):
        log = worked(tmp_path, MANY, (BOTH[0], BOTH[1].replace("ben:", f"{ben}:")), over)
        ana, other = (ANA, BEN) if ben == "ben" else (BEN, ANA)
        assert minutes(log, WORK, ana) == [(0, 7), (7, 14), (14, 20)] and minutes(log, OFF, ana) == [(20, 60)]
        assert minutes(log, WORK, other)[:2] == [(20, 21), (21, 28)]


def test_nobody_stays_for_a_station_that_stays_closed(tmp_path):
    over = ("early: {", "early: {overtime: {most: 15 min}, ")
    log = worked(tmp_path, MANY, over, ("tasks: [weld]", "tasks: [weld], shift: early"))
    assert minutes(log, WORK) == [(0, 7), (7, 14), (14, 21)] and minutes(log, OFF, ANA) == [(21, 60)]


OVER = ("early: {", "early: {overtime: {most: 30 min}, ")


def test_nobody_stays_for_a_job_that_waits_for_somebody_who_is_gone(tmp_path):
    """Ana leaves hers at 5 min, and is back tomorrow."""
    short = ("late: {from: 06:20, to: 06:40}", "short: {from: 06:00, to: 06:05, at_end: resume}")
    two = ("ana: {shift: early, skills: {bench: 1.0}}",
           "ana: {shift: short, skills: {bench: 2.0}}, ben: {shift: early, "
           "skills: {bench: 1.0}}}\nallocation: {rule: best_skill")  # fmt: skip
    log = worked(tmp_path, "0,part", two, short, ("fixed: 7 min", "fixed: 14 min"), OVER)
    assert minutes(log, OFF, BEN) == [(20, 60)] and minutes(log, HELD, cause=AWAY) == [(5, 60)]


def test_who_has_another_post_is_not_counted_on(tmp_path):
    """Ben has the skill, and a rotation keeps him at the press."""
    two = ("{bench: 1.0}}}", "{bench: 1.0}}, ben: {skills: {bench: 1.0, press: 1.0}}}\n"
           "rotations: {one: {workers: [ben], posts: [[press], [bench]], every: 5 h}}")  # fmt: skip
    press = ("bench: {at: bay, tasks: [weld]}", "bench: {at: bay, tasks: [weld]}, press: {at: bay, tasks: [weld]}")
    route = ("part: {route: [bench]}", "part: {route: [bench]}, lid: {route: [press]}")
    log = worked(tmp_path, "0,part 0,part 0,part 0,part 0,lid", two, press, route, OVER)
    assert minutes(log, WORK, ANA) == [(0, 7), (7, 14), (14, 21), (21, 28)] and minutes(log, OFF, ANA) == [(28, 60)]


@pytest.mark.parametrize("kind", ["andon", "regular"])
def test_who_comes_to_a_line_only_when_called_is_not_counted_on(tmp_path, kind):
    """The line moves at 8, 16, 24 and 32 min; parts are done a minute before. Cem, where he is, works at it too."""
    line = "lines: {main: {kind: indexed, stations: [bench], takt: 8 min, andon: {workers: [ben], at: 7.9 min}}}"
    two = ("{bench: 1.0}}}", "{bench: 1.0}}, ben: {skills: {bench: 1.0}}}\n" + line)
    if kind == "regular":
        called = two[1].replace("workers: [ben]", "workers: [cem]")
        two = two[0], called.replace("ben: {", "cem: {skills: {bench: 1.0}}, ben: {")
    log = worked(tmp_path, "0,part 0,part 0,part 0,part", two, OVER)
    assert minutes(log, OFF, ANA)[0][0] == (32 if kind == "andon" else 23)


MILL = (
    ("weld: {fixed: 7 min}", "load: {fixed: 1 min}, mill: {fixed: RUN min, automatic: true}"),
    ("bench: {at: bay, tasks: [weld]}", "bench: {at: bay, tasks: [load, mill, load]}"),
)


@pytest.mark.parametrize(("run", "off_at"), [("48 min", 50), ("31 min", 33), ("49 min", 20)])
def test_nobody_stays_for_a_run_that_lasts_longer_than_his_overtime(tmp_path, run, off_at):
    """Overtime ends at 50 min: a run from 1 to 49 is unloaded in it, and one from 1 to 50 is not waited for."""
    load, mill = MILL
    load = load[0], load[1].replace("RUN min", run)
    assert minutes(worked(tmp_path, "0,part", load, mill, OVER), OFF) == [(off_at, 60)]
    behind = worked(tmp_path, "0,part 0,part", load, mill, OVER)  # who is behind it gets to the bench after it
    assert minutes(behind, OFF)[0][0] == {50: 50, 33: 34, 20: 20}[off_at]


@pytest.mark.parametrize(("shift", "off_at"), [("day", 20), ("late", 31)])
def test_nobody_stays_for_a_job_that_gets_stuck_on_its_way_to_him(tmp_path, shift, off_at):
    """The oven is done at 22 min. Where Ben is there, he files until 29, and Ana packs until 31; else nobody does."""
    tasks = "bake: {fixed: 22 min, automatic: true}, weld: {fixed: 7 min}, pack: {fixed: 2 min}"
    stations = "oven: {at: bay, tasks: [bake]}, file: {at: bay, tasks: [weld]}, bench: {at: bay, tasks: [pack]}"
    edits = (
        ("weld: {fixed: 7 min}", tasks),
        ("bench: {at: bay, tasks: [weld]}", stations),
        ("route: [bench]", "route: [oven, file, bench]"),
        ("{bench: 1.0}}}", f"{{bench: 1.0}}}}, ben: {{shift: {shift}, skills: {{file: 1.0}}}}}}"),
        OVER,
        ("late: {", "day: {from: 09:00, to: 10:00}, late: {"),
    )
    log = worked(tmp_path, "0,part", *edits)
    assert minutes(log, OFF, ANA)[0][0] == off_at


def test_a_break_that_ends_with_the_shift_sends_nobody_home_who_is_needed(tmp_path):
    tea = ("to: 06:20}, late", "to: 06:20, breaks: {tea: {at: 06:16, lasts: 4 min}}}, late")
    log = worked(tmp_path, "0,part 0,part 0,part 0,part", OVER, tea)
    assert minutes(log, WORK) == [(0, 7), (7, 14), (14, 16), (20, 25), (25, 32)] and minutes(log, BREAK) == [(16, 20)]
    assert minutes(log, OFF) == [(32, 60)]


def test_a_break_that_would_begin_after_the_shift_is_cut(tmp_path):
    """Ana finishes from 14 to 21 min: the break at 17 is owed at 20, when she is off, and never taken."""
    tea = "to: 06:20, at_break: finish, breaks: {tea: {at: 06:17, lasts: 2 min}}}"
    log = worked(tmp_path, MANY, ("to: 06:20}", tea))
    assert minutes(log, BREAK) == [] and minutes(log, WORK) == [(0, 7), (7, 14), (14, 21)]
    assert minutes(log, OFF) == [(21, 60)]


def test_a_break_goes_no_further_than_the_shift(tmp_path):
    """She is done at 14 min, two late, and would rest until 24."""
    tea = "to: 06:20, at_break: finish, breaks: {tea: {at: 06:10, lasts: 10 min}}}"
    log = worked(tmp_path, MANY, ("to: 06:20}", tea))
    assert minutes(log, BREAK) == [(14, 20)] and minutes(log, OFF) == [(20, 60)]


def test_the_rule_of_the_end_comes_after_that_of_a_break_he_never_got_to(tmp_path):
    tea = "to: 06:20, at_break: finish, at_end: resume, breaks: {tea: {at: 06:17, lasts: 2 min}}}"
    log = worked(tmp_path, MANY, ("to: 06:20}", tea))
    assert minutes(log, WORK) == [(0, 7), (7, 14), (14, 20)]


def test_shifts_that_follow_each_other_at_once_are_one_to_him(tmp_path):
    head = HEAD.replace("run: {start: Mon 06:00, horizon: 60 min}", "run: {start: Sun 23:30, horizon: 60 min}")
    night = ("early: {from: 06:00, to: 06:20}", "early: {from: 00:00, to: 24:00}")
    log = worked(tmp_path, MANY, night, at_end("resume"), head=head)
    assert minutes(log, OFF) == [] and len(minutes(log, FINISH)) == 8


def test_who_is_absent_leaves_what_he_began_to_others(tmp_path):
    """Ana misses one of her next shifts; the part she left comes to be done by Ben in it."""
    head = HEAD.replace("60 min", "6 d")
    both = ("{bench: 1.0}}}", "{bench: 1.0}, absence: 0.5}, ben: {shift: night, skills: {bench: 1.0}}}")
    night = ("late: {", "night: {from: 05:00, to: 05:02, at_end: resume}, late: {")
    log = worked(tmp_path, MANY, both, night, at_end("resume"), head=head)
    missed = minutes(log, ABSENT, ANA)
    assert missed and all(end - begin == 20 for begin, end in missed)
    assert all(begin % 1440 == 0 for begin, _ in missed)
    assert not [piece for piece in minutes(log, WORK, ANA) for begin, end in missed if begin <= piece[0] < end]
    assert minutes(log, WORK, BEN)


def test_who_misses_a_shift_that_follows_at_once_finishes_and_is_absent_from_the_rest_of_it(tmp_path):
    """A shift around the clock, and parts of 7 min: 1435 to 1442 min is the last one of a day."""
    around = ("early: {from: 06:00, to: 06:20}", "early: {from: 06:00, to: 06:00}")
    absent = ("{shift: early,", "{shift: early, absence: 0.5,")
    head = HEAD.replace("60 min", "9 d")
    log = worked(tmp_path, " ".join(["0,part"] * 1200), absent, around, head=head)
    missed = minutes(log, ABSENT)
    assert all(end % 1440 == 0 for _, end in missed) and {begin % 1440 for begin, _ in missed} >= {0, 2}
    assert not [piece for piece in minutes(log, WORK) for begin, end in missed if begin <= piece[0] < end]


SHIFT = """
tasks: {assemble: {fixed: 7 min}}
stations: {bench: {at: bay, tasks: [assemble]}}
products: {part: {route: [bench]}}
shifts:
  day:
    from: 06:00
    to: 14:30
    breaks: {tea: {at: 08:00, lasts: 15 min}, lunch: {at: 10:00, lasts: 30 min}, coffee: {at: 12:30, lasts: 15 min}}
    at_break: RULE
    at_end: RULE
workers: {ana: {shift: day, skills: {bench: 1.0}}}
"""


@pytest.mark.parametrize(("rule", "jobs", "off_at"), [
    # 510 min with breaks from 120 to 135, 240 to 270, 390 to 405
    ("resume", 64, 510),  # floor(450 / 7) = 64, and 2 min of the next (known_answers.json)
    ("finish", 65, 515),  # 18 jobs to 126, break to 141; 15 to 246, to 276; 17 to 395, to 410; 15 to 515
    ("restart", 64, 510),  # 17, 15, 17 and 15 in stretches of 120, 105, 120 and 105 min; 1 min is lost twice
])  # fmt: skip
def test_a_shift_makes_as_many_jobs_as_by_hand(tmp_path, rule, jobs, off_at):
    head = HEAD.replace("60 min", "12 h")
    log = ran(tmp_path, SHIFT.replace("RULE", rule), MANY, head)
    assert (len(minutes(log, FINISH)), minutes(log, OFF)[0][0]) == (jobs, off_at)
