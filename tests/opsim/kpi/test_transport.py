"""Trips between places: counted by hand, and their metres are those that people walk.

Known answers: a truck that brings two jobs, rows made by hand.

How far people walk.

What lies in stores, what comes there and what is used; what rides on belts.
"""

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.log import BLOCKED, CREATE, FINISH, JOIN, QUEUE, STOCK, TRANSPORT, WALK
from opsim.subjects.people.figures import ends_of_trip, subject_of_trip
from opsim.subjects.transport.figures import transporters
from tests.opsim.kpi.made_logs import found as found_of_stores
from tests.opsim.kpi.made_logs import found as found_of_walking
from tests.opsim.kpi.made_logs import made, row
from tests.opsim.study.layout.made_floor import FLOOR


def trips(log, p):
    found = [figure for figure in figures(log, p, ["trips_per_h"]) if figure.kpi == "trips_per_h"]
    return {(figure.subject, figure.part): figure.value for figure in found}


def test_walks_are_counted_by_their_ends_and_by_what_is_in_hand():
    p = plan(FLOOR.replace("horizon: 1 h", "horizon: 30 min"))
    rank = {place: number for number, place in enumerate(p.places)}
    stations = {station.name: number for number, station in enumerate(p.stations)}
    there, back = (rank["p1"], rank["p5"]), (rank["p5"], rank["p1"])
    rows = [
        row(WALK, 0, 20, worker=0, places=there, job=1, station=stations["drill"]),
        row(TRANSPORT, 0, 20, job=1, station=stations["drill"]),
        row(WALK, 20, 40, worker=0, places=back, job=2, station=stations["saw"]),
        row(WALK, 50, 70, worker=1, places=there, job=3, station=stations["drill"]),
        row(WALK, 80, 80, worker=1, places=(rank["p1"], rank["p1"])),
    ]
    assert trips(made(rows, p), p) == {
        ("p1 > p5", "empty_handed"): 2.0,
        ("p1 > p5", "with_a_job"): 2.0,
        ("p5 > p1", "empty_handed"): 2.0,
    }


def test_trips_times_metres_are_what_people_walk():
    p = plan(FLOOR)
    log = run_plan(p)
    far = dict(zip(p.places, (dict(zip(p.places, row)) for row in p.distance_m)))
    metres = sum(
        value * far[ends_of_trip(name)[0]][ends_of_trip(name)[1]] for (name, _), value in trips(log, p).items()
    )
    walked = sum(figure.value for figure in figures(log, p) if figure.kpi == "walked_m")
    assert metres == pytest.approx(walked, abs=50)  # a walk under way at the end counts in part there, not here


def test_every_job_is_carried_once_from_each_station_to_the_next():
    p = plan(FLOOR)
    log = run_plan(p)
    carried = {name: n for (name, part), n in trips(log, p).items() if part == "with_a_job"}
    done = next(figure.value for figure in figures(log, p) if figure.kpi == "throughput_per_h" and not figure.subject)
    assert set(carried) == {"p1 > p5", "p5 > p3"}
    assert np.allclose(list(carried.values()), done, atol=2)


def test_trips_are_made_only_where_asked_for():
    p = plan(FLOOR)
    assert not [figure for figure in figures(run_plan(p), p) if figure.kpi == "trips_per_h"]


def test_the_ends_of_a_trip_are_read_as_they_were_written():
    assert ends_of_trip(subject_of_trip("bay 7", "b-2")) == ("bay 7", "b-2")


TRUCK = """
opsim: 1
name: truck
run: {horizon: 200 s, warm_up: WARM_UP, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [20 m, 0 m], dock: [0 m, 10 m]}}
tasks: {cut: {fixed: 5 s, automatic: true}, pack: {fixed: 1 s, automatic: true}}
stations: {saw: {at: a, tasks: [cut], buffer: 9}, packer: {at: b, tasks: [pack], buffer: 9}}
transporters:
  truck: {n: 2, at: dock, speed: 2 m/s, load: 3 s, unload: 2 s, legs: [[saw, packer]]}
  idler: {at: a, speed: 1 m/s, legs: [[packer, saw]]}
products: {x: {route: [saw, packer]}}
release: {kind: renewal, every: {fixed: 60 s}}
"""


def found(warm_up="0 s", text=TRUCK):
    p = plan(text.replace("WARM_UP", warm_up))
    return {(f.kpi, f.subject, f.part): f.value for f in transporters(run_plan(p), p)}


def test_states_metres_and_waits_of_two_trips():
    # 65-70 s empty from the dock, 70-73 loaded, 73-83 drive, 83-85 unloaded; 125-130 the other one from the dock (10 m,
    # nearer than 20 m), 130-133, 133-143, 143-145; the third job is cut at 185 s: one from b, 185-195, 195-198, 198-200
    values = found()
    shares = {part: values["transporter_states", "truck", part] for part in ("loaded", "empty", "handling", "free")}
    assert shares == pytest.approx({"loaded": 22 / 400, "empty": 20 / 400, "handling": 13 / 400, "free": 345 / 400})
    assert values["driven_m", "truck", ""] == pytest.approx(2 * 42)
    assert values["pickup_wait_s", "truck", ""] == pytest.approx((8 + 8 + 13) / 3)


def test_the_window_clips_drives_and_counts_jobs_by_their_loading():
    values = found("75 s")
    # left of the first trip: 75-83 loaded, 83-85 unloading
    assert values["transporter_states", "truck", "loaded"] == pytest.approx(20 / 250)
    assert values["driven_m", "truck", ""] == pytest.approx(2 * (8 + 5 + 10 + 10 + 2))
    assert values["pickup_wait_s", "truck", ""] == pytest.approx((8 + 13) / 2)


