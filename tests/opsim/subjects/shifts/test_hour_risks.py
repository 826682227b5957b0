# ruff: noqa: E501
"""What ``opsim check`` says of hours: each warning appears where it should, and not where all is well."""

from plans import plan

from opsim.plan.warnings import hour_risks

DAY = """
opsim: 1
name: Hours
run: {start: Mon 06:00, horizon: 16 h}
layout: {places: {here: [0 m, 0 m]}}
shifts:
  early: {from: '06:00', to: '14:00', breaks: {lunch: {at: '10:00', lasts: 30 min}}}
  early2: {from: '06:00', to: '14:00', breaks: {lunch: {at: '10:30', lasts: 30 min}}}
  late: {from: '14:00', to: '22:00'}
tasks: {hand: {fixed: 36 s}, do: {fixed: 36 s, automatic: true}}
stations:
  cut: {at: here, tasks: [hand], buffer: 10}
  oven: {at: here, tasks: [do], buffer: 10}
  pack: {at: here, tasks: [hand], buffer: 10}
products: {a: {route: [cut, oven, pack]}}
release: {kind: poisson, every: 72 s}
workers:
  ana: {shift: early, skills: {cut: 1, pack: 1}}
  ben: {shift: early2, skills: {cut: 1, pack: 1}}
  cem: {shift: late, skills: {cut: 1, pack: 1}}
  dan: {shift: late, skills: {cut: 1, pack: 1}}
"""


def risks(*edits):
    text = DAY
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return hour_risks(plan(text))


def test_where_all_is_well_nothing_is_said():
    assert risks() == []


# ------------------------------------------------------------------------------------------------- nobody with the skill
def test_a_skill_that_nobody_has_on_a_shift_is_told():
    late = [
        (f"{name}: {{shift: late, skills: {{cut: 1, pack: 1}}", f"{name}: {{shift: late, skills: {{cut: 1}}")
        for name in ("cem", "dan")
    ]
    assert risks(*late) == [
        "nobody on shift late can work at pack: it stands for 8 h of the run in which others work (50% of the time that "
        "it is open)"
    ]
    assert risks(late[0]) == []


def test_stations_of_jobs_beside_those_that_the_floor_lets_in_are_looked_at_too():
    products = "products: {a: {route: [cut, oven, pack]}}\nrelease: {kind: poisson, every: 72 s}"
    two = "products: {a: {route: [cut, oven]}, b: {route: [pack]}}\nsources: {now: {kind: %s, products: [a]}, b: {kind: poisson, every: 72 s, products: [b]}}"
    edits = [("{cut: 1, pack: 1}", "{cut: 1}"), ("workers:", "workers:\n  eve: {shift: night, skills: {pack: 1}}")]
    edits += [("shifts:", "shifts:\n  night: {from: '22:00', to: '06:00'}")]
    said = ["eve is never on shift in this run of 16 h"]
    said += ["nobody who can work at pack is ever on shift: nothing will happen there"]
    for kind in ("saturated", "poisson, every: 72 s"):
        assert risks((products, two % kind), *edits) == said


def test_hours_in_which_nobody_works_at_all_are_no_skill_that_is_missing():
    assert risks(("horizon: 16 h", "horizon: 24 h")) == []


def test_a_station_that_is_closed_meanwhile_misses_nobody():
    late = [("shift: late, skills: {cut: 1, pack: 1}", "shift: late, skills: {cut: 1}")]
    assert risks(*late, ("pack: {at: here,", "pack: {at: here, shift: early,")) == []


def test_a_team_that_is_too_small_on_a_shift_is_told():
    team = ("hand: {fixed: 36 s}", "hand: {fixed: 36 s, team: 2}")
    assert risks(team) == []
    one, two, breaks = risks(team, ("dan: {shift: late,", "dan: {shift: early,"))
    assert one.startswith("too few people on shift late can work at cut: it stands for 8 h") and "pack" in two
    assert breaks.startswith("breaks leave fewer than the 2 people that cut, the bottleneck, takes (ana, ben and dan)")


