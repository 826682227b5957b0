"""Shifts, breaks and hours that cannot be: each refused with its place and the way out."""

from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

TEXT = """
opsim: 1
name: shifts
run: {horizon: 14 d}
layout: {places: {a: [0 m, 0 m], canteen: [5 m, 0 m]}}
shifts:
  early: {from: 06:00, to: 14:00, days: [Mon, Tue], overtime: {most: 2 h}}
  late: {like: early, from: 14:00, to: 22:00}
  night: {from: 22:00, to: 06:00, breaks: {meal: {at: 02:00, lasts: 30 min, place: canteen}}}
tasks: {t: {fixed: 10 min}}
stations: {s: {at: a, tasks: [t], shift: [early, late]}}
products: {p: {route: [s]}}
release: {kind: poisson, every: 15 min, shift: early}
workers:
  ana: {skills: {s: 1.0}, shift: [early, late]}
  ben: {skills: {s: 1.0}, shift: night}
"""


def read(*edits):
    text = TEXT
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return scenarios_in(text.encode(), Path("shifts.yaml"))["base"].scenario


def said(*edits):
    with pytest.raises(ScenarioError) as caught:
        read(*edits)
    return "\n".join(f"{p.line}: {p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


def test_clock_times_stand_without_quotes_and_days_in_any_order_and_length():
    scenario = read(("days: [Mon, Tue]", "days: [tuesday, MON, Friday]"), ("from: 14:00", "from: '14:00:30'"))
    early, late = scenario.shifts["early"], scenario.shifts["late"]
    assert (early.start_s, early.end_s, early.length_s) == (21600, 50400, 28800)
    assert early.days == late.days == ["Mon", "Tue", "Fri"] and late.start_s == 50430
    assert scenario.shifts["night"].length_s == 28800 and len(scenario.shifts["night"].days) == 7


def test_the_name_of_a_shift_is_a_list_of_one():
    scenario = read()
    assert scenario.workers["ben"].shift == ["night"] and scenario.stations["s"].shift == ["early", "late"]


@pytest.mark.parametrize(("old", "new", "answer"), [
    ("from: 06:00, to: 14:00", "from: 25:00, to: 14:00",
     "7: shifts.early.from: there is no '25:00' on the clock | a day goes from 00:00 to 24:00"),
    ("from: 06:00, to: 14:00", "from: 06:00, to: 14:60",
     "7: shifts.early.to: there is no '14:60' on the clock | a day goes from 00:00 to 24:00"),
    ("from: 06:00, to: 14:00", "from: 6, to: 14:00",
     "7: shifts.early.from: expected a time of the day, found 6 | such as 06:00"),
    ("from: 06:00, to: 14:00", "from: 840, to: 14:00",
     "7: shifts.early.from: expected a time of the day, found 840 | write '14:00'"),
    ("from: 06:00, to: 14:00", "from: 6 h, to: 14:00",
     "7: shifts.early.from: expected a time of the day, found '6 h' | such as 06:00"),
    ("from: 06:00, to: 14:00, ", "from: 06:00, until: 14:00, ",
     "7: shifts.early: 'to' is missing | add e.g. 'to: 14:00'\n"
     "7: shifts.early.until: unknown key 'until' | keys here: at_break, at_end, breaks, days, from, like, meetings, "
     "overtime, to"),
    ("days: [Mon, Tue]", "days: []",
     "7: shifts.early.days: there is no day in this list | name one, or remove the line: it is then every day"),
    ("days: [Mon, Tue]", "days: Mon-Fri",
     "7: shifts.early.days: expected a list of days, found 'Mon-Fri' | write [Mon, Tue, Wed, Thu, Fri]"),
    ("days: [Mon, Tue]", "days: fri to mon",
     "7: shifts.early.days: expected a list of days, found 'fri to mon' | write [Fri, Sat, Sun, Mon]"),
    ("days: [Mon, Tue]", "days: Sunday",
     "7: shifts.early.days: expected a list of days, found 'Sunday' | write [Sun]"),
    ("days: [Mon, Tue]", "days: [Mon, Teu]",
     "7: shifts.early.days[1]: expected a day of the week, found 'Teu' | did you mean 'Tue'?"),
    ("days: [Mon, Tue]", "days: [Mon, 2]",
     "7: shifts.early.days[1]: expected a day of the week, found 2 | days: Mon, Tue, Wed, Thu, Fri, Sat, Sun"),
    ("days: [Mon, Tue]", "days: [Mon, Tue, Monday]",
     "7: shifts.early.days[2]: Mon stands twice | remove one of them"),
    ("overtime: {most: 2 h}", "overtime: 2 h",
     "7: shifts.early.overtime: expected a block of keys, found '2 h' | write {most: 2 h}"),
    ("overtime: {most: 2 h}", "at_end: resumee",
     "7: shifts.early.at_end: expected finish, finish_job, resume, resume_any, hand_over or restart, found 'resumee' | "
     "did you mean 'resume'?"),
    ("like: early, from", "like: erly, from",
     "8: shifts.late.like: no 'erly' among the shifts | did you mean 'early'?"),
])  # fmt: skip
def test_hours_that_cannot_be(old, new, answer):
    assert said((old, new)) == answer


MEAL = "meal: {at: 02:00, lasts: 30 min, place: canteen}"


@pytest.mark.parametrize(("breaks", "answer"), [
    ("meal: {at: 02:00, lasts: 30 min, place: cantine}",
     "9: shifts.night.breaks.meal.place: no place 'cantine' | did you mean 'canteen'?"),
    ("meal: {at: 21:59, lasts: 30 min}",
     "9: shifts.night.breaks.meal.at: 21:59 is outside the shift, 22:00 to 06:00 | begin it from 22:00 to 05:30"),
    ("meal: {at: 06:00, lasts: 30 min}",
     "9: shifts.night.breaks.meal.at: 06:00 is outside the shift, 22:00 to 06:00 | begin it from 22:00 to 05:30"),
    ("meal: {at: 05:31, lasts: 30 min}",
     "9: shifts.night.breaks.meal.at: goes on until 06:01, beyond the shift, 22:00 to 06:00 | begin it at 05:30 or "
     "before, or make it shorter"),
    ("meal: {at: 22:00, lasts: 9 h}",
     "9: shifts.night.breaks.meal.lasts: lasts 540 min, and the whole shift 480 min | make it shorter"),
    ("meal: {at: 22:00, lasts: 8 h}",
     "9: shifts.night.breaks: breaks and meetings take all of the shift (480 min on Mon) | make 'lasts' shorter"),
    ("meal: {at: 23:00, lasts: 2 h}, nap: {at: 00:59, lasts: 30 min}",
     "9: shifts.night.breaks.nap.at: begins before meal is over, at 01:00 | nobody is in two places at once"),
    ("meal: {at: 02:00, lasts: 0 min}",
     "9: shifts.night.breaks.meal.lasts: must be more than 0 s, found '0 min' | such as '45 s'"),
    ("meal: {at: 02:00}",
     "9: shifts.night.breaks.meal: 'lasts' is missing | add e.g. 'lasts: 15 min'"),
    ("meal: {at: 02:00, lasts: 30 min, days: [Mon, Mun]}",
     "9: shifts.night.breaks.meal.days[1]: expected a day of the week, found 'Mun' | did you mean 'Mon'?"),
])  # fmt: skip
def test_breaks_that_cannot_be(breaks, answer):
    assert said((MEAL, breaks)) == answer


def test_breaks_that_touch_or_come_on_other_days_are_good():
    touching = f"{MEAL}, nap: {{at: 02:30, lasts: 30 min}}, end: {{at: 05:30, lasts: 30 min}}"
    assert len(read((MEAL, touching)).shifts["night"].breaks) == 3
    other_days = "meal: {at: 02:00, lasts: 1 h, days: [Mon]}, nap: {at: 02:30, lasts: 1 h, days: [Tue]}"
    assert len(read((MEAL, other_days)).shifts["night"].breaks) == 2


def test_a_meeting_during_a_break_or_on_a_day_without_the_shift_is_refused():
    meeting = (
        "days: [Mon, Tue]",
        "days: [Mon, Tue], breaks: {tea: {at: 09:00, lasts: 20 min}}, meetings: {m: {at: 09:10, lasts: 5 min}}",
    )
    assert "7: shifts.early.meetings.m.at: begins before tea is over, at 09:20 |" in said(meeting)
    sunday = "days: [Mon, Tue]", "days: [Mon, Tue], meetings: {m: {at: 09:10, lasts: 5 min, days: [Mon, Sun]}}"
    assert "7: shifts.early.meetings.m.days: the shift does not begin on Sun | days of this shift: Mon, Tue" in said(
        sunday
    )


@pytest.mark.parametrize(("old", "new", "answer"), [
    ("shift: night", "shift: nite",
     "16: workers.ben.shift: no shift 'nite' | did you mean 'night'?"),
    ("shift: night", "shift: [night, nite]",
     "16: workers.ben.shift[1]: no shift 'nite' | did you mean 'night'?"),
    ("shift: night", "shift: []",
     "16: workers.ben.shift: there is no shift in this list | name one, or remove the line"),
    ("shift: night", "shift: 3",
     "16: workers.ben.shift: expected a shift or a list of shifts, found 3 | such as early, or [early, late]"),
    ("tasks: [t], shift: [early, late]", "tasks: [t], shift: [early, lat]",
     "11: stations.s.shift[1]: no shift 'lat' | did you mean 'late'?"),
    ("tasks: [t], shift: [early, late]", "tasks: [t], at_close: stop",
     "11: stations.s.at_close: expected finish or resume, found 'stop' | "),
    ("15 min, shift: early", "15 min, shift: eraly",
     "13: release.shift: no shift 'eraly' | did you mean 'early'?"),
])  # fmt: skip
def test_shifts_that_do_not_exist(old, new, answer):
    assert said((old, new)) == answer


def test_without_shifts_the_way_to_one_is_told():
    start, end = TEXT.index("shifts:"), TEXT.index("tasks:")
    text = TEXT[:start] + TEXT[end:]
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("shifts.yaml"))
    assert caught.value.problems[0].hint == "add a section 'shifts: {early: {from: 06:00, to: 14:00}}'"
    assert len(caught.value.problems) == 6


