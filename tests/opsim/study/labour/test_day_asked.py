"""What a day is: scheduled hours, and how many of them a run has."""

import pytest

from opsim.plan import compile_plan
from opsim.study.labour.daily_output import day_asked, hours_and_days
from tests.opsim.study.labour.made import LINE, loaded

ALWAYS_OPEN = LINE.replace(", shift: early", "").replace(", absence: 0.1", "")


@pytest.mark.parametrize(("text", "hours", "days"), [
    (LINE, 0.4, 1),  # 24 min of a shift
    (LINE.replace("horizon: 24 min", "horizon: 24 h"), 8, 1),
    (LINE.replace("horizon: 24 min", "horizon: 3 d"), 8, 3),
    (LINE.replace("horizon: 24 min", "horizon: 2 d").replace("to: 14:00", "to: 02:00"), 20, 2),  # past midnight
    (ALWAYS_OPEN, 0.4, 1),
    (ALWAYS_OPEN.replace("horizon: 24 min", "horizon: 48 h"), 24, 2),
])  # fmt: skip
def test_a_day_has_its_scheduled_hours(tmp_path, text, hours, days):
    assert hours_and_days(compile_plan(loaded(tmp_path, text))) == (pytest.approx(hours), days)


def test_a_target_of_a_figure_is_in_its_own_unit(tmp_path):
    plan = compile_plan(loaded(tmp_path))
    asked = day_asked("time_in_system_s <= 300", plan)
    assert (asked.kpi, asked.hours, asked.a_day) == ("time_in_system_s", 1.0, False)
    assert day_asked(None, plan).a_day and day_asked("4 a day", plan).hours == pytest.approx(0.4)