def test_people_who_never_meet_for_a_team_are_told():
    edits = [("\n  ben: {shift: early2, skills: {cut: 1, pack: 1}}", "\n  ben: {skills: {cut: 1}}")]
    edits += [("\n  dan: {shift: late, skills: {cut: 1, pack: 1}}", "")]
    edits += [("hand: {fixed: 36 s}", "hand: {fixed: 36 s}, lift: {fixed: 9 s, team: 2}")]
    said = risks(*edits, ("pack: {at: here, tasks: [hand]", "pack: {at: here, tasks: [lift]"))
    assert said == ["never 2 people at once who can work at pack are on shift: nothing will happen there"]


def test_hours_of_a_station_that_meet_nobodys_shift_are_told():
    night = ("  late: {", "  night: {from: '22:00', to: '06:00'}\n  late: {")
    edits = [night, ("horizon: 16 h", "horizon: 24 h"), ("pack: {at: here,", "pack: {at: here, shift: night,")]
    assert risks(*edits) == ["pack is open only when nobody is on shift who can work there: nothing will happen there"]
    assert risks(night, ("pack: {at: here,", "pack: {at: here, shift: late,")) == []


def test_a_station_that_never_opens_and_people_who_never_come_are_told():
    night = ("  late: {", "  night: {from: '22:00', to: '06:00'}\n  late: {")
    assert risks(night, ("pack: {at: here,", "pack: {at: here, shift: night,")) == [
        "pack is never open in this run of 16 h"
    ]
    assert risks(night, ("dan: {shift: late", "dan: {shift: night")) == ["dan is never on shift in this run of 16 h"]


def test_somebody_with_a_skill_who_never_comes_is_nobody():
    night = ("  late: {", "  night: {from: '22:00', to: '06:00'}\n  late: {")
    edits = [
        (f"{shift}, skills: {{cut: 1, pack: 1}}", f"{shift}, skills: {{cut: 1}}")
        for shift in ("early", "early2", "late")
    ]
    edits += [night, ("workers:", "workers:\n  eva: {shift: night, skills: {pack: 1}}")]
    assert "nobody who can work at pack is ever on shift: nothing will happen there" in risks(*edits)


def test_hours_of_a_source_that_meet_nobodys_shift_are_told():
    edits = [("every: 72 s}", "every: 72 s, shift: night}"), ("horizon: 16 h", "horizon: 24 h")]
    edits += [("  late: {", "  night: {from: '22:00', to: '06:00'}\n  late: {")]
    assert risks(*edits) == ["release lets jobs in only when nobody is there who works on them"]
    assert risks(("every: 72 s}", "every: 72 s, shift: early}")) == []


# --------------------------------------------------------------------------------------------------------------- breaks
BUSY = ("every: 72 s", "every: 40 s")


def test_breaks_of_all_people_of_the_bottleneck_at_once_are_told():
    one = (
        "early2: {from: '06:00', to: '14:00', breaks: {lunch: {at: '10:30'",
        "early2: {from: '06:00', to: '14:00', breaks: {lunch: {at: '10:00'",
    )
    hand = ("do: {fixed: 36 s, automatic: true}", "do: {fixed: 10 s, automatic: true}")
    (said,) = risks(BUSY, one, hand)
    assert said == (
        "all who are there and can work at cut, the bottleneck, have their breaks at once (ana and ben): it stands for "
        "30 min of the run; let them have breaks one after the other, or give the skill to somebody else who is there then"
    )
    assert risks(BUSY, hand) == []
    assert risks(one, hand) == []  # it has time to spare: jobs come every 72 s


def test_breaks_of_the_only_one_who_can_work_at_the_bottleneck_are_told():
    """Only ana is there in the morning, who cuts for 36 s each; jobs come every 40 s."""
    alone = [
        (f"\n  {name}: {{shift: {shift}, skills: {{cut: 1, pack: 1}}}}", "")
        for name, shift in (("ben", "early2"), ("cem", "late"), ("dan", "late"))
    ]
    edits = [
        *alone,
        ("horizon: 16 h", "horizon: 8 h"),
        ("tasks: [hand], buffer: 10}\nproducts", "tasks: [do], buffer: 10}\nproducts"),
    ]
    assert risks(
        BUSY, *edits, ("  early2: {from: '06:00', to: '14:00', breaks: {lunch: {at: '10:30', lasts: 30 min}}}\n", "")
    ) == [
        "nobody works at cut, the bottleneck, in the breaks of ana: it stands for 30 min of the run; give the skill to somebody else who is there then"
    ]


