import numpy as np
import pytest
from plans import CELL, queue

from opsim.report.page import Folded, Words
from opsim.report.sections.cycle_times import cycle_times_section as section
from opsim.report.sections.cycle_times import samples
from opsim.report.sections.wip import jobs_inside
from tests.made_result import SCRIPT, distribution, material, summary
from tests.opsim.report.made_floor import charts, floor, renamed, strings, words


@pytest.fixture(scope="module")
def cell():
    return section(floor(CELL))


def test_samples_have_the_quantiles_of_the_histogram():
    row = distribution("duration_s", "lift")
    drawn = samples(row, 1000)
    assert (np.count_nonzero(drawn < 2.5), np.count_nonzero(drawn < 5)) == (206, 722)  # 20 and 70 of 97
    assert drawn.min() > 0 and drawn.max() < 10 and np.all(np.diff(drawn) >= 0)


def test_the_dot_is_the_median_and_the_line_goes_from_p10_to_p90():
    figure = charts(section(material(summary())))["violins-duration_s-0"]
    violin, dot = figure["data"]
    assert violin["type"] == "violin" and len(violin["x"]) <= 400
    assert (dot["x"], dot["error_x"]["array"], dot["error_x"]["arrayminus"]) == ([5.0], [3.0], [3.0])


def test_what_never_varies_is_a_word_and_no_violin(cell):
    assert all("press" not in figure["layout"]["yaxis"]["ticktext"] for figure in charts(cell).values())
    assert "Always the same: press 30.00 s." in words(cell)


def test_stations_stand_along_the_flow(cell):
    assert charts(cell)["violins-cycle_time_s-0"]["layout"]["yaxis"]["ticktext"] == [
        "unload",
        "repack1",
        "repack2",
        "store",
    ]


def test_long_times_do_not_press_short_ones_flat():
    rows = [distribution("duration_s", name) for name in ("a", "b", "c")]
    for row, times in zip(rows, (1.0, 1.2, 40.0)):
        row["quantiles"] = {q: value * times for q, value in row["quantiles"].items()}
        row["histogram"] = {**row["histogram"], "edges": [edge * times for edge in row["histogram"]["edges"]]}
    made = section(material(summary(distributions=rows)))
    names = [figure["layout"]["yaxis"]["ticktext"] for figure in charts(made).values()]
    assert names == [["a", "b"], ["c"]]


def test_every_time_is_in_a_table(cell):
    tables = [block.blocks[0] for block in cell.blocks if isinstance(block, Folded)]
    assert [len(table.rows) for table in tables] == [2, 4, 4]
    assert tables[0].columns[1:8] == ("P5", "P10", "P25", "median", "P75", "P90", "P95")


def test_jobs_that_are_still_inside_are_told_of_where_they_are_many(cell):
    """Every 30 s one comes, every 60 s one leaves: of 960 that come in 8 h some 480 leave."""
    over = floor(queue(horizon="8 h", warm_up="0 s", every="30 s", mean="60 s"))
    inside = int(jobs_inside(over.log).level[-1])
    assert inside > 400 and f"{inside} jobs were still inside, against " in words(section(over))
    assert "still inside" not in words(cell)
    assert words(cell).startswith("Of the jobs") and "that left, half were through within" in words(cell)


def test_without_times_there_is_no_section():
    assert section(material(summary(distributions=[]))) is None
    assert isinstance(section(material(summary())).blocks[-1], Words)


def test_hostile_names_are_no_markup():
    made = section(renamed(floor(CELL), unload=SCRIPT, lift=SCRIPT))
    assert not any("<script" in text for figure in charts(made).values() for text in strings(figure))
