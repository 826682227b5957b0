"""Stops of stations by hand arithmetic: when they come, what they interrupt, who sees to them."""

import pytest
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit
from opsim.log import BREAKDOWN, DOWN, FINISH, HELD, IS_DOWN, MAINTENANCE, NO_TOOL, NO_WORKER, REPAIR, SCRAP, WAIT, WORK

ONE = """
opsim: 1
name: one machine
run: {horizon: 100 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 10 s, automatic: true}}
stations: {m: {at: hall, tasks: [press], buffer: 1, STOPS}}
products: {part: {route: [m]}}
release: {kind: saturated}
repair_teams: {crew: {n: 1}}
"""
EVERY_20 = ("kind: saturated", "kind: renewal, every: {fixed: 20 s}")


def ran(text, *changes):
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    p = plan(text)
    log = run_plan(p)
    audit(log, p)
    return log


def spans(log, *kinds, station=0):
    rows = log.of(*kinds)
    rows = rows.where(rows["station"] == station)
    return sorted(zip(rows["start_s"].tolist(), rows["end_s"].tolist()))


def finished(log):
    return log.of(FINISH)["end_s"].tolist()


def jam(every, repair="7 s", more=""):
    return "STOPS", f"breakdowns: {{jam: {{every: {every}, repair: {{fixed: {repair}}}{more}}}}}"


def test_by_the_clock_a_station_runs_its_time_from_repair_to_breakdown_and_work_goes_on():
    log = ran(ONE, jam("{fixed: 15 s}"))
    assert spans(log, REPAIR) == [(15, 22), (37, 44), (59, 66), (81, 88)]
    assert spans(log, WORK)[:5] == [(0, 10), (10, 15), (22, 27), (27, 37), (44, 54)]
    assert finished(log) == [10, 27, 37, 54, 71, 81, 98]
    assert set(log.of(REPAIR)["cause"]) == {BREAKDOWN}
    assert log.of(REPAIR)["k"].tolist() == [0, 1, 2, 3]
    assert log.names["task"][log.of(REPAIR)["task"][0]] == "m: jam"


def test_the_pieces_of_interrupted_work_are_one_performance():
    log = ran(ONE, jam("{fixed: 15 s}"))
    pieces = log.of(WORK).where(log.of(WORK)["job"] == 1)
    assert pieces["progress_from"].tolist() == [0, 0.5]
    assert pieces["progress_to"].tolist() == [0.5, 1]
    assert len(set(pieces["performance_id"])) == len(set(pieces["k"])) == 1


def test_by_busy_time_only_what_is_done_counts():
    by_clock, busy = (ran(ONE, EVERY_20, jam("{fixed: 15 s}", "4 s", f", by: {by}")) for by in ("clock", "busy"))
    assert spans(by_clock, REPAIR) == [(15, 19), (34, 38), (53, 57), (72, 76), (91, 95)]
    assert spans(busy, WORK) == [(20, 30), (40, 45), (49, 54), (60, 70), (80, 90)]
    assert spans(busy, REPAIR) == [(45, 49), (70, 74)]


def test_by_cycles_it_stops_as_the_next_operation_would_begin():
    log = ran(ONE, EVERY_20, jam("2", "4 s", ", by: cycles"))
    assert spans(log, REPAIR) == [(60, 64)]
    assert spans(log, WORK) == [(20, 30), (40, 50), (64, 74), (80, 90)]
    assert spans(log, HELD) == [(60, 64)]


@pytest.mark.parametrize(("job", "work", "scrapped"), [
    ("resume", [(0, 10), (10, 15), (22, 27)], []),
    ("restart", [(0, 10), (10, 15), (22, 32)], []),
    ("scrap", [(0, 10), (10, 15), (22, 32)], [1]),
])  # fmt: skip
def test_what_was_in_work_goes_on_begins_anew_or_is_scrap(job, work, scrapped):
    log = ran(ONE, jam("{dist: empirical, values: [15 s, 15 s]}", "7 s", f", job: {job}"), ("100 s", "34 s"))
    assert spans(log, WORK)[:3] == work
    assert log.of(SCRAP)["job"].tolist() == scrapped
    assert log.of(SCRAP)["cause"].tolist() == [BREAKDOWN] * len(scrapped)


def test_work_that_begins_anew_is_a_performance_of_its_own():
    log = ran(ONE, jam("{fixed: 15 s}", "7 s", ", job: restart"), ("100 s", "34 s"))
    pieces = log.of(WORK).where(log.of(WORK)["job"] == 1)
    assert pieces["k"].tolist() == [1, 2]
    assert len(set(pieces["performance_id"])) == 2