def test_breaks_in_which_the_bottleneck_runs_on_by_itself_are_not_told():
    """Runs of an hour, with a minute by hand: a break of half an hour costs next to nothing."""
    one = ("lunch: {at: '10:30'", "lunch: {at: '10:00'")
    edits = [
        one,
        ("do: {fixed: 36 s, automatic: true}", "do: {fixed: 60 min, automatic: true}"),
        ("every: 72 s", "every: 62 min"),
    ]
    edits += [("oven: {at: here, tasks: [do]", "oven: {at: here, tasks: [hand, do]")]
    edits += [("cut: 1, pack: 1}", "cut: 1, pack: 1, oven: 1}")]
    assert risks(*edits) == []
    by_hand = [(old, new.replace(", automatic: true", "")) for old, new in edits]
    (said,) = risks(*by_hand)
    assert said.startswith("all who are there and can work at oven, the bottleneck, have their breaks at once")


def test_breaks_in_front_of_the_bottleneck_that_last_longer_than_its_buffer_are_told():
    """Ten jobs of 40 s last 400 s, the break of all who cut 1,800 s; 60 places last 2,400 s."""
    one = ("lunch: {at: '10:30'", "lunch: {at: '10:00'")
    oven = ("do: {fixed: 36 s, automatic: true}", "do: {fixed: 40 s, automatic: true}")
    (said,) = risks(("every: 72 s", "every: 45 s"), one, oven)
    assert said == (
        "oven, the bottleneck, runs dry in the breaks of cut: all who can work there pause for 30 min at once, and the "
        "10 jobs that can wait in between last 6.67 min; let them have breaks one after the other, or give it a larger "
        "buffer"
    )
    room = ("oven: {at: here, tasks: [do], buffer: 10}", "oven: {at: here, tasks: [do], buffer: 60}")
    assert risks(("every: 72 s", "every: 45 s"), one, oven, room) == []
    assert risks(("every: 72 s", "every: 45 s"), oven) == []


# ------------------------------------------------------------------------------------------------------------ rotations
ROTATION = "rotations: {turn: {workers: [ana, ben, cem, dan], posts: [cut, pack], every: 2 h}}\nworkers:"


def test_a_rotation_with_enough_people_on_every_shift_is_well():
    assert risks(("workers:", ROTATION)) == []


def test_a_rotation_that_leaves_a_station_empty_on_a_shift_is_told():
    assert risks(("workers:", ROTATION), ("dan: {shift: late", "dan: {shift: early")) == [
        "rotation turn leaves cut and pack empty in 1 of its 2 turns while of its members cem is on shift alone (1 "
        "people for 2 posts)"
    ]


def test_somebody_else_with_the_skill_fills_an_empty_post():
    edits = [("workers:", ROTATION), ("dan: {shift: late", "dan: {shift: early")]
    assert risks(*edits, ("workers:\n", "workers:\n  eva: {shift: late, skills: {cut: 1, pack: 1}}\n")) == []


def test_more_posts_than_people_leave_each_of_them_empty_in_turn():
    posts = ("workers:", "rotations: {turn: {workers: [ana, ben], posts: [cut, pack, []], every: 2 h}}\nworkers:")
    edits = [("  cem: {shift: late, skills: {cut: 1, pack: 1}}\n  dan: {shift: late, skills: {cut: 1, pack: 1}}\n", "")]
    assert risks(posts, *edits, ("horizon: 16 h", "horizon: 8 h")) == [
        "rotation turn leaves cut and pack empty in 1 of its 3 turns (2 people for 3 posts)"
    ]


