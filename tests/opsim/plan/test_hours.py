"""When people and stations are there: arithmetic of times, shifts, breaks, absence and overtime, by hand."""

import random

import pytest
from plans import plan, ran

from opsim.log import BREAK, OFF
from opsim.plan.calendar import at_least, both, either, together, total_s, without
from opsim.plan.hours import Hours, chance_of
from opsim.plan.loads import crew_load, overloads, skill_loads, station_loads

DAY = """
opsim: 1
name: Hours
run: {start: Mon 06:00, horizon: 24 h}
layout: {places: {here: [0 m, 0 m]}}
shifts:
  early: {from: '06:00', to: '14:00', breaks: {lunch: {at: '10:00', lasts: 30 min}}, overtime: {most: 2 h}}
  late: {from: '14:00', to: '22:00', breaks: {lunch: {at: '18:00', lasts: 30 min}}}
tasks: {hand: {fixed: 36 s}, do: {fixed: 36 s, automatic: true}}
stations: {pack: {at: here, tasks: [hand]}, oven: {at: here, tasks: [do]}}
products: {a: {route: [pack, oven]}}
release: {kind: poisson, every: 72 s}
workers: {ana: {shift: early, skills: {pack: 1}}, ben: {shift: late, skills: {pack: 1}}}
"""


def edited(*edits):
    text = DAY
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return plan(text)


def rank(station, plan):
    return [one.name for one in plan.stations].index(station)


# ---------------------------------------------------------------------------------------------------------------- spans
def test_times_add_up_meet_and_are_taken_out():
    one, other = ((0.0, 10.0), (20.0, 30.0)), ((5.0, 22.0), (28.0, 40.0))
    assert either(one, other) == ((0.0, 40.0),)
    assert both(one, other) == ((5.0, 10.0), (20.0, 22.0), (28.0, 30.0))
    assert without(one, other) == ((0.0, 5.0), (22.0, 28.0))
    assert without(other, one) == ((10.0, 20.0), (30.0, 40.0))
    assert (total_s(one), total_s(()), either(), both(one, ())) == (20.0, 0, (), ())
    assert at_least(2, [one, other, ((8.0, 21.0),)]) == ((5.0, 22.0), (28.0, 30.0))


def test_times_are_those_of_every_second_looked_at_by_itself():
    rng = random.Random(1)
    for _ in range(200):
        several = [made_spans(rng) for _ in range(rng.randint(1, 4))]
        n = rng.randint(1, 3)
        counts = [sum(any(a <= t < b for a, b in spans) for spans in several) for t in range(40)]
        assert seconds(at_least(n, several)) == {t for t in range(40) if counts[t] >= n}
        first, *others = several
        gone = either(*others)
        assert seconds(without(first, gone)) == seconds(first) - seconds(gone)
        found = {t: who for a, b, who in together(several) for t in range(int(a), int(b))}
        assert {t: len(found.get(t, ())) for t in range(40)} == dict(enumerate(counts))


def made_spans(rng):
    ends = sorted(rng.sample(range(40), 2 * rng.randint(0, 3)))
    return tuple((float(a), float(b)) for a, b in zip(ends[::2], ends[1::2]))


def seconds(spans):
    return {t for a, b in spans for t in range(int(a), int(b))}


@pytest.mark.parametrize(
    ("team", "missing", "chance"),
    [(1, [], 0.0), (1, [0.1], 0.9), (1, [0.1, 0.2], 0.98), (2, [0.1, 0.2], 0.72), (2, [0.5, 0.5, 0.5], 0.5)],
)
def test_the_chance_that_enough_have_come(team, missing, chance):
    assert chance_of(team, missing) == pytest.approx(chance)


# --------------------------------------------------------------------------------------------------------------- people
def test_people_are_there_in_their_shifts_without_their_breaks():
    hours = Hours(edited())
    assert hours.on_duty == [((0.0, 28800.0),), ((28800.0, 57600.0),)]
    assert hours.at_work[0] == ((0.0, 14400.0), (16200.0, 28800.0))
    assert hours.share == [7.5 / 24, 7.5 / 24]
    assert hours.share_with_overtime == [9.5 / 24, 7.5 / 24]
    assert hours.manned(rank("pack", hours.plan)) == ((0.0, 57600.0),)


def test_absence_takes_its_share_of_the_days_and_of_the_station():
    hours = Hours(edited(("ana: {shift: early,", "ana: {shift: early, absence: 0.1,")))
    assert hours.share[0] == pytest.approx(0.9 * 7.5 / 24)
    pack = rank("pack", hours.plan)
    assert hours.working_share(pack, 36, 0) == pytest.approx((0.9 * 7.5 + 7.5) / 24)
    assert hours.working_share(pack, 0, 36) == 1