def test_nobody_is_in_two_shifts_at_once_from_one_week_to_the_next():
    dawn = "  night:", "  dawn: {from: 05:00, to: 09:00, days: [Mon]}\n  night:"
    assert said(dawn, ("shift: night", "shift: [night, dawn]")) == (
        "17: workers.ben.shift: night ends Mon 06:00, and dawn begins Mon 05:00 already | "
        "nobody works two shifts at once"
    )
    assert said(dawn, ("shift: night", "shift: [dawn, night]")).startswith("17: workers.ben.shift: night ends Mon")
    read(dawn, ("shift: night", "shift: [early, dawn]"))


def test_overtime_ends_before_the_next_shift_begins():
    assert said(("to: 06:00, breaks", "to: 06:00, overtime: {most: 17 h}, breaks")) == (
        "9: shifts.night.overtime.most: overtime may last until Tue 23:00, and night begins Tue 22:00 | "
        "at most 16 h are left"
    )
    read(("to: 06:00, breaks", "to: 06:00, overtime: {most: 16 h}, breaks"))


def test_defaults_and_likes_hold_for_shifts():
    scenario = read(("opsim: 1", "opsim: 1\ndefaults: {shifts: {at_end: hand_over}}"))
    assert {name: shift.at_end for name, shift in scenario.shifts.items()} == dict.fromkeys(
        ["early", "late", "night"], "hand_over"
    )
    assert scenario.shifts["late"].overtime.most_s == 7200