def test_a_post_whose_turn_comes_to_somebody_without_the_skill_goes_to_another():
    """ben cannot pack: ana is always there, and nothing is empty."""
    assert risks(("workers:", ROTATION), ("early2, skills: {cut: 1, pack: 1}", "early2, skills: {cut: 1}")) == []


# ------------------------------------------------------------------------------------------------- paced lines and crews
LINE = "lines: {final: {kind: indexed, stations: [cut, oven, pack], takt: 40 s}}\nworkers:"
NO_BUFFER = (", buffer: 10}", "}")


def test_a_paced_line_whose_work_fits_is_well():
    assert risks(("workers:", LINE), NO_BUFFER) == []


def test_work_beyond_the_takt_is_told_by_the_pace_of_those_who_do_it():
    slow = [
        (f"{shift}, skills: {{cut: 1, pack: 1}}", f"{shift}, skills: {{cut: 0.8, pack: 1}}")
        for shift in ("early", "early2", "late")
    ]
    assert risks(("workers:", LINE), NO_BUFFER, *slow) == [
        "cut does not keep the takt of line final: its work takes 45 s on average, and jobs come every 40 s: the line "
        "stands at every job, for 5 s on average"
    ]
    send = ("takt: 40 s", "takt: 30 s, unfinished: send_on")
    assert all(said.endswith("every job goes on unfinished") for said in risks(("workers:", LINE), NO_BUFFER, send))


def test_times_that_vary_about_the_takt_are_not_told_as_every_job():
    varied = ("hand: {fixed: 36 s}", "hand: {dist: gamma, mean: 44 s, cv: 0.3}")
    assert all("the line stands at many jobs, for 4 s" in said for said in risks(("workers:", LINE), NO_BUFFER, varied))


ANDON = """
opsim: 1
name: Andon
run: {horizon: 10 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 80 s}, u: {fixed: 30 s}}
stations: {s1: {at: here, tasks: [t]}, s2: {at: here, tasks: [u]}}
products: {p: {route: [s1, s2]}}
release: {kind: saturated}
workers: {a: {skills: {s1: 1}}, b: {skills: {s2: 1}}, j: {skills: {s1: 1, s2: 1}}}
lines: {l: {kind: indexed, stations: [s1, s2], takt: 60 s, andon: {workers: [j], at: 40 s, does: help}}}
"""


def test_help_that_is_enough_for_the_takt_is_not_told():
    """After 40 s of 80 two of them do the other half in 20 s, which makes 60 s."""
    assert hour_risks(plan(ANDON)) == []


def test_help_that_comes_too_late_is_told_with_what_is_left():
    (said,) = hour_risks(plan(ANDON.replace("at: 40 s", "at: 50 s")))
    assert said == (
        "s1 does not keep the takt of line l: its work takes 80 s on average, and 65 s with who is called after 50 s, "
        "and jobs come every 60 s: the line stands at every job, for 5 s on average"
    )


def test_who_takes_over_at_the_same_pace_makes_the_work_no_shorter():
    (said,) = hour_risks(plan(ANDON.replace("does: help", "does: take_over")))
    assert "who is called after 40 s makes it no shorter" in said and said.endswith("at every job, for 20 s on average")


def test_one_who_is_called_to_two_stations_all_the_time_is_told():
    """Called after 10 s of 80 he helps for 35 s, at two stations: 70 s of every 60."""
    two = ANDON.replace("u: {fixed: 30 s}", "u: {fixed: 80 s}")
    assert hour_risks(plan(two.replace("at: 40 s", "at: 10 s"))) == [
        "j is called to every job at s1 and s2 of line l, for 70 s in each takt of 60 s: call later, or give the line "
        "more people"
    ]
    assert hour_risks(plan(two)) == []


def test_a_line_with_a_station_that_nobody_mans_on_a_shift_is_told_once():
    late = [("shift: late, skills: {cut: 1, pack: 1}", "shift: late, skills: {cut: 1}")]
    assert risks(("workers:", LINE), NO_BUFFER, *late) == [
        "nobody on shift late can work at pack of line final: the line stands for 8 h of the run in which others work"
    ]


