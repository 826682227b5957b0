"""Whatever somebody is at when his time comes: by hand arithmetic, in minutes."""

import pytest
from made.shops import ran
from opsim_minutes import minutes

from opsim.log import AWAY, BLOCKED, BREAK, HELD, NO_TOOL, NO_WORKER, OFF, SETUP, TEAM, TRANSPORT, WALK, WORK

HEAD = """
opsim: 1
name: leaving
run: {start: Mon 06:00, horizon: 60 min}
layout: {places: {bay: [0 m, 0 m], shed: [60 m, 0 m], canteen: [0 m, 60 m]}}
release: {kind: schedule, file: orders.csv}
"""
SHIFT = "shifts: {early: {from: 06:00, to: 14:00, breaks: {tea: {at: 06:06, lasts: 5 min}}, at_break: RULE}}\n"
ANA, BEN = 0, 1


def left(tmp_path, text, orders, rule="resume", *edits, head=HEAD):
    text = text + SHIFT.replace("RULE", rule)
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return ran(tmp_path, text, orders, head)


ALONE = """
tasks: {weld: {fixed: 10 min}}
stations: {bench: {at: bay, tasks: [weld]}}
products: {part: {route: [bench]}}
workers: {ana: {shift: early, walk: 1 m/s, skills: {bench: 1.0}}}
"""


def test_who_is_free_goes_at_once_and_comes_back_to_what_came_meanwhile(tmp_path):
    log = left(tmp_path, ALONE, "480,part")
    assert minutes(log, BREAK) == [(6, 11)] and minutes(log, WORK) == [(11, 21)]


def test_who_walks_home_walks_on_before_his_break(tmp_path):
    """He has welded at the bay until 5.5 min, and walks home for a minute."""
    text = ALONE.replace("walk: 1 m/s", "walk: 1 m/s, home: shed") + "allocation: {idle: home}\n"
    log = left(tmp_path, text.replace("10 min", "4.5 min"), "0,part")
    assert minutes(log, WALK) == [(0, 1), (5.5, 6.5)] and minutes(log, BREAK) == [(6.5, 11.5)]


def test_who_walks_to_a_job_walks_on_and_the_job_calls_for_somebody_else(tmp_path):
    """Ana sets out at 5.5 min; at 6 Ben, a minute away as well, is called: he begins at 7, she rests from 6.5 on."""
    text = ALONE.replace("walk: 1 m/s", "walk: 1 m/s, home: shed")
    text = text.replace("bench: 1.0}}}", "bench: 1.0}}, ben: {walk: 0.5 m/s, home: shed, skills: {bench: 1.0}}}")
    log = left(tmp_path, text + "allocation: {rule: nearest}\n", "330,part")
    assert minutes(log, WALK, ANA) == [(5.5, 6.5)] and minutes(log, BREAK, ANA) == [(6.5, 11.5)]
    assert minutes(log, WALK, BEN) == [(6, 8)] and minutes(log, WORK, BEN) == [(8, 18)]


def test_the_walk_to_where_a_break_is_spent_is_part_of_it_and_the_walk_back_is_not(tmp_path):
    log = left(tmp_path, ALONE, "0,part", "resume", ("lasts: 5 min", "lasts: 5 min, place: canteen"))
    assert minutes(log, WORK) == [(0, 6), (12, 16)]
    assert minutes(log, WALK) == [(6, 7), (11, 12)] and minutes(log, BREAK) == [(7, 11)]


def test_a_break_shorter_than_the_way_to_it_is_over_on_arrival(tmp_path):
    edit = ("lasts: 5 min", "lasts: 30 s, place: canteen")
    log = left(tmp_path, ALONE, "0,part", "resume", edit)
    assert minutes(log, WALK) == [(6, 7), (7, 8)] and minutes(log, BREAK) == []
    assert minutes(log, WORK) == [(0, 6), (8, 12)]


