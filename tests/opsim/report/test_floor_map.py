"""The floor in a picture: to scale, with names that can be read."""

from itertools import combinations
from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st
from plans import loaded, plan

from opsim.report.plot.floor_plan import CROWDED, SMALL, FloorMap, floor_map, names_of, picture, round_below
from opsim.report.plot.floor_plan_lines import Spot
from opsim.report.plot.svg_chart import shared
from opsim.scenario.read import read_scenarios
from opsim.shipped import shipped_folder
from tests.made_result import IMAGE, SCRIPT
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