def test_who_comes_to_a_line_only_when_he_is_called_does_not_man_it():
    andon = ("takt: 40 s}", "takt: 40 s, andon: {workers: [cem, dan], at: 38 s}}")
    assert risks(("workers:", LINE), andon, NO_BUFFER) == [
        "nobody on shift late can work at cut and pack of line final: the line stands for 8 h of the run in which others work"
    ]


CREW = "crews: {brigade: {kind: bucket_brigade, stations: [cut, pack], workers: [ana, cem]}}\nworkers:"


def test_a_crew_that_is_there_on_every_shift_is_well_and_one_that_is_not_is_told():
    edits = [("products: {a: {route: [cut, oven, pack]}}", "products: {a: {route: [cut, pack]}}")]
    edits += [("workers:", CREW)]
    assert risks(*edits) == []
    assert risks(*edits, ("workers: [ana, cem]", "workers: [ana, ben]")) == [
        "nobody on shift late can work at cut and pack of crew brigade: nothing moves on it for 8 h of the run in which "
        "others work"
    ]


# ------------------------------------------------------------------------------------------------------- ends of shifts
CELL = """
opsim: 1
name: Ends of shifts
run: {start: Mon 06:00, horizon: 40 h}
layout: {places: {here: [0 m, 0 m]}}
shifts:
  early: {from: '06:00', to: '14:00', at_end: resume}
  late: {from: '14:00', to: '22:00'}
tasks: {job: {fixed: 10 min}}
stations: {m: {at: here, tasks: [job], buffer: 1}}
products: {p: {route: [m]}}
release: {kind: saturated}
workers: {a: {shift: early, skills: {m: 1}}, b: {shift: late, skills: {m: 1}}}
"""


def after(*edits):
    text = CELL
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return hour_risks(plan(text))


def test_work_that_waits_all_the_next_shift_for_who_began_it_is_told():
    assert after() == [
        "what is under way when shift early ends waits at m for who began it (rule resume), though b could go on with "
        "it: a is away for 16 h; write hand_over, resume_any or finish"
    ]
    assert "a is not back in this run" in after(("horizon: 40 h", "horizon: 16 h"))[0]


def test_work_for_which_nobody_else_comes_may_wait_for_who_began_it():
    assert after(("b: {shift: late", "b: {shift: early")) == []
    assert after(("at_end: resume}", "at_end: resume_any}")) == after(("at_end: resume}", "at_end: finish}")) == []
    assert after(("m: {at: here,", "m: {at: here, shift: early,")) == []


def test_a_task_with_a_rule_of_its_own_leaves_by_that():
    assert after(("fixed: 10 min", "fixed: 10 min, interruption: finish")) == []
    early = [("at_end: resume", "at_end: finish"), ("fixed: 10 min", "fixed: 10 min, interruption: resume")]
    (said,) = after(*early, ("horizon: 40 h", "horizon: 16 h"))
    assert "when shift early ends waits at m" in said


def test_a_hand_over_for_which_nobody_comes_is_told():
    edits = (("at_end: resume", "at_end: hand_over"), ("b: {shift: late", "b: {shift: early"))
    assert after(*edits) == [
        "nobody comes to whom shift early could hand over at its end, at m: who is at work there works on to the end of "
        "the task, which takes up to 10 min on average"
    ]
    assert after(edits[0]) == []
    assert after(*edits, ("fixed: 10 min", "fixed: 2 min")) == []


def test_breaks_of_two_shifts_are_not_told_as_breaks_at_once():
    """a and b are never there together: no order of their breaks would help."""
    edits = [("at_end: resume}", "breaks: {lunch: {at: '10:00', lasts: 30 min}}}")]
    edits += [("to: '22:00'}", "to: '22:00', breaks: {meal: {at: '18:00', lasts: 30 min}}}")]
    assert after(*edits, ("horizon: 40 h", "horizon: 16 h")) == [
        "nobody works at m, the bottleneck, in the breaks of a and of b: it stands for 60 min of the run; give the skill "
        "to somebody else who is there then"
    ]