def test_breaks_that_begin_while_he_finishes_something_follow_each_other(tmp_path):
    two = ("{at: 06:06, lasts: 5 min}", "{at: 06:06, lasts: 5 min}, call: {at: 06:11, lasts: 2 min}")
    log = left(tmp_path, ALONE, "0,part 0,part", "finish", two)
    assert minutes(log, BREAK) == [(10, 15), (15, 17)] and minutes(log, WORK) == [(0, 10), (17, 27)]


def test_a_meeting_is_a_break_with_a_cause_of_its_own(tmp_path):
    log = left(tmp_path, ALONE, "0,part", "resume", ("breaks: {tea", "meetings: {board"))
    assert minutes(log, BREAK, cause=log.names["cause"].index("meeting")) == [(6, 11)]


def test_a_break_at_the_instant_in_which_another_one_ends_leaves_the_job_to_him(tmp_path):
    two = ("{at: 06:06, lasts: 5 min}", "{at: 06:06, lasts: 5 min}, call: {at: 06:11, lasts: 2 min}")
    log = left(tmp_path, ALONE, "0,part", "resume", two)
    assert minutes(log, WORK) == [(0, 6), (13, 17)] and minutes(log, HELD, cause=AWAY) == [(6, 13)]


def test_who_ends_his_task_as_the_break_begins_is_not_late(tmp_path):
    log = left(tmp_path, ALONE, "0,part 0,part", "finish", ("10 min", "6 min"))
    assert minutes(log, BREAK) == [(6, 11)] and minutes(log, WORK) == [(0, 6), (11, 17)]


def test_a_set_up_is_left_like_a_task(tmp_path):
    text = ALONE.replace("tasks: [weld]", "tasks: [weld], setup: {otherwise: 4 min, first: other}")
    text = text.replace("part: {route", "other: {route: [bench]}, part: {route")
    for rule, setups, work in (
        ("resume", [(4, 6), (11, 13)], [(13, 23)]),
        ("finish", [(4, 8)], [(13, 23)]),
        ("finish_job", [(4, 8)], [(8, 18)]),
        ("restart", [(4, 6), (11, 15)], [(15, 25)]),
    ):
        log = left(tmp_path, text, "240,part", rule)
        assert minutes(log, SETUP, ANA) == setups and minutes(log, WORK, ANA) == work


def test_an_attended_run_goes_on_where_it_was_with_whoever_comes(tmp_path):
    text = ALONE.replace("{fixed: 10 min}", "{fixed: 10 min, automatic: attended}")
    both = text.replace("1.0}}}", "1.0}}, ben: {skills: {bench: 0.5, other: 1.0}}}")
    both = both.replace("part: {", "else: {route: [other]}, part: {")
    both = both.replace("bench: {at", "other: {at: bay, tasks: [sit]}, bench: {at")
    both = both.replace("weld: {", "sit: {fixed: 7 min}, weld: {")
    for rule, ana, ben in (
        ("resume", [(0, 6), (11, 15)], []),
        ("resume_any", [(0, 6)], [(7, 11)]),
        ("hand_over", [(0, 7)], [(7, 10)]),
        ("restart", [(0, 6)], [(7, 17)]),
    ):
        log = left(tmp_path, both, "0,part 0,else", rule)
        assert minutes(log, WORK, ANA) == ana and minutes(log, WORK, BEN, 0) == ben


TEAM_OF_TWO = """
tasks: {lift: {fixed: 10 min, team: 2}}
stations: {ramp: {at: bay, tasks: [lift]}}
products: {part: {route: [ramp]}}
workers: {ana: {shift: early, skills: {ramp: 1.0}}, ben: {walk: 1 m/s, skills: {ramp: 0.5}}}
"""


@pytest.mark.parametrize(("rule", "lifted", "pause"), [
    ("finish", [(0, 20)], (10, 15)),  # Ana's part is done at 10 min, and she need not wait for Ben
    ("hand_over", [(0, 20)], (10, 15)),
    ("resume", [(0, 6), (11, 25)], (6, 11)),  # 0.7 of Ben's 20 min is left
    ("resume_any", [(0, 6), (11, 25)], (6, 11)),
    ("restart", [(0, 6), (11, 31)], (6, 11)),
])  # fmt: skip
def test_a_team_goes_on_together_or_breaks_off_together(tmp_path, rule, lifted, pause):
    log = left(tmp_path, TEAM_OF_TWO, "0,part", rule)
    assert minutes(log, WORK, -1) == lifted and minutes(log, BREAK, ANA) == [pause]


