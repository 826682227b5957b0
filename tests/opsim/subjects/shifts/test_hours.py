"""When people and stations are there: arithmetic of times, shifts, breaks, absence and overtime, by hand.

Weekly patterns laid on the time of a run: duties, breaks and open times, to the second by hand.

What a scenario says of hands, scoring and human effects, as the Plan has it.
"""

import random
from itertools import pairwise

import plans
import pytest
from plans import plan, ran

from opsim.ergonomics.options import USUAL, Thresholds
from opsim.log import BREAK, OFF
from opsim.plan.loads import crew_load, overloads, skill_loads, station_loads
from opsim.subjects.exposure.plan import NOT_SAID, Handling
from opsim.subjects.human.catalogue import entry
from opsim.subjects.human.plan import NO_EFFECTS
from opsim.subjects.shifts.hours import Hours, chance_of
from opsim.subjects.shifts.plan import at_least, both, either, next_open, together, total_s, without
from opsim.subjects.tools.plan import Moment

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
        "pack cannot keep up: it would need 107% of its time (it is there for 62% of the run)",
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


H, CALENDAR_DAY = 3600.0, 86400.0
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
    assert made.stations[0].open_s == ((0, 3 * CALENDAR_DAY),)
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


CELL = """
opsim: 1
name: hands
run: {start: Tue 07:30, horizon: 1 h}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
shifts: {early: {from: '06:00', to: '14:00'}}
tasks:
  make: {emulator: work/fasten, load: 2 kg, loaded: {from: start, to: 0.8}, handling: {grip: fair, rapid: false}}
  look: {fixed: 9 s}
stations: {s1: {at: a, tasks: [make, look]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers:
  w10: {shift: early, skills: {s1: 1}, experience: {make: 40}}
  w2: {skills: {s1: 1}, experience: {look: 3}}
  w3: {shift: early, absence: 0, skills: {s1: 1}}
"""
PLAIN = CELL.replace("experience: {make: 40}", "").replace("experience: {look: 3}", "")
LOOK, MAKE = 0, 1


def people_at_work_plan(more=""):
    return plans.plan(CELL + more)


def test_what_is_said_of_hands_stands_with_the_task_and_the_rest_is_not_said():
    marks = plans.plan(CELL).tasks[MAKE].model.mark_names
    said = people_at_work_plan().tasks[MAKE].handling
    assert said == Handling(
        load_kg=2.0, grip="fair", rapid=False, start=Moment(mark=marks.index("start")), end=Moment(share=0.8)
    )
    assert people_at_work_plan().tasks[LOOK].handling is NOT_SAID


def test_a_plain_scenario_has_the_usual_options_and_no_effects():
    plain = plans.plan(PLAIN)
    assert (plain.ergonomics, plain.human, plain.posture) == (USUAL, NO_EFFECTS, True)
    assert [worker.absence for worker in plain.workers] == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("word", "looked_at"), [("off", False), ("false", False), ("on", True), ("true", True), ("'off'", False)]
)
def test_off_is_off_whoever_wrote_it(word, looked_at):
    assert plans.plan(CELL.replace("horizon: 1 h", f"horizon: 1 h, posture: {word}")).posture is looked_at


def test_angles_are_degrees_to_the_bit_and_lengths_metres():
    thresholds = people_at_work_plan(
        "ergonomics: {thresholds: {twist: 15 deg, side: 0.2 rad, across: 4 cm}}\n"
    ).ergonomics.thresholds
    assert thresholds == Thresholds(twist=15.0, side=11.459155903, across_m=0.04)


def test_every_fork_arrives():
    options = people_at_work_plan(
        "ergonomics: {rate: 6, arm_reference: gravity, rula: {table_a: worksheet2000, force: worksheet}, "
        "owas: {disputed: [4132, '3373', 4132]}, waiting: upright}\n"
    ).ergonomics
    assert (options.rate_hz, options.arm_reference, options.waiting) == (6.0, "gravity", "upright")
    assert (options.rula_table_a, options.rula_force) == ("worksheet2000", "worksheet")
    assert options.owas_disputed == ("3373", "4132")


def test_effects_are_the_models_of_the_catalogue_with_what_was_said():
    human = people_at_work_plan(
        "human: {acts_on: time, learning: {model: wright, rate: 0.9}, "
        "fatigue: {model: lffrm, recovers_half_in: 10 min}, "
        "circadian: {peak: '16:00'}, rest: {above: 0.6, until: 0.1}}\n"
    ).human
    assert human.learning == entry("learning", "wright").cls(rate=0.9)
    assert human.fatigue == entry("fatigue", "lffrm").cls(recovers_half_in_s=600.0)
    assert human.circadian == entry("circadian").cls(peak_s=16 * 3600.0)
    assert human.rest == entry("rest").cls(above=0.6, until=0.1)
    assert (human.acts_on, human.forgetting, human.errors) == ("time", None, None)
    assert human.start_s == (24 + 7.5) * 3600


def test_experience_stands_by_natural_order_of_workers_and_tasks():
    """w2, w3, w10; look, make."""
    assert people_at_work_plan("human: {learning: {model: wright}}\n").human.experience == (
        (3.0, 0.0),
        (0.0, 0.0),
        (0.0, 40.0),
    )


def test_absence_of_all_is_of_everybody_with_a_shift_who_does_not_say_his_own():
    absent = {worker.name: worker.absence for worker in people_at_work_plan("human: {absence: 0.1}\n").workers}
    assert absent == {"w2": 0.0, "w3": 0.0, "w10": 0.1}
