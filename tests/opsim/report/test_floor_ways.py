"""Ways between places: as long as the layout says."""

from itertools import pairwise
from math import hypot

import pytest
from plans import loaded, plan

from opsim.report.plot.floor_plan import FloorWays
from tests.opsim.study.layout.made_floor import FLOOR

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