def test_a_third_one_steps_into_a_team_that_broke_off(tmp_path):
    log = left(tmp_path, TEAM_OF_TWO, "0,part", "resume", ("ben:", "cem: {skills: {ramp: 0.5}}, ben:"))
    assert minutes(log, WORK, -1) == [(0, 6), (6, 20.0)]


def test_a_team_that_waits_for_its_last_member_is_given_up(tmp_path):
    """Ben comes at 7 min; Ana, who has waited for him since 5, leaves at 6, and both begin when she is back."""
    text = TEAM_OF_TWO.replace("walk: 1 m/s", "walk: 0.5 m/s, home: shed")
    log = left(tmp_path, text, "300,part", "finish")
    assert minutes(log, HELD, cause=TEAM) == [(5, 6)] and minutes(log, HELD, cause=NO_WORKER) == [(6, 11)]
    assert minutes(log, WORK, -1) == [(11, 31)] and minutes(log, BREAK, ANA) == [(6, 11)]


def test_repeats_of_a_team_task_go_on_when_the_whole_team_is_back(tmp_path):
    edit = ("{fixed: 10 min, team: 2}", "{fixed: 4 min, team: 2, repeat: 2}")
    log = left(tmp_path, TEAM_OF_TWO, "0,part", "finish", edit)
    assert minutes(log, WORK, -1) == [(0, 8), (11, 19)] and minutes(log, BREAK, ANA) == [(6, 11)]


REPEATS = ("{fixed: 10 min, team: 2}", "{fixed: 4 min, team: 2, repeat: 2}")
NEXT = (
    ("{fixed: 10 min, team: 2}}", "{fixed: 4 min, team: 2}, turn: {fixed: 2 min, team: 2}, look: {fixed: 1 min}}"),
    ("tasks: [lift]", "tasks: [lift, turn, look]"),
)


def test_with_finish_job_a_team_stays_for_the_repeats_of_its_task(tmp_path):
    """Ana waits for Ben, who needs 8 min each time, and goes when both are done."""
    log = left(tmp_path, TEAM_OF_TWO, "0,part 0,part", "finish_job", REPEATS)
    assert minutes(log, WORK, -1)[:2] == [(0, 8), (8, 16)]
    assert minutes(log, WORK, ANA)[:2] == [(0, 4), (8, 12)] and minutes(log, BREAK, ANA) == [(16, 21)]
    assert minutes(log, WORK, -1)[2] == (21, 29)


def test_with_finish_job_a_team_stays_for_all_tasks_that_want_one(tmp_path):
    """The last task wants one alone: that is who was done last, Ben."""
    log = left(tmp_path, TEAM_OF_TWO, "0,part 0,part", "finish_job", *NEXT)
    assert minutes(log, WORK, -1)[:2] == [(0, 8), (8, 12)]
    assert minutes(log, BREAK, ANA) == [(12, 17)] and (12, 14) in minutes(log, WORK, BEN)


def test_who_stays_for_a_job_goes_on_with_it_though_another_one_has_waited_longer_for_a_team(tmp_path):
    """At 8, Cem is free, and the other job has waited since 0; but Ana and Ben go on with what they began."""
    other = (
        ("stations: {", "stations: {other: {at: bay, tasks: [lift]}, "),
        ("products: {", "products: {else: {route: [other]}, "),
        ("{ramp: 0.5}", "{ramp: 0.5, other: 1}}, cem: {skills: {other: 1}"),
    )
    log = left(tmp_path, TEAM_OF_TWO, "0,part 1,else", "finish_job", *NEXT, *other, ("06:06", "06:07"))
    of_team = log.where((log["worker"] == -1) & (log["station"] == 1))
    assert minutes(of_team, WORK, -1) == [(0, 8), (8, 12)] and minutes(log, BREAK, ANA) == [(12, 17)]