def test_vehicles_without_work_are_free_and_nobody_waits_for_them():
    values = found()
    assert values["transporter_states", "idler", "free"] == 1
    assert ("pickup_wait_s", "idler", "") not in values


def test_without_transporters_there_are_no_such_figures():
    lines = [line for line in TRUCK.splitlines() if not line.startswith(("transporters", "  truck", "  idler"))]
    assert found(text="\n".join(lines)) == {}


FAR = """
opsim: 1
name: a long walk
run: {horizon: 500 s}
layout: {places: {a: [0 m, 0 m], b: [1000 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {s: {at: b, tasks: [t], buffer: 0}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {w: {skills: {s: 1.0}, home: a, walk: 1 m/s}, z: {skills: {s: 1.0}, home: a, walk: 0.7 m/s}}
"""


def walked_m(log, p):
    return [found_of_walking(log, p)["walked_m", worker.name, ""] for worker in p.workers]


def test_a_walk_cut_by_the_horizon_counts_as_far_as_it_went():
    p = plan(FAR)
    assert walked_m(run_plan(p), p) == [500, 0]


def test_a_walk_across_the_end_of_the_warm_up_counts_from_there():
    p = plan(FAR.replace("500 s", "2000 s, warm_up: 400 s"))
    assert walked_m(run_plan(p), p) == [600, 0]


def test_a_whole_walk_is_the_whole_way_although_time_has_a_grid():
    p = plan(FAR.replace("500 s", "2000 s").replace("w: {skills: {s: 1.0}, ", "w: {skills: {}, "))
    assert walked_m(run_plan(p), p) == [0, 1000]


def test_a_way_of_no_length_is_none():
    p = plan(FAR)
    assert walked_m(made([row(WALK, 0, 5, worker=0, places=(0, 0))], p), p) == pytest.approx([0, 0])


STORES_FLOOR = """
opsim: 1
name: stores
run: {horizon: 3620 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {a: {at: here, tasks: [t]}, b: {at: here, tasks: [t]}}
stores: {rack: {at: here}}
conveyors: {belt: {from: here, to: there, speed: 1 m/s, pitch: 2 m}}
products:
  bolt: {lot: 10, route: [a, rack]}
  nut: {route: [a, rack]}
  whole: {route: [belt, b], parts: {b: {bolt: 2, nut: 1}}}
sources:
  bolts: {kind: poisson, every: 20 s, products: [bolt]}
  nuts: {kind: poisson, every: 20 s, products: [nut]}
  wholes: {kind: poisson, every: 20 s, products: [whole]}
"""
BELT, RACK = 2, 3
BOLT, NUT, WHOLE = range(3)


def values(*rows):
    p = plan(STORES_FLOOR)
    assert [place.name for place in p.stations] == ["a", "b", "belt", "rack"]
    created = {(r[8], r[9]) for r in rows if r[8] >= 0}
    return found_of_stores(made([*rows, *(row(CREATE, 10, 10, job=job, product=of) for job, of in created)], p), p)


def stock(job, product, start, end):
    return row(QUEUE, start, end, station=RACK, job=job, product=product, cause=STOCK)


def used(job, product, at):
    return row(JOIN, at, at, station=1, job=job, product=product)


ROWS = [
    stock(0, BOLT, 15, 120),
    used(0, BOLT, 120),
    stock(1, BOLT, 60, 160),
    used(1, BOLT, 160),
    stock(2, NUT, 3600, 3620),
    used(3, NUT, 500),
]


def test_stock_is_the_mean_over_the_window_in_all_and_by_product():
    figures = values(*ROWS)
    assert figures["stock", "rack", "bolt"] == pytest.approx(200 / 3600)
    assert figures["stock", "rack", ""] == pytest.approx(220 / 3600)
    assert figures["stock_empty", "rack", "bolt"] == pytest.approx(1 - 140 / 3600)
    assert figures["stock_empty", "rack", ""] == pytest.approx(1 - 160 / 3600)


def test_parts_are_counted_in_units_where_they_come_and_where_they_are_used():
    """A nut that is taken as it comes counts as stored; a bolt that came before the window does not."""
    figures = values(*ROWS)
    assert figures["parts_used_per_h", "bolt", ""] == 20 and figures["parts_used_per_h", "nut", ""] == 1
    assert figures["stored_per_h", "bolt", ""] == 10 and figures["stored_per_h", "nut", ""] == 2
    assert figures["time_to_store_s", "bolt", ""] == 50
    assert figures["time_to_store_s", "nut", ""] == (490 + 3590) / 2


def test_what_ends_in_a_store_has_no_throughput_of_its_own():
    figures = values(*ROWS, row(FINISH, 200, 200, job=5, product=WHOLE))
    assert figures["throughput_per_h", "", ""] == 1
    assert {key[1] for key in figures if key[0] in ("throughput_per_h", "lead_time_s")} == {"", "whole"}


def test_a_lot_counts_as_its_units():
    p = plan(STORES_FLOOR.replace("whole: {", "whole: {lot: 4, "))
    log = made([row(CREATE, 30, 30, job=5, product=WHOLE), row(FINISH, 200, 200, job=5, product=WHOLE)], p)
    assert found_of_stores(log, p)["throughput_per_h", "", ""] == 4


def test_a_belt_is_blocked_while_the_job_at_its_end_finds_no_room():
    rows = [
        row(TRANSPORT, 100, 200, station=BELT, job=5, product=WHOLE),
        row(BLOCKED, 200, 290, station=BELT, job=5, product=WHOLE),
        row(QUEUE, 190, 300, station=BELT, job=6, product=WHOLE),
    ]
    figures = values(*rows)
    assert figures["on_conveyor", "belt", ""] == pytest.approx(300 / 3600)
    assert figures["conveyor_blocked", "belt", ""] == pytest.approx(90 / 3600)
