import pytest
from plans import CELL, plan

from opsim.report.sections.common import of_open, open_share, staffed_h, with_closed
from tests.opsim.study.layout.made_floor import FLOOR

KEPT = "shifts: {s: {from: '00:10', to: '00:50'}}\nworkers: {ana: {shift: s, "
SHIFT = FLOOR.replace("workers: {ana: {", KEPT).replace("{horizon: 1 h", "{start: Mon 00:00, horizon: 2 h")


def test_a_shift_of_forty_minutes_is_a_third_of_two_hours():
    made = plan(SHIFT)
    assert open_share(made) == pytest.approx(1 / 3) and staffed_h(made) == pytest.approx(2 / 3)
    assert with_closed(made) == " of the 2 h counted, closed ones too"


def test_the_open_time_is_no_shorter_than_what_was_done_in_overtime():
    assert open_share(plan(SHIFT), active=0.4) == 0.4


def test_a_floor_without_hours_is_open_all_the_time():
    made = plan(CELL)
    assert (open_share(made), with_closed(made)) == (1.0, "") and staffed_h(made) == pytest.approx(110 / 60)


def test_an_interval_is_scaled_as_its_mean_is():
    row = {"kpi": "x", "mean": 0.1, "low": 0.08, "high": 0.12, "half_width": None}
    assert of_open(row, 0.25) == {"kpi": "x", "mean": 0.4, "low": 0.32, "high": 0.48, "half_width": None}