def test_with_finish_job_a_team_that_has_not_begun_is_given_up(tmp_path):
    text = TEAM_OF_TWO.replace("walk: 1 m/s", "walk: 0.5 m/s, home: shed")
    log = left(tmp_path, text, "300,part", "finish_job")
    assert minutes(log, BREAK, ANA) == [(6, 11)] and minutes(log, WORK, -1) == [(11, 31)]


HELD_TOOL = """
tools: {gun: {n: 1}}
tasks: {bolt: {fixed: 10 min, hold: {tool: gun, from: 0.5, to: 0.8}}}
stations: {bench: {at: bay, tasks: [bolt]}, other: {at: bay, tasks: [bolt]}}
products: {part: {route: [bench]}, else: {route: [other]}}
workers: {ana: {shift: early, skills: {bench: 1.0}}, ben: {skills: {other: 1.0}}}
"""


def test_a_tool_in_the_hands_is_put_back_and_taken_up_again(tmp_path):
    """Ana has the gun from 5 to 6 min; Ben, a minute behind, from 6 to 9; she has it again from 11 to 13."""
    log = left(tmp_path, HELD_TOOL, "0,part 60,else", "resume")  # Ben waits for no time at all
    tool = log.names["kind"].index("tool")
    assert minutes(log, tool) == [(5, 6), (6, 9), (11, 13)]
    assert minutes(log, WORK, ANA) == [(0, 6), (11, 15)] and minutes(log, WORK, BEN) == [(1, 6), (6, 11)]


@pytest.mark.parametrize(("rule", "ana", "pause", "waits"), [
    ("finish", [(1, 6), (8, 13)], (13, 18), [(6, 8)]),
    ("resume", [(1, 6), (12, 17)], (7, 12), [(6, 7)]),
    ("restart", [(1, 6), (12, 22)], (7, 12), [(6, 7)]),
])  # fmt: skip
def test_who_waits_for_a_tool_waits_on_or_goes(tmp_path, rule, ana, pause, waits):
    """Ben has the gun from 5 to 8 min; Ana wants it from 6 min on, and her break comes at 7."""
    log = left(tmp_path, HELD_TOOL, "0,else 60,part", rule, ("06:06", "06:07"))
    assert minutes(log, WORK, ANA) == ana and minutes(log, BREAK, ANA) == [pause]
    assert minutes(log, HELD, cause=NO_TOOL) == waits


def test_tools_of_a_task_go_back_in_a_break_and_are_taken_again_after_it(tmp_path):
    text = HELD_TOOL.replace("hold: {tool: gun, from: 0.5, to: 0.8}", "needs: {gun: 1}")
    log = left(tmp_path, text, "0,part 60,else", "resume")
    assert minutes(log, WORK, ANA) == [(0, 6), (16, 20)] and minutes(log, WORK, BEN) == [(6, 16)]


def test_tools_pass_to_who_takes_over(tmp_path):
    text = HELD_TOOL.replace("hold: {tool: gun, from: 0.5, to: 0.8}", "needs: {gun: 1}")
    text = text.replace("{other: 1.0}", "{bench: 1.0, other: 1.0}")
    log = left(tmp_path, text, "0,part", "hand_over")
    assert minutes(log, WORK, ANA) == [(0, 6)] and minutes(log, WORK, BEN) == [(6, 10)]
    assert minutes(log, log.names["kind"].index("tool")) == [(0, 10)]


FLOW = """
tasks: {weld: {fixed: 2 min}, bake: {fixed: 20 min, automatic: true}}
stations: {bench: {at: bay, tasks: [weld]}, oven: {at: shed, tasks: [bake], buffer: 0}}
products: {part: {route: [bench, oven]}}
workers: {ana: {shift: early, walk: 1 m/s, skills: {bench: 1.0}}}
"""