TWO = """
opsim: 1
name: two machines
run: {horizon: 60 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 10 s, automatic: true}}
stations:
  m2: {at: hall, tasks: [press], buffer: 1, breakdowns: {jam: {every: {fixed: 20 s}, repair: {fixed: 5 s}, team: crew}}}
  m10:
    {at: hall, tasks: [press], buffer: 1, breakdowns: {jam: {every: {fixed: 20 s}, repair: {fixed: 5 s}, team: crew}}}
products: {a: {share: 0.5, route: [m2]}, b: {share: 0.5, route: [m10]}}
release: {kind: saturated}
repair_teams: {crew: {n: 1}}
"""
M2, M10 = 0, 1


def test_a_team_sees_to_one_stop_after_the_other_the_longest_first_and_equals_in_natural_order():
    log = ran(TWO, ("60 s", "58 s"))
    assert spans(log, REPAIR, station=M2) == [(20, 25), (45, 50)]
    assert spans(log, DOWN, station=M10) == [(20, 25)]
    assert spans(log, REPAIR, station=M10) == [(25, 30), (50, 55)]


def test_two_teams_or_a_team_of_two_wait_for_nobody():
    assert not len(ran(TWO, ("n: 1", "n: 2")).of(DOWN))
    other = ran(TWO, ("team: crew}}}\nproducts", "team: crew2}}}\nproducts"), ("{crew:", "{crew2: {n: 1}, crew:"))
    assert not len(other.of(DOWN))


@pytest.mark.parametrize(("when", "stops"), [
    ("after_job", [(30, 35), (55, 60), (80, 85)]),
    ("at_once", [(26, 31), (52, 57), (78, 83)]),
])  # fmt: skip
def test_maintenance_comes_by_the_clock_and_waits_for_the_job_or_not(when, stops):
    log = ran(ONE, ("STOPS", f"maintenance: {{oil: {{every: 26 s, lasts: 5 s, when: {when}}}}}"))
    assert spans(log, REPAIR) == stops
    assert set(log.of(REPAIR)["cause"]) == {MAINTENANCE}


def test_an_idle_station_is_maintained_when_it_is_due():
    log = ran(ONE, EVERY_20, ("STOPS", "maintenance: {oil: {every: 40 s, first: 15 s, lasts: 4 s}}"))
    assert spans(log, REPAIR) == [(15, 19), (55, 59), (95, 99)]


def test_one_stop_at_a_time_and_what_falls_due_meanwhile_follows():
    stops = "maintenance: {oil: {every: 18 s, lasts: 5 s, when: at_once}}"
    log = ran(ONE, jam("{fixed: 15 s}", "10 s"), ("buffer: 1, ", f"buffer: 1, {stops}, "), ("100 s", "40 s"))
    assert [(*span, cause) for span, cause in zip(spans(log, REPAIR), log.of(REPAIR)["cause"])] == [
        (15, 25, BREAKDOWN), (25, 30, MAINTENANCE), (36, 40, MAINTENANCE)
    ]  # fmt: skip


def test_a_clock_stands_still_while_the_station_stands():
    stops = "maintenance: {oil: {every: 50 s, first: 10 s, lasts: 5 s, when: at_once}}"
    log = ran(ONE, jam("{fixed: 15 s}"), ("buffer: 1, ", f"buffer: 1, {stops}, "), ("100 s", "40 s"))
    assert spans(log, REPAIR) == [(10, 15), (20, 27)]


BENCH = """
opsim: 1
name: bench
run: {horizon: 60 s}
layout: {places: {hall: [0 m, 0 m], door: [12 m, 0 m]}}
tasks: {sew: {fixed: 10 s}, iron: {fixed: 20 s}}
stations:
  m: {at: hall, tasks: [sew], STOPS}
  n: {at: hall, tasks: [iron]}
products: {a: {share: 0.5, route: [m]}, b: {share: 0.5, route: [n]}}
release: {kind: renewal, every: {fixed: 10 s}, sequence: [a, b]}
workers:
  ana: {skills: {m: 1.0, n: 1.0}, home: hall}
  eva: {skills: {m: 2.0}, home: door, walk: 1 m/s}
"""
"""ana stands by both machines; eva is twice as fast at m, and comes from afar."""
NO_EVA = ("  eva: {skills: {m: 2.0}, home: door, walk: 1 m/s}\n", "")


