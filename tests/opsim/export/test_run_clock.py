from datetime import date, datetime, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.export.tables import MONDAY, RunClock, monday_of


def test_the_run_begins_on_its_day_of_the_week_of_a_stated_monday():
    tuesday_six = 86_400.0 + 6 * 3600.0
    assert date(2026, 1, 5) == MONDAY and MONDAY.weekday() == 0
    assert RunClock(tuesday_six).texts(np.array([0.0, 90.5])) == [
        "2026-01-06T06:00:00.000000Z",
        "2026-01-06T06:01:30.500000Z",
    ]


@given(st.lists(st.floats(0, 1e7), max_size=20), st.floats(0, 604_799))
def test_every_time_is_right_to_the_microsecond_and_in_its_own_order(times_s, start_s):
    texts = RunClock(start_s).texts(np.array(times_s))
    began = datetime(2026, 1, 5)
    for text, time_s in zip(texts, times_s, strict=True):
        exact_us = round(start_s * 1e6) + round(time_s * 1e6)
        assert (datetime.fromisoformat(text[:-1]) - began) // timedelta(microseconds=1) == exact_us


@pytest.mark.parametrize(
    ("text", "says"), [("2026-01-06", "Tuesday"), ("2026-13-01", "no date"), ("Monday", "no date")]
)
def test_another_day_than_a_monday_is_refused_with_one_that_is(text, says):
    with pytest.raises(ValueError, match=says):
        monday_of(text)
    with pytest.raises(ValueError, match="such as 2026-01-05"):
        monday_of("2026-01-06")
    assert monday_of("2026-03-02") == date(2026, 3, 2)
