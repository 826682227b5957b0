from opsim.report.page import Legend, Section
from opsim.report.sections.exposure import MOST_WORKERS as MOST
from opsim.report.sections.exposure import exposure_blocks
from opsim.report.sections.exposure_summary import FIVE, PERHAPS, SEVEN
from tests.made_result import SCRIPT
from tests.opsim.report.made_exposure import ROWS, by, levels


def charts(rows):
    return Section("exposure", "", exposure_blocks(rows, 0.95)).charts


def test_the_section_has_a_figure_of_everything_that_has_more_than_one_bar():
    assert list(charts(ROWS)) == ["exposure_workers", "exposure_by_hour", "exposure_by_task", "exposure_by_region"]
    (legend,) = (block for block in exposure_blocks(ROWS, 0.95) if isinstance(block, Legend))
    assert legend.entries == [SEVEN, FIVE, PERHAPS]


def test_without_scores_there_is_no_section():
    assert exposure_blocks([], 0.95) == []


def test_of_many_workers_those_with_most_are_shown_in_their_order():
    rows = [row for n in range(MOST + 5) for row in levels(f"w{n}", 0, n, n)]
    assert charts([*levels("", 1, 2, 3), *rows])["exposure_workers"]["layout"]["yaxis"]["ticktext"] == [
        f"w{n}" for n in range(5, MOST + 5)
    ]


def test_no_name_becomes_markup_in_a_figure():
    rows = [*levels("", 1, 2, 3), *levels(SCRIPT, 1, 2, 3), *by("exposure_by_task", SCRIPT, 1, 2, 3)]
    assert "<script" not in str(charts(rows))
