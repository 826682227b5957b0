"""Weekly patterns laid on the time of a run: duties, breaks and open times, to the second by hand."""

from itertools import pairwise

import pytest
from plans import plan

from opsim.plan.calendar import next_open

H, DAY = 3600.0, 86400.0
TEXT = """
opsim: 1
name: calendar
run: {start: Mon 06:00, horizon: 14 d}
layout: {places: {a: [0 m, 0 m], canteen: [5 m, 0 m]}}
shifts:
  early: {from: 06:00, to: 14:00, days: [Mon, Tue, Wed, Thu, Fri], overtime: {most: 90 min}, at_break: hand_over,
          breaks: {lunch: {at: 11:00, lasts: 30 min, place: canteen}, coffee: {at: 08:00, lasts: 15 min}},
          meetings: {board: {at: 06:00, lasts: 10 min, days: [Mon]}}}
  late: {from: 14:00, to: 22:00, days: [Mon, Tue, Wed, Thu, Fri]}
  night: {from: 22:00, to: 06:00, breaks: {meal: {at: 02:00, lasts: 30 min}}}
tasks: {t: {fixed: 10 min}}
stations: {s: {at: a, tasks: [t], shift: [late, early]}, u: {at: a, tasks: [t]}}
products: {p: {route: [s, u]}}
release: {kind: poisson, every: 15 min, shift: night}
workers:
  ana: {skills: {s: 1.0, u: 1.0}, shift: SHIFT}
  ben: {skills: {s: 1.0, u: 1.0}}
"""


def duties(shift, *edits, text=TEXT):
    for old, new in (("SHIFT", shift), *edits):
        assert old in text, old
        text = text.replace(old, new)
    return plan(text).workers[0].duties


def hours(duty):
    return duty.start_s / H, duty.end_s / H


def pauses(duty):
    return [(one.name, one.start_s / H, one.end_s / H) for one in duty.pauses]


def test_who_has_no_shift_is_always_there():
    assert plan(TEXT.replace("SHIFT", "early")).workers[1].duties is None


def test_a_shift_comes_on_its_days_week_after_week():
    found = duties("early")
    assert [hours(one) for one in found] == [(24 * day, 24 * day + 8) for day in (0, 1, 2, 3, 4, 7, 8, 9, 10, 11)]
    assert [one.number for one in found] == list(range(10)) and {one.shift for one in found} == {0}
    assert not any(one.cut for one in found)


def test_breaks_and_meetings_stand_in_order_of_time_at_their_places():
    first, second = duties("early")[:2]
    assert pauses(first) == [("board", 0, 1 / 6), ("coffee", 2, 2.25), ("lunch", 5, 5.5)]
    assert pauses(second) == [("coffee", 26, 26.25), ("lunch", 29, 29.5)]
    assert [one.meeting for one in first.pauses] == [True, False, False]
    assert [one.place for one in first.pauses] == [-1, -1, 1]


def test_several_shifts_follow_each_other_week_by_week_from_that_of_the_start():
    found = duties("[early, late]")
    assert [one.shift for one in found] == [0] * 5 + [1] * 5
    assert hours(found[5]) == (7 * 24 + 8, 7 * 24 + 16)
    thursday = duties("[early, late]", ("Mon 06:00", "Thu 06:00"))
    assert [one.shift for one in thursday] == [0, 0, 1, 1, 1, 1, 1, 0, 0, 0]
    assert hours(thursday[2]) == (4 * 24 + 8, 4 * 24 + 16)
    assert [one.shift for one in duties("[late, late, early]", ("14 d", "28 d"))] == [1] * 10 + [0] * 5 + [1] * 5


def test_a_night_shift_ends_on_the_next_day_and_belongs_to_the_one_on_which_it_begins():
    found = duties("night", ("02:00, lasts: 30 min", "02:00, lasts: 30 min, days: [Tue]"))
    assert hours(found[0]) == (16, 24)
    assert [pauses(one) for one in found[:3]] == [[], [("meal", 44, 44.5)], []]


