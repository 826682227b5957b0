"""Shifts that change nothing are told."""

import pytest
from plans import loaded

from opsim.subjects.shifts.checks import shift_risks

TEXT = """
opsim: 1
name: shifts
run: {horizon: 8 h}
layout: {places: {a: [0 m, 0 m]}}
shifts:
  early: {from: 06:00, to: 14:00, breaks: {tea: {at: 09:00, lasts: 15 min}}}
  day: {from: 07:00, to: 15:00}
tasks: {t: {fixed: 10 min}}
stations: {s: {at: a, tasks: [t], shift: day}}
products: {p: {route: [s]}}
release: {kind: poisson, every: 15 min}
workers: {ana: {skills: {s: 1.0}, shift: early}}
"""


def risks(*edits):
    text = TEXT
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return list(shift_risks(loaded(text).scenario))


def test_shifts_that_are_followed_are_no_risk():
    assert risks() == []


@pytest.mark.parametrize(("old", "new", "answer"), [
    (", shift: day", "", "shift day: nobody works in it, and nothing is open by it"),
    ("15 min}}}\n", "15 min}}}\n  late: {like: early}\n  night: {like: early}\n",
     "shift late and night: nobody works in them, and nothing is open by them"),
    ("shift: day", "shift: [day, early]", None),
    ("to: 15:00", "to: 15:00, meetings: {m: {at: 08:00, lasts: 1 min}}, breaks: {b: {at: 12:00, lasts: 1 h}}",
     "shift day: its breaks and meetings are for people, and no worker follows it; a station closes over noon where it "
     "has two shifts, before and after"),
])  # fmt: skip
def test_shifts_without_use_are_told(old, new, answer):
    assert risks((old, new)) == ([answer] if answer else [])


def test_a_shift_that_ends_when_it_begins_is_told_to_last_a_day():
    assert risks(("to: 15:00", "to: 07:00")) == ["shift day: it ends when it begins (07:00), which is 24 h later"]
    assert risks(("from: 07:00, to: 15:00", "from: 00:00, to: 24:00")) == []
