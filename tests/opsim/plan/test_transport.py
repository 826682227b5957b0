"""What belts, vehicles and loads become as numbers."""

import pytest
from plans import plan

TEXT = """
opsim: 1
name: moves
run: {horizon: 1 h, seed: 1}
layout: {places: {a: [0 m, 0 m], b: [3 m, 4 m], c: [20 m, 0 m], dock: [0 m, 20 m]}}
tasks: {t: {fixed: 5 s, automatic: true}}
stations: {one: {at: a, tasks: [t], buffer: 1}, two: {at: c, tasks: [t], buffer: 1}}
conveyors: {belt: {from: a, to: b, speed: 0.5 m/s, pitch: 1 m}}
transporters: {truck: {at: dock, speed: 2 m/s, legs: [[belt, two], [one, two]]}}
products: {x: {route: [one, belt, two], mass: 500 g}, y: {share: 1, route: [one, two]}}
release: {kind: saturated}
workers: {w: {most_load: 12 kg, home: a}}
""".replace("x: {route", "x: {share: 0.5, route").replace("share: 1,", "share: 0.5,")


def test_a_belt_is_the_straight_line_between_its_ends_and_stands_among_the_stations():
    p = plan(TEXT)
    (belt,) = p.conveyors
    assert (p.stations[belt.station].name, p.stations[belt.station].kind) == ("belt", "conveyor")
    assert (belt.travel_s, belt.headway_s, p.places[belt.place_to]) == (10.0, 2.0, "b")


@pytest.mark.parametrize(
    ("length", "pitch", "capacity"), [("5 m", "1 m", 5), ("5 m", "0.9 m", 6), ("0.3 m", "0.1 m", 3), ("1 m", "1 m", 1)]
)
def test_a_belt_holds_its_length_over_its_pitch_rounded_up(length, pitch, capacity):
    p = plan(TEXT.replace("pitch: 1 m", f"pitch: {pitch}, length: {length}"))
    assert p.conveyors[0].capacity == p.stations[p.conveyors[0].station].capacity == capacity


def test_a_leg_from_a_belt_begins_where_jobs_get_off():
    p = plan(TEXT)
    names = [station.name for station in p.stations]
    legs = {(names[leg.before], names[leg.after]): leg for leg in p.transporters[0].legs}
    assert p.places[legs["belt", "two"].place_from] == "b" and p.places[legs["belt", "two"].place_to] == "c"
    assert p.places[legs["one", "two"].place_from] == "a"


def test_vehicles_drive_as_people_walk_or_along_roads_of_their_own():
    p = plan(TEXT)
    a, b, c, dock = (p.places.index(name) for name in ("a", "b", "c", "dock"))
    assert p.transporters[0].drive_s(dock, c) == 20.0
    own = plan(TEXT.replace("legs:", "roads: [[dock, a, b], {from: a, to: c, length: 60 m}], legs:"))
    assert own.transporters[0].drive_s(dock, c) == 40.0 and own.transporters[0].drive_s(dock, b) == 12.5
    assert own.distance_m == p.distance_m and own.transporters[0].drive_s(c, a) == 30.0


def test_loads_and_masses_stand_with_workers_and_products():
    p = plan(TEXT)
    assert p.workers[0].most_load_kg == 12.0
    assert [product.mass_kg for product in p.products] == [0.5, None]


def test_without_belts_and_vehicles_a_plan_has_none():
    text = "\n".join(line for line in TEXT.splitlines() if not line.startswith(("conveyors", "transporters")))
    p = plan(text.replace("[one, belt, two]", "[one, two]"))
    assert p.conveyors == p.transporters == ()