def test_a_shift_that_began_before_the_run_is_cut_at_its_start_with_its_breaks():
    found = duties("night", ("Mon 06:00", "Mon 02:10"))
    assert hours(found[0]) == (0, 3 + 50 / 60) and found[0].number == 0
    assert pauses(found[0]) == [("meal", 0, 20 / 60)]
    assert duties("night", ("Mon 06:00", "Mon 02:30"))[0].pauses == ()


def test_the_last_week_before_the_run_has_the_last_of_several_shifts():
    sunday = duties("[early, night]", ("Mon 06:00", "Mon 02:00"), ("14 d", "7 d"))
    assert (sunday[0].shift, *hours(sunday[0])) == (2, 0, 4)
    assert [one.shift for one in sunday] == [2, 0, 0, 0, 0, 0]


def test_a_shift_that_goes_on_beyond_the_horizon_is_cut_there():
    found = duties("night", ("14 d", "20 h"))
    assert [hours(one) for one in found] == [(16, 20)] and found[0].cut and found[0].pauses == ()
    assert found[0].whole_s == (16 * H, 24 * H)
    assert pauses(duties("night", ("14 d", "73200 s"))[0]) == [("meal", 20, 73200 / H)]
    assert duties("late", ("14 d", "8 h")) == ()


@pytest.mark.parametrize(
    ("ends", "last"), [("to: 24:00", 18), ("to: 00:00", 18), ("to: 22:00", 40), ("to: 23:30", 17.5)]
)
def test_a_shift_that_ends_no_later_than_it_begins_ends_on_the_next_day(ends, last):
    edits = (("from: 22:00, to: 06:00, breaks: {meal: {at: 02:00, lasts: 30 min}}", f"from: 22:00, {ends}"),)
    assert [hours(one) for one in duties("night", *edits) if one.start_s == 16 * H] == [(16, last)]


def test_shifts_carry_their_rules_and_overtime_into_the_plan():
    early, late, night = plan(TEXT.replace("SHIFT", "early")).shifts
    assert (early.name, early.at_break, early.at_end, early.overtime_s) == ("early", "hand_over", "finish", 5400)
    assert (late.name, late.at_break, late.at_end, late.overtime_s) == ("late", "resume", "finish", 0)
    assert night.name == "night"


def test_a_station_is_open_in_all_its_shifts_and_those_that_touch_are_one():
    made = plan(TEXT.replace("SHIFT", "early"))
    assert made.stations[0].open_s[:2] == ((0, 16 * H), (24 * H, 40 * H)) and len(made.stations[0].open_s) == 10
    assert made.stations[1].open_s is None


def test_overlapping_shifts_are_one_opening_within_the_run():
    made = plan(TEXT.replace("SHIFT", "early").replace("[late, early]", "[night, late, early]").replace("14 d", "3 d"))
    assert made.stations[0].open_s == ((0, 3 * DAY),)
    around = plan(TEXT.replace("SHIFT", "early").replace("shift: night", "shift: [early, night]"))
    assert all(end < start for (_, end), (start, _) in pairwise(around.sources[0].open_s))


def test_breaks_do_not_close_a_station_or_a_source():
    made = plan(TEXT.replace("SHIFT", "early").replace("shift: night", "shift: early"))
    assert made.sources[0].open_s[0] == (0, 8 * H)


def test_the_next_open_time_is_now_or_the_next_opening():
    open_s = ((10.0, 20.0), (30.0, 40.0))
    assert [next_open(open_s, at) for at in (0, 10, 15, 20, 25, 39, 40)] == [10, 10, 15, 30, 30, 39, float("inf")]


def test_hours_of_a_year_are_counted_exactly():
    found = duties("early", ("14 d", "364 d"))
    assert len(found) == 260 and sum(one.end_s - one.start_s for one in found) == 260 * 8 * H
