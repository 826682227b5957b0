"""Hours of stations and sources by hand arithmetic: what stops, what is finished, what comes when they open."""

import pytest
from plans import ran

from opsim.log import CLOSED, CREATE, FINISH, HELD, IS_DOWN, NO_WORKER, OFF, REPAIR, SETUP, WAIT, WORK

ONE = """
opsim: 1
name: one machine
run: {start: Mon 06:00, horizon: 120 s}
layout: {places: {hall: [0 m, 0 m]}}
shifts:
  a: {from: 06:00:20, to: 06:00:55}
  b: {from: 06:01:20, to: 06:01:50}
tasks: {press: {fixed: 10 s, automatic: true}}
stations: {m: {at: hall, tasks: [press], buffer: 1, shift: [b, a]}}
products: {part: {route: [m]}}
release: {kind: saturated}
"""
BY_HAND = (
    ("automatic: true", "repeat: 1"),
    ("release: {kind: saturated}", "release: {kind: saturated}\nworkers: {ana: {skills: {m: 1.0}}}"),
)
RESUME = "shift: [b, a]", "shift: [b, a], at_close: resume"


def spans(log, *kinds, cause=None):
    rows = log.of(*kinds)
    rows = rows if cause is None else rows.where(rows["cause"] == cause)
    return sorted(zip(rows["start_s"].tolist(), rows["end_s"].tolist()))


def finished(log):
    return log.of(FINISH)["end_s"].tolist()


def created(log):
    return log.of(CREATE)["end_s"].tolist()


@pytest.mark.parametrize("hands", [(), BY_HAND])
def test_what_is_under_way_when_a_station_closes_is_finished_and_nothing_begins_before_it_opens(hands):
    log, _ = ran(ONE, *hands)
    assert spans(log, WORK) == [(20, 30), (30, 40), (40, 50), (50, 60), (80, 90), (90, 100), (100, 110)]
    assert finished(log) == [30, 40, 50, 60, 90, 100, 110]
    assert spans(log, HELD, cause=CLOSED)[:2] == [(0, 20), (60, 80)]


def test_a_station_is_off_in_exactly_its_closed_hours():
    log, _ = ran(ONE)
    off = log.of(OFF)
    assert spans(log, OFF) == [(0, 20), (55, 80), (110, 120)]
    assert set(off["worker"]) == set(off["job"]) == {-1} and set(off["station"]) == {0}


@pytest.mark.parametrize("hands", [(), BY_HAND])
def test_with_resume_it_stops_to_the_tick_and_goes_on_with_the_rest_of_the_same_performance(hands):
    log, _ = ran(ONE, *hands, RESUME)
    assert spans(log, WORK) == [(20, 30), (30, 40), (40, 50), (50, 55), (80, 85), (85, 95), (95, 105), (105, 110)]
    pieces = log.of(WORK).where(log.of(WORK)["job"] == 3)
    assert pieces["progress_from"].tolist() == [0, 0.5] and pieces["progress_to"].tolist() == [0.5, 1]
    assert len(set(pieces["performance_id"])) == len(set(pieces["k"])) == 1
    assert (55.0, 80.0) in spans(log, HELD, cause=CLOSED)


def test_the_worker_of_a_closed_station_is_free_for_others():
    log, _ = ran(ONE, *BY_HAND, RESUME)
    assert spans(log, WAIT) == [(0, 20), (55, 80), (110, 120)]


def test_what_would_begin_at_the_instant_of_closing_is_not_begun():
    for edits in ((), BY_HAND):
        log, _ = ran(ONE, *edits, ("to: 06:00:55", "to: 06:00:50"))
        assert spans(log, WORK)[:4] == [(20, 30), (30, 40), (40, 50), (80, 90)]


def test_the_next_task_of_a_job_waits_for_the_opening():
    two = ("tasks: [press]", "tasks: [press, look]"), ("tasks: {press", "tasks: {look: {fixed: 4 s}, press")
    log, _ = ran(ONE, *BY_HAND, *two, ("to: 06:00:55", "to: 06:00:22"))
    assert spans(log, WORK) == [(20, 30), (80, 84), (84, 94), (94, 98), (98, 108), (108, 112)]
    assert finished(log) == [84, 98, 112]


def test_a_set_up_under_way_is_finished_or_stopped_as_a_task():
    setup = (
        ("buffer: 1", "buffer: 1, setup: {first: part, times: {part: {part: 8 s}}}"),
        ("to: 06:00:55", "to: 06:00:24"),
    )
    log, _ = ran(ONE, *BY_HAND, *setup)
    assert spans(log, SETUP)[:2] == [(20, 28), (90, 98)] and spans(log, WORK)[0] == (80, 90)
    log, _ = ran(ONE, *BY_HAND, *setup, RESUME)
    assert spans(log, SETUP)[:2] == [(20, 24), (80, 84)] and spans(log, WORK)[0] == (84, 94)


