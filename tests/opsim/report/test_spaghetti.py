"""The ways that people walk, in a report."""

import re

import pytest
from plans import loaded, ran

from opsim.report.page import Panels, Svg, flat
from opsim.report.sections import spaghetti
from tests.made_result import SCRIPT
from tests.opsim.report.made_material import hostile, of_log, texts
from tests.opsim.study.layout.made_floor import FLOOR

PATHS = FLOOR.replace("layout:\n", "layout:\n  distance: paths\n  paths: [[p1, p2, p3, p4, p5], [door, p1]]\n")


def material(text=FLOOR):
    log, plan = ran(text)
    return of_log(log, plan, loaded(text))


@pytest.fixture(scope="module")
def found():
    return spaghetti.spaghetti_section(material())


def test_who_walks_most_and_which_way_is_said(found):
    first, second = (block.text for block in found.blocks[:2])
    assert first.startswith("ben walks most: ") and "ana least" in first
    assert "between saw and drill" in second or "between drill and pack" in second


def test_a_line_is_as_thick_as_it_is_walked_often(found):
    drawn = next(block for block in found.blocks if isinstance(block, Svg)).text
    lines = re.findall(r'stroke-width="([\d.]+)"[^>]*><title>[^<]*: ([\d.,]+) trips', drawn)
    often = [(float(trips), float(wide)) for wide, trips in lines]
    assert len(often) > 2 and sorted(often) == sorted(often, key=lambda one: (one[1], one[0]))


def test_each_worker_has_a_picture_and_the_table_has_all_ways(found):
    panels = next(block for block in found.blocks if isinstance(block, Panels))
    assert [one.title.split(",")[0] for one in panels.blocks] == ["ana", "ben"]
    table = found.blocks[-1]
    assert table.columns[2] == "trips an hour" and any(row[0] in ("saw – drill", "drill – saw") for row in table.rows)


def test_along_paths_trips_add_up_on_every_stretch():
    made = material(PATHS)
    found = spaghetti.spaghetti_section(made)
    drawn = next(block for block in found.blocks if isinstance(block, Svg)).text
    stretches = {
        title: float(trips) for title, trips in re.findall(r"<title>([^<:]*): ([\d.,]+) trips an hour</title>", drawn)
    }
    assert stretches and all("–" in title for title in stretches)
    assert not any("saw – drill" in title for title in stretches)  # p2, p3 and p4 lie between


def test_without_rows_or_walks_there_is_no_section():
    made = material()
    made.log = None
    assert spaghetti.spaghetti_section(made) is None
    alone = (
        FLOOR.replace("carried: true", "carried: false")
        .replace("home: door, ", "")
        .replace("ben: {like: ana, ", "ben: {like: ana, walk: 1 m/s, ")
    )
    one_place = alone.replace("at: p5", "at: p1").replace("at: p3", "at: p1")
    assert spaghetti.spaghetti_section(material(one_place)) is None


def test_hostile_names_do_no_harm():
    log, plan = ran(FLOOR)
    section = spaghetti.spaghetti_section(of_log(log, hostile(plan, SCRIPT), loaded(FLOOR)))
    svgs = [block.text for block in flat(section.blocks) if isinstance(block, Svg)]
    assert len(svgs) == 3 and not any("<script" in svg for svg in svgs) and SCRIPT[:8] in texts(section)
