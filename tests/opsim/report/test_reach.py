"""The part of a report that shows bodies against their shelves."""

import re

import pytest

from opsim.engine.floor.run import run_plan
from opsim.plan import compile_plan
from opsim.report.page import Grid, Panels
from opsim.report.plot.posture import posture_svg
from opsim.report.sections.reach import postures_of, reach_section
from opsim.scenario import read_scenarios
from tests.opsim.ergonomics.bodies import standing
from tests.opsim.report.made_material import of_log
from tests.opsim.report.test_posture import SKELETON


@pytest.fixture(scope="module")
def rack():
    loaded = read_scenarios("rack_levels", ["base"], {"run.horizon": "12 min", "run.warm_up": "2 min"})["base"]
    plan = compile_plan(loaded)
    return of_log(run_plan(plan, 0), plan, loaded, rows=exposures())


def exposures():
    parts = ("rula_from_5", "rula_from_7", "rula_from_5_at_most")
    return [
        {"kpi": "exposure_by_task", "subject": "pick_low", "part": p, "mean": 4.0, "low": 3, "high": 5} for p in parts
    ]


def test_short_and_tall_stand_at_each_height_the_lowest_first(rack):
    found = postures_of(rack)
    assert [one.target.height_m for one in found] == sorted(one.target.height_m for one in found)
    assert {(one.worker, one.level) for one in found} >= {("ana", "rack.low"), ("ben", "rack.low"), ("ana", "rack.top")}
    low, top = ([one for one in found if one.level == level] for level in ("rack.low", "rack.top"))
    assert min(one.trunk_deg for one in low) > 35 > 10 > max(one.trunk_deg for one in top)
    assert min(one.seconds for one in low) > 1.1 * max(one.seconds for one in found if one.level == "rack.hip")


def test_wrists_are_on_the_board(rack):
    for one in postures_of(rack):
        wrists = [one.skeleton.names.index(f"{side}_wrist") for side in ("left", "right")]
        assert one.joints_m[wrists, 2].mean() == pytest.approx(one.target.height_m, abs=0.005)


def test_the_section_has_a_picture_and_a_row_of_each_and_exposure_where_it_was_asked_for(rack):
    section, n = reach_section(rack), len(postures_of(rack))
    _, pictures, table = section.blocks
    assert isinstance(pictures, Panels) and isinstance(table, Grid) and len(pictures.blocks) == len(table.rows) == n
    assert len(table.columns) <= 7, "one more and it is wider than the page"
    assert "0.30 m, rack.low" in {row[0] for row in table.rows}
    assert "ana, 1.60 m tall" in {one.caption for one in pictures.blocks}
    assert {row[-1] for row in table.rows if row[1] == "pick_low, grasp"} == {"4.00"}
    rack_without = of_log(
        rack.log, rack.plan, rack.loaded, rows=[{"kpi": "throughput_per_h", "subject": "", "mean": 1}]
    )
    assert len(reach_section(rack_without).blocks[-1].columns) == len(table.columns) - 1


def test_without_heights_or_rows_there_is_no_such_section(rack):
    plain = read_scenarios("serial_line", ["base"])["base"]
    plan = compile_plan(plain)
    assert reach_section(of_log(None, plan, plain, rows=exposures())) is None
    assert postures_of(of_log(rack.log, plan, plain, rows=exposures())) == []


def test_a_board_is_drawn_at_its_height_above_the_floor():
    bare, low, high = (posture_svg(standing(), SKELETON, board_m=m, view="side") for m in (None, 0.3, 1.3))

    def top_px(svg):
        return min(
            float(y) for path in re.findall(r'd="([^"]*)" fill="#c3cfdb"', svg) for y in re.findall(r" ([\d.]+)", path)
        )

    assert "#c3cfdb" not in bare and top_px(low) > top_px(high) + 50