def test_the_worker_is_free_while_his_machine_stands_and_goes_on_with_the_same_performance():
    log = ran(BENCH, NO_EVA, jam("{fixed: 15 s}"), ("60 s", "29 s"), ("[a, b]", "[a]"))
    assert spans(log, WORK) == [(10, 15), (22, 27), (27, 29)]
    assert log.of(WORK)["performance_id"].tolist() == [0, 0, 1]
    assert spans(log, WAIT, station=-1) == [(0, 10), (15, 22)]


def test_while_his_machine_stands_he_does_other_work_and_the_rest_waits_for_him():
    log = ran(BENCH, NO_EVA, jam("{fixed: 5 s}", more=", by: busy"), ("60 s", "45 s"))
    assert spans(log, WORK, station=1) == [(20, 40)]
    assert spans(log, WORK)[:2] == [(10, 15), (40, 45)]


def test_another_worker_takes_his_own_next_time_for_what_is_left():
    log = ran(BENCH, jam("{fixed: 15 s}"), ("60 s", "40 s"))
    first = log.of(WORK).where(log.of(WORK)["job"] == 0)
    assert list(zip(first["worker"], first["start_s"], first["end_s"])) == [(0, 10, 15), (1, 34, 36.5)]
    assert first["progress_from"].tolist() == [0, 0.5]
    assert first["k"].tolist() == [0, 0]
    assert len(set(first["performance_id"])) == 2


def test_a_breakdown_stops_all_servers():
    two = ("buffer: 1", "servers: 2, buffer: 0"), ("100 s", "30 s")
    log = ran(ONE, *two, jam("{fixed: 15 s}"))
    assert spans(log, WORK) == [(0, 10)] * 2 + [(10, 15)] * 2 + [(22, 27)] * 2 + [(27, 30)] * 2


def test_before_maintenance_jobs_that_were_begun_are_finished_and_nobody_is_called_for_others():
    two = ("[sew], ", "[sew], servers: 2, "), ("sequence: [a, b]", "sequence: [a], at_once: 2"), ("60 s", "36 s")
    log = ran(BENCH, NO_EVA, *two, ("STOPS", "maintenance: {oil: {every: 40 s, first: 12 s, lasts: 5 s}}"))
    assert spans(log, REPAIR) == [(20, 25)]
    assert spans(log, WORK)[:2] == [(10, 20), (25, 35)]
    other = log.of(HELD).where(log.of(HELD)["job"] == 1)
    assert list(zip(other["start_s"], other["end_s"], other["cause"])) == [(10, 12, NO_WORKER), (12, 25, IS_DOWN)]


@pytest.mark.parametrize(
    ("needs", "cause"), [("needs: {gun: 1}, automatic: true", NO_TOOL), ("team: 2", NO_WORKER)], ids=["tool", "team"]
)
def test_who_waits_for_a_tool_or_a_team_does_not_begin_once_maintenance_is_due(needs, cause):
    """The second sewing at m could begin at 15 s, when the ironing at n is done; the oiling has been due since 12 s."""
    changes = (
        ("{sew: {fixed: 10 s}, iron: {fixed: 20 s}}", f"{{sew: {{fixed: 10 s, {needs}}}, iron: {{fixed: 5 s, {needs}}}}}"),  # noqa: E501
        ("stations:", "tools: {gun: {n: 2}}\nstations:"),
        ("[sew], ", "[sew], servers: 2, "),
        ("{kind: renewal, every: {fixed: 10 s}, sequence: [a, b]}", "{kind: renewal, every: {fixed: 10 s}, at_once: 3, "
         "sequence: [b, a, a]}"),
        ("60 s", "36 s"),
        ("  eva: {skills: {m: 2.0}, home: door, walk: 1 m/s}\n", "".join(
            f"  w{n}: {{skills: {{m: 1.0, n: 1.0}}, home: hall}}\n" for n in range(3)
        )),
        ("STOPS", "maintenance: {oil: {every: 40 s, first: 12 s, lasts: 5 s}}"),
    )  # fmt: skip
    log = ran(BENCH, *changes)
    assert spans(log, REPAIR) == [(20, 25)]
    second = log.of(HELD).where(log.of(HELD)["job"] == 2)
    assert list(zip(second["start_s"], second["end_s"], second["cause"]))[:2] == [(10, 12, cause), (12, 25, IS_DOWN)]
