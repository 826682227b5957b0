"""Overall equipment effectiveness.

Work a job gets in a visit to a station.

How evenly work is spread.

What each stop costs, by hand.

How often stations stop, how long, and until when nobody repaired.

What servers do, where a station can be set up, down, short of parts or tools, or shared by several jobs.
"""

from itertools import groupby
from math import isnan, sqrt

import numpy as np
import pytest
from plans import CELL, line, plan

from opsim import log as kinds
from opsim.engine.floor.run import run_plan
from opsim.kpi.cycle_times import cycle_times, task_durations, visits
from opsim.kpi.states import possible_states as possible
from opsim.kpi.states import station_states
from opsim.kpi.throughput import line_balance
from opsim.log import BLOCKED, BREAKDOWN, CREATE, DOWN, HELD, MAINTENANCE, REPAIR, SCRAP, SETUP, WORK
from opsim.subjects.breakdowns.figures import Stretches, stops
from tests.opsim.kpi.made_logs import found, made, row, work

ONE = """
opsim: 1
name: one station
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {a: {at: here, tasks: [t], servers: 2, buffer: 1}, b: {at: here, tasks: [t]}}
products: {p: {route: [a, b]}}
release: {kind: saturated}
workers: {w: {skills: {a: 1.0, b: 1.25}}}
"""


def test_slow_work_of_half_the_time_by_hand():
    """16 s for each 10 s of plan; of the first only half lies in the window; the last is cut at 3/8 of its 16 s."""
    p = plan(ONE)
    rows = [work(12, 28, 0), work(28, 44, 0, job=1), work(94, 100, 0, job=2, progress=(0.0, 0.375))]
    values = found(made([*rows, row(HELD, 50, 60, station=0, job=2)], p), p)
    assert values["oee", "a", ""] == pytest.approx((5 + 10 + 3.75) / 160)
    assert values["oee_factor", "a", "speed"] == pytest.approx(10 / 16)
    assert values["oee_factor", "a", "use"] == pytest.approx((8 + 16 + 6) / 160)
    assert values["oee", "b", ""] == 0 and isnan(values["oee_factor", "b", "speed"])


def test_a_better_skill_is_speed():
    p = plan(ONE)
    values = found(run_plan(p), p)
    assert values["oee_factor", "a", "speed"] == pytest.approx(1)
    assert values["oee_factor", "b", "speed"] == pytest.approx(1.25)


def test_oee_is_its_factors_and_use_is_the_share_of_work():
    p = plan(CELL)
    values = found(run_plan(p), p)
    for station in p.stations:
        factor = {part: value for (kpi, of, part), value in values.items() if (kpi, of) == ("oee_factor", station.name)}
        assert values["oee", station.name, ""] == factor["availability"] * factor["performance"] * factor["quality"]
        assert factor["performance"] == pytest.approx(factor["speed"] * factor["use"])
        assert factor["use"] == pytest.approx(values["station_states", station.name, "work"])
        assert 0 < factor["performance"] < 1


TWICE = """
opsim: 1
name: twice at one station
run: {horizon: 100 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true, repeat: 2}}
stations: {a: {at: here, tasks: [t], buffer: 0}}
products: {p: {route: [a, a]}}
release: {kind: saturated}
"""
ONE_OF_FIVE = """
opsim: 1
name: waits for a worker between two tasks
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {heat: {fixed: 10 s, automatic: true}, fit: {fixed: 60 s}}
stations: {a: {at: here, tasks: [heat, fit], servers: 5, buffer: 0}}
products: {p: {route: [a]}}
release: {kind: saturated}
workers: {w: {skills: {a: 1.0}}}
"""


def naive_cycle_times(log, p):
    """Job by job, station by station: the performances in time, cut after every visit's number of them."""
    rows = [{name: log[name][i] for name in log.columns} for i in range(len(log)) if log["kind"][i] == WORK]
    rows.sort(key=lambda one: (one["job"], one["station"], one["start_s"]))
    times = {station.name: [] for station in p.stations}
    for (_job, rank), stay in groupby(rows, key=lambda one: (one["job"], one["station"])):
        station = p.stations[rank]
        needed = sum(p.tasks[task].repeat for task in station.tasks)
        got_s, n_done = 0.0, 0
        for one in stay:
            got_s += one["end_s"] - one["start_s"]
            n_done += one["progress_to"] == 1
            if n_done == needed:
                if p.window_s[0] <= one["end_s"] < p.window_s[1]:
                    times[station.name].append(got_s)
                got_s, n_done = 0.0, 0
    return times


