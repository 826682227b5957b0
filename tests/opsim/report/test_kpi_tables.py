from opsim.report.page import Grid, flat
from opsim.report.sections.summary import MOST, in_front
from opsim.report.sections.summary import kpi_section as section
from tests.made_result import kpi, material, summary


def walked(n):
    return [kpi("walked_m", f"w{i}", unit="m", mean=100.0 + i, headline=True) for i in range(n)]


def test_a_figure_of_few_stands_in_front_with_each_of_them():
    rows = walked(MOST)
    assert in_front(rows) == (rows, {})


def test_of_a_figure_of_many_the_whole_stays_and_each_is_folded_away():
    whole = kpi("walked_m", unit="m", headline=True)
    front, folded = in_front([whole, *walked(MOST + 1)])
    assert front == [whole] and len(folded["walked_m"]) == MOST + 1


def test_of_what_nobody_sums_the_most_and_the_least_stay():
    front, _ = in_front(walked(MOST + 5))
    assert [row["subject"] for row in front] == [f"w{MOST + 4}", "w0"]


def test_every_row_of_the_summary_stands_in_a_table_of_seven_columns():
    made = material(summary(kpis=[*summary()["kpis"], *walked(MOST + 1)]))
    front, folded, *_ = tables = [block for block in flat(section(made).blocks) if isinstance(block, Grid)]
    assert front.title == "" and folded.title == f"Walked, each of {MOST + 1}"
    assert front.columns[3] == "95 % interval" and all(len(row) == 7 for table in tables for row in table.rows)
    assert {"work", "blocked"} <= {row[1].split(" · ")[-1] for table in tables for row in table.rows}
