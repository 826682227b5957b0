"""Spaghetti diagrams: to scale, escaped, lines as thick as trips, and the same scale for both."""

import re
from xml.etree import ElementTree

import pytest

from opsim.report.studies.layout_chart import Drawing, Lanes, Line, layout_pictures

PLACES = {"a": (0.0, 0.0), "b": (10.0, 0.0), "c": (10.0, 6.0), "d": (0.0, 6.0)}
NAMES = {"a": "saw", "b": "drill <1>", "d": "pack"}


def drawn(*lines, **more):
    return layout_pictures([Drawing("Now", PLACES, NAMES, lines, **more)])


LINE = re.compile(r'<path d="(M[^"]*)"[^>]*stroke-width="([0-9.]+)" stroke-opacity="[0-9.]+" stroke-linejoin')


def strokes(picture):
    """(width, d) of every line between places."""
    return [(float(width), way) for way, width in LINE.findall(picture)]


def test_the_picture_is_well_formed_and_names_are_escaped():
    picture = drawn(Line("a", "b", 10.0), Line("b", "d", 3.0, driven=True), others={"c": "store & <x>"})
    ElementTree.fromstring(picture)
    assert "drill &lt;1&gt;" in picture and "<1>" not in picture


def test_lines_are_as_thick_as_trips():
    (thick, _), (thin, _) = strokes(drawn(Line("a", "b", 40.0), Line("a", "d", 10.0)))
    assert thick == pytest.approx(4 * thin, abs=0.25)


def test_two_floors_have_one_scale_for_ways_and_for_lines():
    one = Drawing("Now", PLACES, NAMES, [Line("a", "b", 40.0)])
    two = Drawing("Then", PLACES, NAMES, [Line("a", "b", 20.0)], moved=frozenset("b"))
    (first, d), (second, e) = strokes(layout_pictures([one, two]))
    assert first == pytest.approx(2 * second, abs=0.1) and d == e


def test_vehicles_are_told_from_people_without_colour():
    assert 'stroke-dasharray="9 6"' in drawn(Line("a", "b", 1.0, driven=True))
    assert 'stroke-dasharray="9 6"' not in drawn(Line("a", "b", 1.0))


def test_along_paths_trips_add_up_on_each_piece():
    ways = {("a", "c"): ("a", "b", "c"), ("a", "b"): ("a", "b")}
    lines = strokes(drawn(Line("a", "c", 10.0), Line("a", "b", 10.0), distance="paths", ways=ways))
    assert [width for width, _ in lines] == [15.0, 7.5]


def test_a_way_goes_around_what_stands_between():
    marks = [(x - 20.0, -13.0, x + 20.0, 13.0) for x in (0.0, 100.0, 200.0)]
    corners = Lanes(marks, (50.0, 40.0)).way((0.0, 0.0), (200.0, 0.0), 4.0)
    assert len(corners) == 4 and all(abs(y) > 13 for _, y in corners[1:3])


def test_two_ways_between_the_same_rows_run_beside_each_other():
    lanes = Lanes([], (50.0, 40.0))
    one, two = (lanes.way((0.0, 0.0), (100.0, 0.0), 4.0) for _ in range(2))
    assert one != two


@pytest.mark.parametrize(
    "places", [{"a": (0.0, 0.0)}, {"a": (0.0, 0.0), "b": (7.0, 0.0)}, {"a": (3.0, 1.0), "b": (3.0, 9.0)}]
)
def test_floors_of_one_place_or_one_row_are_drawn_too(places):
    lines = [Line("a", "b", 2.0)] if len(places) > 1 else []
    ElementTree.fromstring(layout_pictures([Drawing("Now", places, {"a": "saw"}, lines)]))


def test_long_names_stay_in_their_boxes_and_are_shortened_alike_now_and_then():
    long = {"a": "verpackung mit langem Namen", "b": "mmmmmmmmmmmmmmmmmmmmmm"}
    now, then = Drawing("Now", PLACES, long, []), Drawing("Then", {**PLACES, "e": (9.0, 0.0)}, long, [])
    marks = re.findall(
        r'width="([0-9.]+)" height="26.0".*?text-anchor="middle">([^<]*…[^<]*)<', layout_pictures([now, then])
    )
    assert len(marks) == 4 and [name for _, name in marks[:2]] == [name for _, name in marks[2:]]
    assert all(float(wide) > 15 * 0.6 * len(name) for wide, name in marks)