def test_shifts_that_touch_are_one_opening():
    log, _ = ran(ONE, ("from: 06:01:20", "from: 06:00:55"), RESUME)
    assert spans(log, OFF) == [(0, 20), (110, 120)]
    assert spans(log, WORK) == [(at, at + 10) for at in range(20, 110, 10)]


def test_a_station_that_is_never_open_in_the_run_does_nothing():
    log, _ = ran(ONE, ("[b, a]", "late"), ("shifts:", "shifts:\n  late: {from: 14:00, to: 22:00}"))
    assert spans(log, WORK) == [] and spans(log, OFF) == [(0, 120)]


def test_a_shift_that_began_before_the_run_is_under_way_at_its_start():
    log, _ = ran(ONE, ("06:00:20", "22:00"), ("shift: [b, a]", "shift: a"))
    assert spans(log, OFF) == [(55, 120)] and finished(log) == [10, 20, 30, 40, 50, 60]


def test_a_job_on_a_closed_station_that_breaks_down_stands_until_both_are_over():
    stops = "breakdowns: {jam: {every: {fixed: 15 s}, repair: {fixed: 40 s}}}, shift: [b, a]"
    log, _ = ran(ONE, ("shift: [b, a]", stops))
    # Up from 20, broken down at 35 until 75; closed at 55, open at 80; the clock stands still from 75 to 80.
    assert spans(log, REPAIR) == [(35, 75), (95, 120)]
    assert spans(log, WORK) == [(20, 30), (30, 35), (80, 85), (85, 95)]
    assert spans(log, HELD, cause=IS_DOWN)[0] == (35, 55) and (55, 80) in spans(log, HELD, cause=CLOSED)


def test_a_breakdown_stops_what_is_being_finished_after_closing():
    stops = "breakdowns: {jam: {every: {fixed: 37 s}, by: busy, repair: {fixed: 3 s}}}, shift: [b, a]"
    log, _ = ran(ONE, ("shift: [b, a]", stops))
    assert spans(log, WORK)[3:5] == [(50, 57), (80, 83)]
    assert spans(log, REPAIR) == [(57, 60)]


def test_maintenance_may_be_done_while_a_station_is_closed():
    stops = "maintenance: {oil: {every: 60 s, lasts: 15 s}}, shift: [b, a]"
    log, _ = ran(ONE, ("shift: [b, a]", stops))
    assert spans(log, REPAIR) == [(60, 75)]
    assert spans(log, WORK)[3:5] == [(50, 60), (80, 90)]


def test_who_is_on_his_way_as_a_station_closes_comes_and_is_free():
    far = ("hall: [0 m, 0 m]", "hall: [0 m, 0 m], far: [12 m, 0 m]"), ("{skills", "{home: far, skills")
    log, _ = ran(ONE, *BY_HAND, *far, ("to: 06:00:55", "to: 06:00:25"))
    assert spans(log, WORK)[0] == (80, 90)
    assert spans(log, WAIT)[:2] == [(0, 20), (30, 80)]


TEAM = (
    ("automatic: true", "team: 2, repeat: 2"),
    (
        "release: {kind: saturated}",
        "release: {kind: saturated}\nworkers: {ana: {skills: {m: 1}}, ben: {skills: {m: 1}}}",
    ),
)


def test_a_team_that_is_done_while_the_station_is_closed_repeats_its_task_when_it_opens():
    log, _ = ran(ONE, *TEAM)
    of_jobs = log.where(log["job"] >= 0)
    assert spans(of_jobs, WORK) == [(20, 30), (30, 40), (40, 50), (50, 60), (80, 90), (90, 100), (100, 110)]
    log, _ = ran(ONE, *TEAM, ("to: 06:00:55", "to: 06:00:45"))
    of_jobs = log.where(log["job"] >= 0)
    assert spans(of_jobs, WORK) == [(20, 30), (30, 40), (40, 50), (80, 90), (90, 100), (100, 110)]
    assert (50.0, 80.0) in spans(log, HELD, cause=CLOSED)


POISSON = ("kind: saturated", "kind: renewal, every: {fixed: 15 s}, shift: [a, b]")
ALWAYS = ("shift: [b, a]}", "servers: 9}")


def test_gaps_between_arrivals_count_open_time_alone():
    # Open 20-55 and 80-110: the gaps of 15 s end at open seconds 15, 30, 45, 60.
    log, _ = ran(ONE, ALWAYS, POISSON)
    assert created(log) == [35, 50, 90, 105]


def test_what_would_come_at_the_instant_of_closing_comes_at_the_opening():
    log, _ = ran(ONE, ALWAYS, POISSON, ("fixed: 15 s", "fixed: 35 s"))
    assert created(log) == [80]


def test_a_source_of_hours_has_the_luck_of_one_without():
    random = POISSON[0], "kind: poisson, every: 4 s"
    always, _ = ran(ONE, ALWAYS, random)
    in_hours, _ = ran(ONE, ALWAYS, (random[0], random[1] + ", shift: [a, b]"))
    open_s = [20 + at if at < 35 else 45 + at for at in created(always) if at < 65]
    assert created(in_hours) == open_s