def test_two_visits_in_a_row_are_two():
    p = plan(TWICE)
    assert set(cycle_times(run_plan(p), p)["a"]) == {20.0}


def test_a_visit_under_way_at_the_horizon_does_not_count():
    p = plan(ONE_OF_FIVE)
    assert np.mean(cycle_times(run_plan(p), p)["a"]) == 70.0


def test_a_performance_in_two_pieces_is_one_and_begins_no_visit():
    p = plan(TWICE)
    pieces = [work(0, 4, 0, progress=(0.0, 0.4)), work(20, 26, 0, progress=(0.4, 1.0)), work(26, 36, 0)]
    next_visit = [work(36, 46, 0), work(46, 56, 0), work(56, 60, 0, job=1, progress=(0.0, 0.4))]
    log = made(pieces + next_visit, p)
    assert cycle_times(log, p)["a"].tolist() == [20, 20]
    assert visits(log, p).whole.tolist() == [True, True, False]
    assert task_durations(log, p)["t"].tolist() == [10, 10, 10]


def test_no_work_is_no_visit():
    p = plan(TWICE)
    assert cycle_times(made([], p), p)["a"].size == 0


@pytest.mark.parametrize(
    "text",
    [
        CELL,
        CELL.replace("[repack1, repack2], store]", "repack1, repack1, store, unload]"),
        TWICE,
        line(3, 0, horizon="1500 s"),
    ],
)
def test_visits_are_those_of_the_naive_twin(text):
    p = plan(text)
    log = run_plan(p)
    naive = naive_cycle_times(log, p)
    for station, seconds in cycle_times(log, p).items():
        assert np.sort(seconds) == pytest.approx(np.sort(naive[station]), abs=1e-9)
    assert sum(map(len, naive.values())) > 3


LINE = """
opsim: 1
name: three stations
run: {horizon: 1 h, warm_up: 5 min}
layout: {places: {here: [0 m, 0 m]}}
tasks:
  ten: {fixed: 10 s, automatic: true}
  twenty: {fixed: 10 s, automatic: true, repeat: 2}
  thirty: {fixed: 30 s, automatic: true}
stations:
  a: {at: here, tasks: [ten]}
  b: {at: here, tasks: [twenty]}
  c: {at: here, tasks: [thirty]}
products: {p: {route: [a, b, c]}}
release: {kind: poisson, every: 2 min}
"""


def balance(text):
    p = plan(text)
    return [f.value for f in line_balance(run_plan(p), p)]


def test_ten_twenty_and_thirty_seconds():
    assert balance(LINE) == pytest.approx([60 / 90, 1 / 3, sqrt(20**2 + 10**2)])


def test_each_server_is_a_place_with_its_share_of_the_work():
    assert balance(LINE.replace("[thirty]", "[thirty], servers: 2")) == pytest.approx(
        [60 / 80, 1 / 4, sqrt(10**2 + 5**2 + 5**2)]
    )


def test_a_job_that_comes_twice_brings_its_work_twice():
    assert balance(LINE.replace("[a, b, c]", "[a, b, a, c]")) == pytest.approx([70 / 90, 2 / 9, sqrt(10**2 + 10**2)])


def test_even_stations_lose_nothing():
    even = LINE.replace("30 s", "10 s").replace("repeat: 2", "repeat: 1")
    assert balance(even) == pytest.approx([1, 0, 0])


def test_a_station_on_no_route_does_not_count():
    assert balance(LINE.replace("[a, b, c]", "[a, b]")) == pytest.approx([30 / 40, 1 / 4, 10])


def test_a_station_that_finished_no_visit_leaves_the_balance_unknown():
    assert all(isnan(value) for value in balance(LINE.replace("30 s", "2 h")))


TEXT = """
opsim: 1
name: one machine
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 10 s, automatic: true}}
stations:
  m:
    at: hall
    tasks: [press]
    buffer: 1
    breakdowns: {jam: {every: {fixed: 15 s}, repair: {fixed: 7 s}, team: crew}}
    maintenance: {oil: {every: 90 s, lasts: 3 s, when: at_once}}
products: {part: {route: [m]}}
release: {kind: saturated}
repair_teams: {crew: {n: 2}}
"""


def stops_found(text):
    p = plan(text)
    return {(f.kpi, f.subject, f.part): f.value for f in stops(run_plan(p), p)}


