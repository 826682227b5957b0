"""Trips between places: counted by hand, and their metres are those that people walk."""

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.kpi import figures
from opsim.kpi.workers import ends_of_trip, subject_of_trip
from opsim.log import TRANSPORT, WALK
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