def test_a_saturated_source_asks_for_room_in_its_hours_alone():
    log, _ = ran(ONE, ("buffer: 1, shift: [b, a]", "buffer: 1"), ("kind: saturated", "kind: saturated, shift: [a, b]"))
    # 20: a job on the server and one in the buffer, one more with each that is done; at 55 one is in work, one waits.
    assert created(log) == [20, 20, 30, 40, 50, 80, 80, 90, 100]
    assert finished(log) == [30, 40, 50, 60, 70, 90, 100, 110]


def test_orders_of_closed_hours_come_when_the_source_opens(tmp_path):
    from opsim.engine.floor.run import run_plan
    from opsim.laws.audit import audit
    from opsim.plan import compile_plan
    from opsim.scenario.read import scenarios_in

    (tmp_path / "orders.csv").write_text("time,product,quantity\n5,part,2\n30,part,1\n60,part,1\n115,part,1\n")
    text = ONE.replace("shift: [b, a]}", "servers: 9}").replace(
        "kind: saturated", "kind: schedule, file: orders.csv, shift: [a, b]"
    )
    plan = compile_plan(scenarios_in(text.encode(), tmp_path / "one.yaml")["base"])
    log = run_plan(plan)
    audit(log, plan)
    assert created(log) == [20, 20, 30, 80]
    assert plan.sources[0].n_late == 1


def test_a_store_is_kept_filled_in_the_hours_of_its_source():
    stock = (
        "release: {kind: saturated}",
        "stores: {shelf: {at: hall}}\nsources: {fill: {kind: base_stock, store: shelf, level: 3, shift: a}}",
    )
    log, _ = ran(ONE, ("shift: [b, a]}", "servers: 9}"), ("route: [m]", "route: [m, shelf]"), stock)
    assert created(log) == [20, 20, 20]


def test_hours_around_the_clock_change_nothing():
    plain, _ = ran(ONE, ("shift: [b, a]", "servers: 2"), *BY_HAND)
    hours = ("shift: [b, a]", "servers: 2, shift: c"), ("shifts:", "shifts:\n  c: {from: 05:00, to: 05:00}")
    always, _ = ran(ONE, *hours, *BY_HAND, ("kind: saturated", "kind: saturated, shift: c"))
    assert all((always[column] == plain[column]).all() for column in ("kind", "start_s", "end_s", "worker", "job", "k"))


def test_the_order_of_shifts_in_a_list_of_a_station_decides_nothing():
    one, _ = ran(ONE, RESUME)
    other, _ = ran(ONE, RESUME, ("[b, a]", "[a, b]"))
    assert one.columns["end_s"].tolist() == other.columns["end_s"].tolist()


def test_nobody_is_called_to_a_closed_station():
    log, _ = ran(ONE, *BY_HAND)
    held = log.of(HELD)
    called = held.where(held["cause"] == NO_WORKER)
    assert not len(called)


WEEKS = """
opsim: 1
name: four weeks
run: {start: Wed 10:00, horizon: 28 d}
layout: {places: {hall: [0 m, 0 m]}}
shifts: {office: {from: 08:00, to: 16:00, days: [Mon, Tue, Wed, Thu, Fri]}}
tasks: {press: {fixed: 35 min, automatic: true}, look: {fixed: 1 s, automatic: true}}
stations: {m: {at: hall, tasks: [press], shift: office, at_close: resume}, n: {at: hall, tasks: [look], servers: 9}}
products: {part: {route: [m]}, call: {route: [n]}}
sources:
  parts: {kind: saturated, products: [part]}
  calls: {kind: renewal, every: {fixed: 7 min}, products: [call], shift: office}
"""


def test_four_weeks_of_office_hours_are_counted_to_the_second():
    # Twenty days of eight hours, the first and the last cut to one day together: 9600 minutes, six hours on the first.
    log, plan = ran(WEEKS.replace("tasks: [press],", "tasks: [press], buffer: 1,"))
    assert sum(to_s - from_s for from_s, to_s in plan.sources[0].open_s) == 9600 * 60
    calls = [end_s for end_s, source in zip(created(log), log.of(CREATE)["source"]) if source == 0]
    assert len(calls) == 9600 // 7 and calls[-1] == 28 * 86400 - (9600 % 7) * 60
    assert calls[50:52] == [357 * 60, 22 * 3600 + 4 * 60]  # minute 364 is four minutes past eight on Thursday
    parts = [end_s for end_s, source in zip(finished(log), log.of(FINISH)["source"]) if source == 1]
    assert len(parts) == 9600 // 35 and parts[-1] == 28 * 86400 - (9600 % 35) * 60
    assert parts[9:11] == [350 * 60, 22 * 3600 + 25 * 60]