def test_the_time_of_each_stop_inside_the_window_stands_under_its_name():
    """Repairs 15-22, 37-44, 59-66, 81-88, of which 2 + 7 + 7 + 7 s in the window of 80 s; oil 90-93."""
    values = stops_found(TEXT)
    assert values["stop_share", "m", "jam"] == pytest.approx(23 / 80)
    assert values["stop_share", "m", "oil"] == pytest.approx(3 / 80)
    assert values["repair_team_use", "crew", ""] == pytest.approx(23 / 160)


def test_a_floor_that_never_stops_has_no_such_figures():
    bare = "\n".join(line for line in TEXT.split("\n") if not any(w in line for w in ("jam", "oil", "repair_")))
    assert stops_found(bare) == {}


SHOP = """
opsim: 1
name: shop
run: {horizon: 3620 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations:
  a:
    at: here
    tasks: [t]
    servers: 2
    setup: {otherwise: 5 s, attended: false}
    scrap: 0.1
    breakdowns: {jam: {every: {fixed: 50 s}, repair: {fixed: 10 s}, team: men}}
    maintenance: {oil: {every: 100 s, lasts: 5 s}}
  b: {at: here, tasks: [t]}
repair_teams: {men: {}}
products: {p: {route: [a, b]}}
release: {kind: poisson, every: 20 s}
"""


def stop(kind, start, end, cause=BREAKDOWN, k=0):
    p = plan(SHOP)
    task = next(one.task for one in (p.breakdowns if cause == BREAKDOWN else p.maintenance))
    return row(kind, start, end, station=0, task=task, k=k, cause=cause)


def values(*rows):
    p = plan(SHOP)
    return found(made(rows, p), p)


STOPS = [
    stop(REPAIR, 0, 10),
    stop(DOWN, 100, 130, k=1),
    stop(REPAIR, 130, 140, k=1),
    stop(REPAIR, 200, 260, MAINTENANCE),
    stop(DOWN, 400, 410, k=2),
    stop(REPAIR, 410, 500, k=2),
    stop(DOWN, 3600, 3620, k=3),
]


def test_stops_are_counted_where_they_begin_and_timed_where_they_end():
    """In the window two breakdowns end, of 40 s and 100 s, and a third begins; 160 s of breakdowns, 60 of care."""
    figures = values(*STOPS)
    assert figures["stops_per_h", "a", "breakdown"] == 3 and figures["stops_per_h", "a", "maintenance"] == 1
    assert figures["down_s", "a", "breakdown"] == 70 and figures["down_s", "a", "maintenance"] == 60
    assert figures["wait_for_repair_s", "a", "breakdown"] == 20
    assert figures["mean_time_between_failures_s", "a", ""] == (3600 - 160 - 60) / 3


def test_a_station_that_cannot_stop_says_nothing_and_one_that_did_not_has_no_mean():
    figures = values()
    assert not [key for key in figures if key[0] == "stops_per_h" and key[1] == "b"]
    assert figures["stops_per_h", "a", "breakdown"] == 0 and isnan(figures["down_s", "a", "breakdown"])


def test_seconds_that_meet_an_outage_are_found_in_one_go():
    outages = Stretches(np.array([10.0, 40.0]), np.array([20.0, 45.0]))
    from_s, to_s = np.array([0, 0, 15, 20, 12, 0]), np.array([5, 15, 42, 40, 18, 100])
    assert outages.meet_s(from_s, to_s).tolist() == [0, 5, 7, 0, 6, 15]


def test_oee_loses_breakdowns_and_set_ups_to_availability_and_scrap_to_quality():
    """Two servers, 7200 s; care takes 120 s of them out of the plan; stops 320 s, a set-up 80 s; 5 jobs, one scrap."""
    jobs = [work(1000 + 20 * n, 1016 + 20 * n, 0, job=n) for n in range(5)]
    scrap = row(SCRAP, 1096, 1096, station=0, job=4)
    created = [row(CREATE, 999, 999, job=n) for n in range(5)]
    figures = values(*STOPS, *jobs, *created, scrap, row(SETUP, 900, 980, station=0, job=0))
    factor = {part: value for (kpi, of, part), value in figures.items() if (kpi, of) == ("oee_factor", "a")}
    available_s = 7200 - 120 - 320 - 80
    assert factor["availability"] == pytest.approx(available_s / (7200 - 120))
    assert factor["performance"] == pytest.approx(50 / available_s)
    assert factor["speed"] == pytest.approx(50 / 80) and factor["use"] == pytest.approx(80 / available_s)
    assert factor["quality"] == pytest.approx(4 / 5)
    assert figures["oee", "a", ""] == pytest.approx(50 / (7200 - 120) * 4 / 5)