def test_who_stands_by_a_blocked_job_leaves_it_and_need_not_come_back(tmp_path):
    """The first part is baked from 2 to 22 min; Ana is done with the second at 4."""
    log = left(tmp_path, FLOW + "allocation: {when_blocked: held}\n", "0,part 0,part 0,part")
    assert minutes(log, BREAK) == [(6, 11)] and minutes(log, BLOCKED)[:1] == [(4, 22)]
    assert minutes(log, WORK, ANA) == [(0, 2), (2, 4), (22, 24)]


def test_who_has_to_carry_a_blocked_job_puts_it_down_and_comes_back_for_it(tmp_path):
    """Ana carries the first part from 2 to 3 min, is back at the bench at 4, and done with the second at 6, which is
    her break; the oven is free at 23.
    """
    text = FLOW.replace("route: [bench, oven]", "route: [bench, oven], carried: true")
    log = left(tmp_path, text, "0,part 0,part", "resume", ("bake: {fixed: 20 min", "bake: {fixed: 5 min"))
    assert minutes(log, WORK, ANA) == [(0, 2), (4, 6)] and minutes(log, BREAK) == [(6, 11)]
    assert minutes(log, TRANSPORT) == [(2, 3), (11, 12)] and minutes(log, BLOCKED) == [(6, 11)]


HANDS = """
tasks: {weld: {fixed: 2 min}, trim: {fixed: 1 min}, bake: {fixed: 17 min, automatic: true}}
stations:
  bench: {at: bay, tasks: [weld]}
  oven: {at: shed, tasks: [bake], buffer: 0}
  vice: {at: shed, tasks: [trim]}
products: {part: {route: [bench, oven], carried: true}, lid: {route: [vice]}}
workers:
  ana: {shift: early, walk: 1 m/s, skills: {bench: 1.0}}
  ben: {shift: late, walk: 1 m/s, home: shed, skills: {bench: 1.0, vice: 1.0}}
  cem: {shift: late, walk: 0.5 m/s, home: shed, skills: {bench: 1.0}}
  dan: {walk: 2 m/s, home: bay, skills: {vice: 1.0}}
shifts: {early: {from: 06:00, to: 06:07}, late: {from: 06:07, to: 14:00}}
allocation: {rule: nearest}
"""


@pytest.mark.parametrize(("near", "far"), [("ben", "cem"), ("cem", "ben")])
def test_a_carried_job_is_carried_on_by_who_is_there_when_its_carrier_has_gone_home(tmp_path, near, far):
    """Ana carries the first part from 2 to 3 min, is done with the second at 6, and off at 7. The oven is full until
    20 min; then Ben, a minute away, comes for it, not Cem, who is two, nor Dan, who cannot serve the bench.
    """
    text = (
        HANDS.replace("ben:", "near:").replace("cem:", "far:").replace("near:", f"{near}:").replace("far:", f"{far}:")
    )
    log = ran(tmp_path, text, "0,part 0,part 600,lid", HEAD)
    comes = log.names["worker"].index(near)
    assert minutes(log, TRANSPORT) == [(2, 3), (21, 22)] and minutes(log, BLOCKED) == [(6, 21)]
    assert (20, 21) in minutes(log, WALK, comes) and (21, 22) in minutes(log, WALK, comes)
    assert minutes(log, WORK, comes) == [(10, 11)]  # nobody is bound to a job that cannot move


def test_a_carried_job_waits_through_the_break_of_who_has_gone_for_it(tmp_path):
    """Ben sets out at 20 min, has his break at 20.5, and goes on from the bay, where he has come at 21, at 25.5."""
    text = HANDS.replace("to: 14:00}", "to: 14:00, breaks: {tea: {at: 06:20:30, lasts: 270 s}}}")
    text = text.replace("  cem: {shift: late, walk: 0.5 m/s, home: shed, skills: {bench: 1.0}}\n", "")
    log = ran(tmp_path, text, "0,part 0,part", HEAD)
    assert minutes(log, BREAK, BEN) == [(21, 25.5)] and minutes(log, TRANSPORT) == [(2, 3), (25.5, 26.5)]


