from opsim.report.exposure import MOST, exposure_section
from opsim.report.exposure_bars import FIVE, PERHAPS, SEVEN
from tests.made_result import SCRIPT
from tests.opsim.report.made_exposure import ROWS, by, levels


def test_the_section_has_a_figure_of_everything_that_has_more_than_one_bar():
    drawn = {}
    section = exposure_section(ROWS, drawn)
    assert list(drawn) == ["exposure_workers", "exposure_by_hour", "exposure_by_task", "exposure_by_region"]
    assert [figure["id"] for figure in section["figures"]] == list(drawn)
    assert section["legend"] == [SEVEN, FIVE, PERHAPS]


def test_without_scores_there_is_no_section():
    drawn = {}
    assert exposure_section([], drawn) is None and drawn == {}


def test_of_many_workers_those_with_most_are_shown_in_their_order():
    rows = [row for n in range(MOST + 5) for row in levels(f"w{n}", 0, n, n)]
    drawn = {}
    exposure_section([*levels("", 1, 2, 3), *rows], drawn)
    assert drawn["exposure_workers"]["layout"]["yaxis"]["ticktext"] == [f"w{n}" for n in range(5, MOST + 5)]


def test_no_name_becomes_markup_in_a_figure():
    rows = [*levels("", 1, 2, 3), *levels(SCRIPT, 1, 2, 3), *by("exposure_by_task", SCRIPT, 1, 2, 3)]
    drawn = {}
    exposure_section(rows, drawn)
    assert "<script" not in str(drawn)