FLOOR = """
opsim: 1
name: states
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
flow: {blocking: before}
stations:
  a:
    at: here
    tasks: [t]
    servers: 2
    buffer: 3
    needs: {gun: 1}
    setup: {otherwise: 5 s, attended: false}
    breakdowns: {jam: {every: {fixed: 50 s}, repair: {fixed: 10 s}}}
  oven: {at: there, tasks: [t], servers: 2, buffer: 9, batch: {size: 3}, blocking: after}
  plain: {at: there, tasks: [t], blocking: after}
tools: {gun: {n: 2}}
stores: {rack: {at: here}}
transporters: {cart: {at: here, speed: 1 m/s, legs: [[a, oven]]}}
products:
  nut: {route: [plain, rack]}
  p: {route: [a, oven, plain], parts: {a: {nut: 1}}}
  q: {route: [a, oven, plain]}
sources: {nuts: {kind: poisson, every: 30 s, products: [nut]}, wholes: {kind: poisson, every: 20 s, products: [p, q]}}
"""
A, OVEN = 0, 1


def states(*rows, station="a"):
    """part -> seconds of a server in the window."""
    p = plan(FLOOR)
    log = made(rows, p)
    found = {f.part: f.value for f in station_states(log, p) if (f.kpi, f.subject) == ("station_states", station)}
    assert sum(found.values()) == pytest.approx(1)
    return {part: pytest.approx(share * 160) for part, share in found.items() if share and part != "starved"}


def test_only_the_states_that_a_station_can_be_in_are_told():
    p = plan(FLOOR)
    assert possible(p, 0) == {"setup", "down", "parts", "tool", "place", "pickup"}
    assert p.stations[2].name == "plain" and possible(p, 2) == set()


@pytest.mark.parametrize(
    ("kind", "cause", "part"),
    [
        (SETUP, 0, "setup"),
        (BLOCKED, 0, "blocked"),
        (HELD, kinds.NO_WORKER, "waiting"),
        (HELD, kinds.NO_PARTS, "parts"),
        (HELD, kinds.NO_TOOL, "tool"),
        (HELD, kinds.NO_PLACE, "place"),
        (HELD, kinds.PICKUP, "pickup"),
    ],
)
def test_what_a_job_on_a_server_waits_for_is_told(kind, cause, part):
    rows = [row(kind, 10, 30, station=A, job=0, cause=cause), row(kind, 50, 70, station=A, job=1, cause=cause)]
    assert states(*rows) == {part: 30}


def test_a_station_that_is_down_is_nothing_else():
    """Both servers from 40 to 60: five seconds nobody is there, then somebody; what stood there does not count."""
    rows = [
        work(30, 40, A, progress=(0, 0.5)),
        row(HELD, 40, 60, station=A, job=0, cause=kinds.IS_DOWN),
        row(BLOCKED, 35, 65, station=A, job=1),
        row(kinds.DOWN, 40, 45, station=A, cause=kinds.BREAKDOWN),
        row(kinds.REPAIR, 45, 60, station=A, cause=kinds.BREAKDOWN),
    ]
    assert states(*rows) == {"work": 10, "blocked": 10, "down": 10, "repair": 30}


def test_the_first_of_a_batch_stands_for_all_of_it():
    rows = [work(30, 40, OVEN), *(row(HELD, 30, 40, station=OVEN, job=n, cause=kinds.BATCH) for n in (1, 2))]
    assert states(*rows, station="oven") == {"work": 10}


def test_a_server_that_a_batch_shares_is_blocked_until_the_last_has_left():
    """Six end at once on two servers; from 60 on there are so few of them that one server may be free."""
    ends = (45, 50, 60, 62, 65, 70)
    rows = [row(BLOCKED, 40, end, station=OVEN, job=n) for n, end in enumerate(ends)]
    assert states(*rows, station="oven") == {"blocked": 20 + 30}


def test_shares_of_a_run_sum_to_one_and_none_is_negative():
    p = plan(FLOOR.replace("100 s", "1 h"))
    sums: dict[str, float] = {}
    for figure in station_states(run_plan(p), p):
        if figure.kpi == "station_states":
            assert figure.value >= -1e-12
            sums[figure.subject] = sums.get(figure.subject, 0) + figure.value
    assert sums == pytest.approx({"a": 1, "oven": 1, "plain": 1})