def test_a_carried_job_is_for_others_when_the_shift_ends_in_the_break_of_its_carrier(tmp_path):
    text = HANDS.replace("to: 06:07}", "to: 06:07, breaks: {tea: {at: 06:06:30, lasts: 30 s}}}", 1)
    log = ran(tmp_path, text.replace("rule: nearest", "rule: oldest_job"), "0,part 0,part", HEAD)
    assert minutes(log, BREAK, ANA) == [(6.5, 7)] and minutes(log, BLOCKED) == [(6, 21)]


def test_who_has_to_carry_a_job_stays_in_overtime_where_nobody_else_can(tmp_path):
    text = FLOW.replace("route: [bench, oven]", "route: [bench, oven], carried: true").replace("20 min", "17 min")
    text += "shifts: {early: {from: 06:00, to: 06:07, overtime: {most: 30 min}}}\n"
    log = ran(tmp_path, text, "0,part 0,part", HEAD)
    assert minutes(log, TRANSPORT) == [(2, 3), (20, 21)] and minutes(log, OFF, ANA) == [(21, 60)]


def test_who_carries_brings_it_there_first(tmp_path):
    text = FLOW.replace("route: [bench, oven]", "route: [bench, oven], carried: true")
    log = left(tmp_path, text, "210,part", "resume")
    assert minutes(log, TRANSPORT) == [(5.5, 6.5)] and minutes(log, BREAK) == [(6.5, 11.5)]


def test_who_patrols_walks_on_to_his_next_stop_and_goes_on_round_from_there(tmp_path):
    text = ALONE.replace("bench: {at", "yard: {at: shed, tasks: [weld]}, bench: {at")
    text = text.replace("{bench: 1.0}", "{bench: 1.0, yard: 1.0}, patrol: [bench, yard]")
    log = left(tmp_path, text + "allocation: {idle: patrol}\n", "300,part", "resume", ("06:06", "06:04:30"))
    assert minutes(log, WALK)[:6] == [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (10, 11)]
    assert minutes(log, BREAK) == [(5, 10)] and minutes(log, WORK) == [(11, 21)]


def test_a_station_that_breaks_down_while_its_worker_is_away_goes_on_after_the_repair(tmp_path):
    """It stands from 8 to 13 min. Ana is back at 11."""
    jam = "tasks: [weld], maintenance: {oil: {every: 100 h, first: 8 min, lasts: 5 min, when: at_once}}"
    log = left(tmp_path, ALONE, "0,part", "resume", ("tasks: [weld]", jam))
    assert minutes(log, WORK, ANA) == [(0, 6), (13, 17)]
    assert minutes(log, HELD) == [(6, 11), (11, 13)]


def test_a_job_that_is_pre_empted_while_its_worker_is_away_is_for_anybody(tmp_path):
    """The urgent part comes at 8 min and is Ben's; the first has its server back at 18, and Ana goes on with it."""
    text = ALONE.replace("tasks: [weld]", "tasks: [weld], preempt: resume")
    text = text.replace("part: {route", "top: {route: [bench], priority: 2}, part: {route")
    text = text.replace("1.0}}}", "1.0}}, ben: {shift: late, skills: {bench: 1.0}}}")
    late = ("shifts: {", "shifts: {late: {from: 06:07, to: 14:00}, ")
    log = left(tmp_path, text, "0,part 480,top", "resume", late)
    assert minutes(log, WORK, ANA) == [(0, 6), (18, 22)] and minutes(log, WORK, BEN) == [(8, 18)]


def test_a_shift_that_ends_at_the_horizon_ends_nothing(tmp_path):
    head = HEAD.replace("horizon: 60 min", "horizon: 8 min")
    short = ("to: 14:00, breaks: {tea: {at: 06:06, lasts: 5 min}}", "to: 06:08")
    log = left(tmp_path, ALONE, "0,part", "finish", short, head=head)
    assert minutes(log, WORK) == [(0, 8)] and minutes(log, OFF) == []
