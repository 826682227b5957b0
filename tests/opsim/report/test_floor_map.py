"""The floor in a picture: to scale, with names that can be read.

Lines along the axes: beside each other, and round what stands in their way where they can.

Ways between places: as long as the layout says.

Trips and metres of each way: those of the figures.
"""

from dataclasses import replace
from itertools import combinations, pairwise
from math import hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plans import CELL, loaded, plan, ran

from opsim.kpi import figures
from opsim.log import WALK
from opsim.report.plot.floor_plan import CROWDED, SMALL, FloorMap, FloorWays, floor_map, names_of, picture, round_below
from opsim.report.plot.floor_plan_lines import Laid, Spot, rounded
from opsim.report.plot.svg_chart import shared
from opsim.report.sections.common import flow_order, walked_ways, worked_on
from opsim.report.sections.walking import LONGEST_M, draw_walk, walk_sentences, words
from opsim.report.sections.walking import FootWalk as Walk
from opsim.scenario.read import read_scenarios
from opsim.shipped import shipped_folder
from tests.made.result import IMAGE, SCRIPT
from tests.opsim.kpi.made_logs import made, row
from tests.opsim.made_walks import SKELETON
from tests.opsim.made_walks import Walk as Model
from tests.opsim.study.layout.made_floor import FLOOR

POINTS = st.tuples(st.floats(-80, 80).map(lambda x: round(x, 1)), st.floats(-40, 40).map(lambda y: round(y, 1)))


def layout_of(text):
    return plan(text), loaded(text).scenario.layout


@given(st.lists(POINTS, min_size=2, max_size=25, unique=True), st.sampled_from([760.0, SMALL]))
def test_the_map_is_to_scale_and_within_its_frame(points, room):
    on = FloorMap(tuple(Spot(point, (f"s{n}",)) for n, point in enumerate(points)), room=room)
    for a, b in combinations(points, 2):
        (x, y), (u, v) = on.at(a), on.at(b)
        assert hypot(u - x, v - y) == pytest.approx(hypot(b[0] - a[0], b[1] - a[1]) * on.px_per_m)
    left, bottom, right, top = on.corners
    for corner in ((left, top), (right, bottom)):
        x, y = on.at(corner)
        assert -1e-6 <= x <= on.wide + 1e-6 <= room + 2e-6 and 0 <= y <= on.tall - 40


def test_what_stands_at_a_place_names_it_and_stations_come_before_places():
    p, layout = layout_of(FLOOR)
    on = floor_map(p, layout)
    assert names_of(on, p, layout) == ["door", "saw", "p2", "pack", "p4", "drill"]
    assert {spot.name: spot.kind for spot in on.spots}["saw"] == "station"


def test_crossings_of_paths_have_no_name():
    paths = "layout:\n  distance: paths\n  paths: [[p1, p2, p3, p4, p5], [door, p1]]\n"
    p, layout = layout_of(FLOOR.replace("layout:\n", paths))
    on = floor_map(p, layout)
    assert [spot.at for spot in on.spots if not spot.name] == [(5.0, 0.0), (15.0, 0.0)] and len(on.roads) == 5


def test_a_floor_of_one_point_is_not_drawn():
    text = FLOOR.replace("[5 m, 0 m]", "[0 m, 0 m]")
    for x in ("10 m, 0 m", "15 m, 0 m", "20 m, 0 m", "0 m, 9 m"):
        text = text.replace(f"[{x}]", "[0 m, 0 m]")
    assert floor_map(*layout_of(text)) is None


@pytest.mark.parametrize("file", ["pump_plant.yaml", "two_shift_plant.yaml", "eight_station_cell.yaml"])
def test_few_names_overlap_on_the_floors_that_are_shipped(file):
    from opsim.plan import compile_plan

    one = read_scenarios(shipped_folder() / file)["base"]
    on = floor_map(compile_plan(one), one.scenario.layout)
    boxes = on.taken[len(on.marks) :]
    assert not on.numbered and boxes
    assert max(shared(a, b) for a, b in combinations(boxes, 2)) <= CROWDED


