"""A heat map of presence: minutes on the floor, none lost and none made up.

Time spread over a floor: none is lost, and it lies where it was spent.
"""

import re
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plans import loaded, ran

from opsim.report.page import Svg
from opsim.report.plot.floor_plan import FloorWays, floor_map
from opsim.report.sections import occupancy as heat_map
from opsim.report.sections.common import presence
from opsim.report.sections.occupancy import COLOURS, density_of, levels_of, spread
from opsim.report.sections.occupancy import HeatGrid as Grid
from tests.made.result import SCRIPT
from tests.opsim.report.made_material import hostile, of_log, texts
from tests.opsim.study.layout.made_floor import FLOOR


@pytest.fixture(scope="module")
def made():
    log, plan = ran(FLOOR)
    return of_log(log, plan, loaded(FLOOR))


def test_the_heat_of_the_floor_is_the_time_that_people_were_there(made):
    layout = made.loaded.scenario.layout
    there = presence(made.log, made.plan)
    density, cells = density_of(there, made.plan, FloorWays(layout), floor_map(made.plan, layout))
    minutes = density.sum() * cells.cell_m**2
    assert minutes == pytest.approx(there.total / 60) and minutes == pytest.approx(60.0 * len(made.plan.workers))


def test_it_is_hottest_where_somebody_stands_most(made):
    layout = made.loaded.scenario.layout
    there = presence(made.log, made.plan)
    density, cells = density_of(there, made.plan, FloorWays(layout), floor_map(made.plan, layout))
    row, column = np.unravel_index(density.argmax(), density.shape)
    x, y = cells.left_m + (column + 0.5) * cells.cell_m, cells.top_m - (row + 0.5) * cells.cell_m
    assert (x, y) == pytest.approx(layout.places[made.plan.places[int(there.at_place.argmax())]], abs=0.4)


@pytest.mark.parametrize("most, last", [(25.0, 10.0), (31.0, 30.0), (0.02, 0.01), (500.0, 300.0)])
def test_levels_lie_three_times_above_each_other_and_the_last_below_the_most(most, last):
    levels = levels_of(most)
    assert levels[-1] == pytest.approx(last) and len(levels) == len(COLOURS)
    assert all(2.9 < b / a < 3.4 for a, b in pairwise(levels))


def test_the_section_says_where_and_shows_a_legend_in_words(made):
    section = heat_map.occupancy_section(made)
    svg = next(block for block in section.blocks if isinstance(block, Svg))
    assert "most is spent at" in section.blocks[0].text and "goes into walking" in section.blocks[0].text
    assert len(svg.legend) == len(COLOURS) and svg.legend[-1][1].endswith("min an hour on a m²")
    fills = re.findall(r'fill="(#\w+)" shape-rendering', svg.text)
    assert tuple(fills) == COLOURS
    shares = [float(row[2].rstrip(" %")) for row in section.blocks[-1].rows if row[2][0].isdigit()]
    assert sum(shares) == pytest.approx(100, abs=3)


def test_without_rows_there_is_no_section(made):
    assert heat_map.occupancy_section(of_log(None, made.plan, made.loaded, rows=[{"kpi": "x"}])) is None


def test_hostile_names_do_no_harm(made):
    section = heat_map.occupancy_section(of_log(made.log, hostile(made.plan, SCRIPT), made.loaded, [{"kpi": "x"}]))
    svg = next(block for block in section.blocks if isinstance(block, Svg))
    assert "<script" not in svg.text and "&lt;script" in svg.text and SCRIPT[:8] in texts(section)


GRID = Grid(0.0, 5.0, 0.1, (50, 80))
POINTS = st.tuples(st.floats(0, 8), st.floats(0, 5))


@given(st.lists(st.tuples(st.lists(POINTS, min_size=1, max_size=4), st.floats(0, 1e4)), max_size=5), st.floats(0.01, 3))
def test_nothing_is_lost_however_it_is_smoothed(lines, sigma):
    assert spread(GRID, lines, sigma).sum() == pytest.approx(sum(amount for _, amount in lines), abs=1e-6)


def test_a_point_is_a_bell_about_it():
    found = spread(GRID, [(((2.05, 3.05),), 1.0)], 0.4)
    row, column = np.unravel_index(found.argmax(), found.shape)
    assert (row, column) == (19, 20)
    assert found.max() / 0.01 == pytest.approx(1 / (2 * np.pi * 0.4**2), rel=0.01)


def test_a_line_is_even_along_its_length():
    found = spread(GRID, [(((1.0, 2.0), (7.0, 2.0)), 6.0)], 0.2).sum(axis=0)
    assert np.allclose(found[20:60], 0.1, rtol=0.02) and found[:3].sum() < 1e-4
