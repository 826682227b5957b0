"""What the assumption sheet says of hours."""

import pytest
from plans import loaded, plan

from opsim.plan import compile_plan
from opsim.study.assumptions.people import working_time
from opsim.study.assumptions.sheet import assumptions_of

TEXT = """
opsim: 1
name: hours
run: {start: Mon 06:00, horizon: 24 h}
layout: {places: {here: [0 m, 0 m]}}
shifts:
  day: {from: 06:00, to: 14:00, at_break: hand_over, breaks: {tea: {at: 08:00, lasts: 9 min}}}
  all: {from: 06:00, to: 22:00}
tasks: {t: {fixed: 10 s}}
stations: {a: {at: here, tasks: [t], buffer: 3}}
products: {p: {route: [a]}}
release: {kind: poisson, every: 1 min}
workers: {ana: {shift: day, skills: {a: 1.0}}, ben: {shift: day, skills: {a: 1.0}}}
"""


def said(*edits):
    text = TEXT
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return list(working_time(plan(text)))


@pytest.mark.parametrize(
    ("edits", "topic", "words"),
    [
        ([], "absence", "nobody is ever absent"),
        ([("ana: {", "ana: {absence: 0.05, ")], "absence", "missed, each by chance alone and for all of it: ana 0.05;"),
        ([("ben: {shift: day, ", "ben: {")], "workers", "ben: without a shift, and so there all the time"),
        ([], "interruption", "at breaks and meetings of day: who has to go works on until somebody free has come"),
        ([], "interruption", "at the end of a shift of day: who has to go finishes the task under way first"),
        (
            [("fixed: 10 s", "fixed: 10 s, interruption: restart")],
            "interruption",
            "in t, whatever the shift says: who has to go stops at once, what was done is lost",
        ),
        ([], "breaks", "later and in full"),
        ([("to: 14:00", "to: 14:00, overtime: {most: 90 min}")], "overtime", "day: people stay for up to 1.5 h"),
        (
            [("buffer: 3", "buffer: 3, shift: all")],
            "hours",
            "a: closed by hours; as it closes, what was begun is finished",
        ),
        (
            [("buffer: 3", "buffer: 3, shift: all, at_close: resume")],
            "hours",
            "a: closed by hours; as it closes, what was begun rests",
        ),
        ([("1 min}", "1 min, shift: all}")], "hours", "release: jobs come in its hours alone"),
        (
            [("1 min}", "1 min, shift: all}")],
            "hours",
            "throughput per hour counts the 8 scheduled hours of the window: while at least one station on a route may",
        ),
        ([("ben: {shift: day", "ben: {shift: all")], "hours", "throughput per hour counts the 16 scheduled hours"),
        ([], "hours", "hours of sources do not count"),
    ],
)
def test_what_is_assumed_of_hours_is_told(edits, topic, words):
    assert any(about == topic and words in text for about, text in said(*edits))


def test_rules_of_shifts_that_nobody_works_in_are_not_told():
    assert not any("all" in text.split(":")[0] for topic, text in said() if topic == "interruption")


def test_without_breaks_nothing_is_said_of_them():
    found = said((", at_break: hand_over, breaks: {tea: {at: 08:00, lasts: 9 min}}", ""))
    assert not any(topic == "breaks" or "at breaks" in text for topic, text in found)


def test_without_hours_everybody_is_there_all_the_time():
    (line,) = said(("shift: day, ", ""))
    assert line[1].startswith("everybody is present and equally fresh all the time")


def test_the_sheet_of_a_run_has_these_lines():
    one = loaded(TEXT)
    sheet = assumptions_of(one, compile_plan(one))
    assert set(working_time(compile_plan(one))) <= set(sheet)


def test_hours_of_stations_are_told_where_nobody_works():
    text = TEXT[: TEXT.index("workers:")].replace("fixed: 10 s", "fixed: 10 s, automatic: true")
    one = loaded(text.replace("buffer: 3", "buffer: 3, shift: all"))
    sheet = assumptions_of(one, compile_plan(one))
    assert any(topic == "hours" and words.startswith("a: closed by hours") for topic, words in sheet)
    assert not any("everybody is present" in words for _, words in sheet)