def test_where_names_would_hide_each_other_places_are_numbered_and_told_below():
    crowd = tuple(Spot((x, y), (f"a rather long name {x} {y}",)) for x in range(12) for y in range(12))
    on = FloorMap(crowd, room=SMALL)
    assert on.numbered and on.key.startswith("1 a rather long name 0 0; 2 ")
    assert ">144</text>" in picture(on, [], "")


def test_names_are_escaped():
    drawn = picture(FloorMap((Spot((0.0, 0.0), (SCRIPT,), "station"), Spot((9.0, 3.0), (IMAGE,), "store"))), [], IMAGE)
    assert "<script" not in drawn and "<img" not in drawn and drawn.count("<svg") == 1


@pytest.mark.parametrize("value, below", [(1.0, 1.0), (9.99, 5.0), (0.37, 0.2), (2500, 2000.0), (0.0, 1.0)])
def test_round_numbers_are_not_above(value, below):
    assert round_below(value) == below


FLOOR_LINES_POINTS = st.tuples(st.integers(0, 60).map(lambda n: 10.0 * n), st.integers(0, 40).map(lambda n: 10.0 * n))


@given(st.lists(st.tuples(FLOOR_LINES_POINTS, FLOOR_LINES_POINTS, st.floats(1, 13)), max_size=12))
def test_a_line_joins_its_ends_along_the_axes(wanted):
    laid = Laid([], 5.0)
    for start, end, width in wanted:
        corners = laid.line(start, end, width)
        assert corners[0] == start and corners[-1] == end
        assert all(a[0] == b[0] or a[1] == b[1] for a, b in pairwise(corners))
        assert rounded(corners).startswith(f"M{start[0]:.1f} {start[1]:.1f}") if len(corners) > 1 else start == end


def test_the_same_way_twice_lies_beside_itself():
    laid = Laid([], 5.0)
    first, second = (laid.line((0.0, 0.0), (100.0, 0.0), 4.0) for _ in range(2))
    assert first == [(0.0, 0.0), (100.0, 0.0)] and second != first


def test_of_two_corners_the_one_without_a_station_is_taken():
    corners = Laid([(100.0, 0.0)], 5.0).line((0.0, 0.0), (100.0, 80.0), 2.0)
    assert (0.0, 80.0) in corners


PATHS = FLOOR.replace("layout:\n", "layout:\n  distance: paths\n  paths: [[p1, p2, p3, p4, p5], [door, p1]]\n")


@pytest.mark.parametrize("text", [FLOOR, PATHS, FLOOR.replace("layout:\n", "layout:\n  distance: euclidean\n")])
def test_the_line_of_a_way_is_as_long_as_the_way(text):
    p, ways = plan(text), FloorWays(loaded(text).scenario.layout)
    for a, start in enumerate(p.places):
        for b, end in enumerate(p.places):
            line = ways.line(start, end)
            long = sum(hypot(v[0] - u[0], v[1] - u[1]) for u, v in pairwise(line))
            assert long == pytest.approx(p.distance_m[a][b])
            assert line[0] == ways.places[start] and line[-1] == ways.places[end]


def test_along_paths_one_passes_the_places_between():
    ways = FloorWays(loaded(PATHS).scenario.layout)
    assert ways.passed("door", "p3") == ("door", "p1", "p2", "p3") and ways.passed("p1", "p1") == ("p1", "p1")


LINE = """
opsim: 1
name: order
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {z: {at: here, tasks: [t], buffer: 1}, a: {at: here, tasks: [t]}, m: {at: here, tasks: [t]},
           b: {at: here, tasks: [t]},
           cut: {at: here, tasks: [t]}}
stores: {shelf: {at: here, initial: {part: 3}}}
products:
  long: {route: [z, m, a, b], parts: {a: {part: 1}}}
  short: {route: [z, a]}
  part: {route: [cut, shelf]}
sources: {in: {kind: saturated, products: [long, short]}, more: {kind: base_stock, store: shelf, level: 3}}
"""


def names(text, order):
    p = plan(text)
    return [p.stations[rank].name for rank in order(p)]


