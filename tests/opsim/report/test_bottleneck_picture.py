import numpy as np
import pytest
from plans import CELL, line

from opsim.report.bottleneck_picture import CELLS, moments, section
from opsim.report.time_axis import at_ms
from tests.made_result import SCRIPT
from tests.opsim.kpi.made_logs import work
from tests.opsim.report.made_floor import bars, charts, floor, renamed, strings, words

THREE = line(3, 0, horizon="40 s", warm_up="0 s")
ROWS = [work(0, 10, 0), work(6, 20, 1), work(12, 16, 2), work(30, 35, 1, job=1), work(32, 34, 2, job=1)]
"""The first station 0-10, the second 6-20 and 30-35, the third within the second's."""


@pytest.fixture(scope="module")
def slow():
    text = line(3, 1, horizon="6000 s").replace("t2: {dist: exponential, mean: 1 s}", "t2: {fixed: 3 s}")
    return floor(text)


def test_the_strip_shows_who_was_it_when():
    made = floor(THREE, rows=ROWS)
    edges_s, rank = moments(made.log, made.plan)
    assert [(a, b, r) for a, b, r in zip(edges_s, edges_s[1:], rank.tolist())] == [
        (0, pytest.approx(6), 0),
        (pytest.approx(6), pytest.approx(20), 1),
        (pytest.approx(20), pytest.approx(30), -1),
        (pytest.approx(30), pytest.approx(35), 1),
        (pytest.approx(35), 40, -1),
    ]
    drawn = [(row, begin, end) for row, begin, end, _ in bars(charts(section(made))["bottleneck-strip"])]
    start = made.plan.start_s
    assert drawn == [(row, *at_ms(start, span).tolist()) for row, span in ((0, (0, 6)), (1, (6, 20)), (1, (30, 35)))]


def test_bars_are_the_shares_of_the_table_and_sum_to_one_with_what_is_left(slow):
    figure = charts(section(slow))["bottleneck-shares"]
    rows = {(row["subject"], row["part"]): row["mean"] for row in slow.rows("bottleneck")}
    sole = sum(end - begin for _, begin, end, name in bars(figure) if name.startswith("alone"))
    assert sole / 100 + rows["", "shifting"] + rows["", "none"] == pytest.approx(1, abs=0.02)


def test_moments_tile_the_run(slow):
    edges_s, rank = moments(slow.log, slow.plan)
    assert (edges_s[0], edges_s[-1]) == (0, slow.plan.horizon_s) and rank.size <= CELLS
    assert np.all(np.diff(edges_s) > 0) and np.all(rank[1:] != rank[:-1])


def test_the_slowest_station_is_named_with_what_it_means(slow):
    said = words(section(slow))
    assert said.startswith("s2 is the bottleneck for") and "So it sets the pace: time saved at s2" in said
    assert "Ahead of it stations are blocked for" in said and "behind it they have no job for" in said


def test_where_it_moves_that_is_said():
    said = words(section(floor(line(3, 1, horizon="6000 s"))))
    assert "No station holds up the floor by itself: it moves between" in said


def test_where_nobody_is_busy_no_station_is_blamed():
    calm = floor(CELL, ("every: 40 s", "every: 200 s"))
    assert "no station is busy on all its servers" in words(section(calm))


def test_one_station_cannot_be_narrower_than_others():
    assert section(floor(line(1, 1, horizon="600 s", warm_up="10 s"))) is None


def test_without_rows_the_shares_stand_alone():
    assert list(charts(section(floor(CELL, keeps_rows=False)))) == ["bottleneck-shares"]


def test_hostile_names_are_no_markup():
    made = section(renamed(floor(CELL), unload=SCRIPT, repack1=SCRIPT + "2"))
    assert not any("<script" in text for figure in charts(made).values() for text in strings(figure))
