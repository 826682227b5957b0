from opsim.report.sections.exposure_summary import FIVE, PERHAPS, SEVEN, Bar, bars_of_workers, level_bars
from opsim.report.sections.exposure_summary import bar_legend as legend
from tests.opsim.report.made_exposure import ROWS


def test_the_parts_of_a_bar_end_at_the_most_there_may_be():
    figure = level_bars(bars_of_workers(ROWS))
    parts = [trace for trace in figure["data"] if trace["type"] == "bar"]
    assert [trace["name"] for trace in parts] == [SEVEN[1], FIVE[1], PERHAPS[1]]
    assert [sum(values) for values in zip(*(trace["x"] for trace in parts))] == [30.0, 18.0]
    (line,) = [trace for trace in figure["data"] if trace["type"] == "scatter"]
    assert line["x"] == [25.0, 15.0] and line["error_x"]["array"] == [0.5, 0.5]


def test_bars_of_hours_stand_upright_and_one_replication_has_no_line():
    figure = level_bars([Bar("06:00", 1.0, 2.0, 2.0)], upright=True)
    assert [trace["type"] for trace in figure["data"]] == ["bar", "bar"] and figure["data"][0]["y"] == [1.0]
    assert legend([Bar("06:00", 0.0, 2.0, 2.0)]) == [FIVE]


def test_nothing_at_all_is_still_a_figure():
    assert level_bars([Bar("ana", 0.0, 0.0, 0.0)])["data"]