def test_stations_stand_along_the_flow_and_parts_ahead_of_what_they_go_into():
    assert names(LINE, flow_order) == ["cut", "shelf", "z", "m", "a", "b"]
    assert names(LINE, worked_on) == ["cut", "z", "m", "a", "b"]


def test_a_station_that_only_some_visit_stands_where_they_do():
    assert names(LINE.replace("route: [z, a]}", "route: [z, b]}"), flow_order)[2:] == ["z", "m", "a", "b"]
    assert names(
        LINE.replace("long: {route: [z, m, a, b]", "long: {route: [z, a, b]").replace(
            "short: {route: [z, a]}", "short: {route: [z, m, b]}"
        ),
        flow_order,
    )[2:] == ["z", "m", "a", "b"]


def test_every_point_is_there_once():
    assert sorted(names(CELL, flow_order)) == sorted(["unload", "repack1", "repack2", "store"])


def made_walk(distance_m=4.0, speed=1.0, worker="ana", n_times=121):
    """A walk in even steps of 0.5 m, feet that stay."""
    condition = {"distance_m": distance_m, "speed_m_per_s": speed}
    drawn = Model().sample(1, np.random.default_rng(0), condition=condition)
    positions_m, contact = drawn.positions_m(n_times=n_times)[0], drawn.contact(n_times=n_times)[0]
    return Walk(worker, "bench to rack", distance_m, distance_m / speed, positions_m, contact, SKELETON)


def test_feet_that_stay_do_not_slide():
    assert made_walk().slide_mm < 1e-9


def test_a_foot_that_creeps_while_it_bears_is_said_to_slide():
    """By 1 mm a frame, both feet: the longest stance is 0.5 s, two steps of four each a second."""
    walk = made_walk()
    creeping = walk.positions_m + np.array([0.001, 0, 0]) * np.arange(121)[:, None, None]
    slid = replace(walk, positions_m=creeping).slide_mm
    longest = max(stance.stop - stance.start for side in (0, 1) for stance in walk.stances(side))
    assert slid == pytest.approx(longest - 1, rel=0.03)


def test_a_foot_that_rolls_over_its_toe_does_not_slide():
    walk = made_walk()
    ankle = list(SKELETON.names).index("left_ankle")
    rolled = walk.positions_m.copy()
    rolled[:, ankle, 0] += 0.05 * np.sin(np.arange(121))
    assert replace(walk, positions_m=rolled).slide_mm < 1e-9


def test_steps_are_counted_and_measured_from_one_foot_to_the_other():
    walk = made_walk()
    assert walk.footfalls_m == pytest.approx(0.5 * np.arange(1, 9)) and walk.step_length_m == pytest.approx(0.5)
    assert walk.cadence_per_min == pytest.approx(8 * 60 / 4)


def test_a_walk_in_any_direction_is_drawn_from_left_to_right():
    walk = made_walk()
    turn = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1.0]])
    turned = replace(walk, positions_m=walk.positions_m @ turn + np.array([3.0, -2.0, 0.0]))
    assert np.allclose(turned.along_m, walk.along_m)
    assert turned.slide_mm == pytest.approx(walk.slide_mm, abs=1e-9)


def test_the_words_say_speed_step_cadence_and_sliding():
    said = words(made_walk(speed=1.25))
    assert said.startswith("1.25 m/s, steps of 0.50 m, 150 a minute; ") and "slide by at most 0" in said


def test_a_picture_is_the_same_for_the_same_walk_and_holds_no_foreign_markup():
    picture = draw_walk(made_walk(worker=SCRIPT), 4.0)
    assert picture == draw_walk(made_walk(worker=SCRIPT), 4.0) and picture.startswith(b"<svg")
    assert SCRIPT.encode() not in picture


@pytest.mark.parametrize("distance_m", [0.6, 30.0])
def test_short_and_long_walks_are_drawn_too(distance_m):
    walk = made_walk(distance_m, n_times=901)
    assert len(draw_walk(walk, distance_m)) < 3e6 and (distance_m < LONGEST_M or walk.along_m[-1, 0, 0] > LONGEST_M)