def test_what_a_station_does_by_itself_goes_on_in_breaks_and_after_the_last_shift():
    """Half an hour by hand, half an hour alone: in half of all gaps a run goes on, the half of it on average, 15 min;
    of a run of 2 h in a break of 30 min 26.25 min.
    """
    hours = Hours(edited())
    pack = rank("pack", hours.plan)
    assert hours.working_share(pack, 1800, 1800) == pytest.approx((15 + 3 * 0.5 * 0.25) / 24)
    assert hours.working_share(pack, 7200, 7200) == pytest.approx((15 + 0.5 * (2 * 26.25 / 60 + 1)) / 24)


def test_overtime_is_time_after_a_shift_and_ends_where_the_next_one_begins():
    assert Hours(edited()).with_overtime[0] == ((0.0, 14400.0), (16200.0, 36000.0))
    alone = edited(("ben: {shift: late", "ben: {shift: early"), ("every: 72 s", "every: 144 s"))
    _, pack = station_loads(alone)
    assert (pack.load, pack.with_overtime) == (pytest.approx(0.25 * 24 / 7.5), pytest.approx(0.25 * 24 / 9.5))
    _, pack = station_loads(edited())
    assert pack.with_overtime is None  # the late shift is there anyway


# ---------------------------------------------------------------------------------------------------------------- loads
def test_a_station_works_in_the_hours_of_its_people_and_a_machine_always():
    oven, pack = station_loads(edited())
    assert (oven.hours, oven.load) == (1.0, 0.5)
    assert pack.hours == pytest.approx(15 / 24)
    assert pack.load == pytest.approx(0.5 * 24 / 15)
    assert pack.most_per_h == pytest.approx(100 * 15 / 24)


def test_a_closed_station_works_in_its_own_hours():
    oven, _ = station_loads(edited(("tasks: [do]}}", "tasks: [do], shift: late}}")))
    assert (oven.hours, oven.load) == (8 / 24, 1.5)


def test_a_source_with_hours_brings_less():
    oven, pack = station_loads(edited(("every: 72 s}", "every: 72 s, shift: early}")))
    assert (oven.arrivals_per_h, pack.arrivals_per_h) == (pytest.approx(50 / 3), pytest.approx(50 / 3))


def test_skills_are_loaded_by_the_time_of_those_who_are_there():
    (pack,) = skill_loads(edited())
    assert (pack.able, pack.there, pack.wanted) == (2, 15 / 24, 0.5)
    assert pack.load == pytest.approx(0.5 / (15 / 24))
    assert pack.with_overtime == pytest.approx(0.5 / (17 / 24))
    (always,) = skill_loads(edited(("shift: early, ", ""), ("shift: late, ", "")))
    assert (always.there, always.load, always.with_overtime) == (2, 0.25, None)


def test_all_together_are_loaded_by_their_time_too():
    crew = crew_load(edited(("ana: {shift: early,", "ana: {shift: early, absence: 0.2,")))
    assert crew.share == pytest.approx(0.5 / ((0.8 * 7.5 + 7.5) / 24))
    assert crew.with_overtime == pytest.approx(0.5 / ((0.8 * 9.5 + 7.5) / 24))


def test_too_much_work_for_the_hours_there_are_is_told_with_what_overtime_would_do():
    said = overloads(edited(("every: 72 s", "every: 54 s")))
    assert said == [
        "pack cannot keep up: 107% of its time, 62% of the run, is wanted",
        "work at pack cannot be done: 107% of the time of the 2 workers who can, walks not counted; 0.62 of them are "
        "at work on the mean of the run; 94% with all the overtime that is allowed",
    ]
    assert overloads(edited()) == []


def test_somebody_always_there_is_loaded_as_before():
    always = edited(("shift: early, ", ""), ("shift: late, ", ""))
    assert [(load.hours, load.load) for load in station_loads(always)] == [(1.0, 0.5), (1.0, 0.5)]


@pytest.mark.parametrize("start", ["Mon 06:00", "Mon 09:50", "Sun 23:00"])
def test_people_of_a_run_are_there_as_long_as_foretold(start):
    """Breaks that stop work at once, and nobody absent: presence in the log is the share of the plan, to the second."""
    rules = ("early: {", "early: {at_end: resume, "), ("late: {", "late: {at_end: resume, ")
    times = [("start: Mon 06:00", f"start: {start}"), (", overtime: {most: 2 h}", "")]
    log, made = ran(DAY, *rules, *times)
    away = log.of(BREAK, OFF)
    for worker, share in enumerate(Hours(made).share):
        mine = away.where(away["worker"] == worker)
        assert 1 - mine.duration_s.sum() / made.horizon_s == pytest.approx(share, abs=1e-12)