@pytest.mark.parametrize(("old", "new", "answer"), [
    ("shift: night}", "shift: [night, night]}",
     "16: workers.ben.shift: 'night' follows itself, week by week | write night alone"),
    ("most: 2 h", "most: 30 h",
     "7: shifts.early.overtime.most: must be at most 24 h, found 30 h | give it in hours, such as 2 h"),
    ("shift: night}", "shift: night, absence: 5 %}",
     "16: workers.ben.absence: expected a probability, found '5 %' | write 0.05"),
    ("from: 22:00, to", "from: 10 pm, to",
     "9: shifts.night.from: expected a time of the day, found '10 pm' | write 22:00"),
    ("from: 22:00, to", "from: 12:30am, to",
     "9: shifts.night.from: expected a time of the day, found '12:30am' | write 00:30"),
    ("days: [Mon, Tue]", "days: [Mon, Tues, 3]",
     "7: shifts.early.days[1]: expected a day of the week, found 'Tues' | did you mean 'Tue'?\n"
     "7: shifts.early.days[2]: expected a day of the week, found 3 | days: Mon, Tue, Wed, Thu, Fri, Sat, Sun"),
    ("late: {like: early, from: 14:00, to: 22:00}", "late: {like: erly}",
     "8: shifts.late.like: no 'erly' among the shifts | did you mean 'early'?"),
    ("late: {like: early, from: 14:00, to: 22:00}", "late: [14:00, 22:00]",
     "8: shifts.late: expected a block of keys, found a list of 2 | such as {from: 06:00, to: 14:00}"),
    ("breaks: {meal: {at: 02:00, lasts: 30 min, place: canteen}}", "breaks: [02:00]",
     "9: shifts.night.breaks: expected a block of names, found a list of 1 | such as {lunch: {at: '11:00', "
     "lasts: 30 min}}, or remove the line"),
    ("shift: night}", "shift: night, floater: maybe}",
     "16: workers.ben.floater: expected true or false, found 'maybe' | without the line it is false"),
    ("shift: night}", "shift: night, zone: []}",
     "16: workers.ben.zone: expected at least one entry, found none | such as [pack, label], or remove the line"),
    ("shift: night}", "shift: night}\ncrews: []",
     "17: crews: expected a block of names, found an empty list | such as {line: {kind: bucket_brigade, "
     "stations: [a, b, c], workers: [slow, fast]}}, or remove the line"),
    ("shift: night}", "shift: night}\nrotations: {r: {workers: [ana], posts: [s], after: 2.5}}",
     "17: rotations.r.posts: expected at least 2 entries, found 1 | such as [pack, label, [lift, stack]]\n"
     "17: rotations.r.after: expected a whole number, found 2.5 | write 2 or 3"),
    ("shift: night}", "shift: night}\nrotations: {r: {workers: [ana, ben], posts: [s, s], after: 1e3}}",
     "17: rotations.r.after: expected a whole number, found 1000.0 | write 1000"),
    ("{fixed: 10 min}", "{dist: lognormal, mean: 10 min, cv: 0.3, between_share: 40%}",
     "10: tasks.t.between_share: expected a number, found '40%' | write 0.4"),
    ("workers:\n", "wrkers:\n", "14: wrkers: unknown key 'wrkers' | did you mean 'workers'?"),
    ("stations: {s: {at: a, tasks: [t], shift: [early, late]}}", "stations: [{at: a, tasks: [t]}]",
     "11: stations: expected a block of names, found a list of 1 | such as {pack: {at: bench, tasks: [label]}}"),
    ("tasks: {t: {fixed: 10 min}}", "tasks: null",
     "10: tasks: expected a block of names, found nothing | fill it, or remove the line"),
])  # fmt: skip
def test_one_mistake_is_told_once_with_the_way_out(old, new, answer):
    assert said((old, new)) == answer


def test_a_turn_of_weeks_may_name_a_shift_twice_beside_another():
    assert read(("shift: night", "shift: [night, night, early]")).workers["ben"].shift == ["night", "night", "early"]