def said(rows, walks=((0, "p1", "p5"),)):
    p = plan(FLOOR)
    at = p.places.index
    log = made(
        [row(WALK, 100 * n, 100 * n + 20, worker=w, places=(at(a), at(b))) for n, (w, a, b) in enumerate(walks)], p
    )
    return list(walk_sentences(walked_ways(log, p), p, p.places, rows))


def of(name, mean, half=None):
    ends = {"low": None, "high": None} if half is None else {"low": mean - half, "high": mean + half}
    return {"subject": name, "mean": mean} | ends


def test_who_walks_most_is_said_with_its_interval():
    assert said([of("ana", 1000.0, 50.0), of("ben", 400.0, 20.0)])[0] == (
        "ana walks most: 1,000 (950 to 1,050) m an hour; ben least, 400 (380 to 420)."
    )


def test_where_closed_hours_are_counted_that_is_said():
    shift = "shifts: {s: {from: '00:10', to: '00:50'}}\nworkers: {ana: {shift: s, "
    p = plan(FLOOR.replace("workers: {ana: {", shift).replace("{horizon: 1 h", "{start: Mon 00:00, horizon: 2 h"))
    log = made([row(WALK, 700, 720, worker=0, places=(p.places.index("p1"), p.places.index("p5")))], p)
    (said,) = walk_sentences(walked_ways(log, p), p, p.places, [])
    assert "m an hour of the 2 h counted, closed ones too, 100 %" in said


def test_who_does_not_walk_and_who_walks_alike_is_said():
    assert said([of("ana", 10.0), of("ben", 0.0)])[0].endswith("ben not at all.")
    assert said([of("ana", 10.0), of("ben", 10.0)])[0].endswith("all walk as far.")
    assert len(said([of("ana", 10.0)])) == 1


def test_the_way_walked_most_is_that_of_most_metres():
    walks = [(0, "p1", "p5"), (0, "p1", "p2"), (1, "p2", "p1"), (1, "p2", "p1")]
    assert said([], walks) == [
        "In the first replication most is walked between p1 and p5: 1 trip and 20 m an hour, 57 % of all that people "
        "walk between places."
    ]


@pytest.fixture(scope="module")
def floor():
    return ran(FLOOR.replace("horizon: 1 h", "horizon: 1 h, warm_up: 10 min"))


def test_trips_both_ways_are_counted_together_by_worker():
    p = plan(FLOOR.replace("horizon: 1 h", "horizon: 30 min"))
    a, b = p.places.index("p1"), p.places.index("p5")
    rows = [
        row(WALK, 0, 20, worker=0, places=(a, b)),
        row(WALK, 20, 40, worker=0, places=(b, a)),
        row(WALK, 50, 70, worker=1, places=(a, b)),
        row(WALK, 80, 80, worker=1, places=(a, a)),
    ]
    found = walked_ways(made(rows, p), p)
    low, high = min(a, b), max(a, b)
    assert found.by_pair() == [(low, high, 6.0, pytest.approx(6 * 20.0))]
    assert list(found.shares(low, high)) == [(0, pytest.approx(2 / 3)), (1, pytest.approx(1 / 3))]


def test_trips_are_those_of_the_figures(floor):
    log, p = floor
    told = {}
    for one in figures(log, p, ["trips_per_h"]):
        if one.kpi == "trips_per_h" and one.part != "driven":
            key = frozenset(one.subject.split(" > "))
            told[key] = told.get(key, 0.0) + one.value
    found = {frozenset((p.places[a], p.places[b])): trips for a, b, trips, _ in walked_ways(log, p).by_pair() if trips}
    assert found == {key: pytest.approx(value) for key, value in told.items()} and len(found) > 2


def test_metres_of_each_worker_are_those_of_the_figures(floor):
    log, p = floor
    hours = 5 / 6
    told = [one.value for one in figures(log, p) if one.kpi == "walked_m" and one.subject]
    assert np.allclose(walked_ways(log, p).by_worker(len(p.workers)) * hours, told)


def test_where_nobody_walks_there_is_no_way():
    p = plan(FLOOR)
    assert walked_ways(made([], p), p).by_pair() == []
