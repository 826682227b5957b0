"""Parts of figures in words, and which are shown."""

from opsim.report.parts import is_shown, part_name
from opsim.report.write import report_html
from tests.made_result import kpi, summary

FATES = {"resumed": 0.5, "by_another": 0.0, "handed_over": 0.0}


def broken_off(subject, **per_h):
    return [kpi("interruptions_per_h", subject, part, "1/h", mean, 0.0) for part, mean in per_h.items()]


def test_parts_of_interruptions_are_in_plain_words_and_others_as_they_are():
    assert part_name("interruptions_per_h", "by_another") == "gone on with by another"
    assert part_name("station_states", "blocked") == "blocked" and part_name("interruptions_per_h", "") == ""


def test_a_part_that_is_nothing_everywhere_is_left_out_and_the_total_never():
    assert not is_shown("interruptions_per_h", "open", [{"mean": 0.0}, {"mean": None}])
    assert is_shown("interruptions_per_h", "open", [{"mean": 0.0}, {"mean": 0.1}])
    assert is_shown("interruptions_per_h", "", [{"mean": 0.0}]) and is_shown("stop_share", "jam", [{"mean": 0.0}])


def test_the_report_lists_of_interruptions_what_there_was():
    rows = [kpi("interruptions_per_h", unit="1/h", mean=0.5, half_width=0.0), *broken_off("", **FATES)]
    page = report_html(summary(kpis=[*rows, *broken_off("weld", **FATES)]), {}, {})
    assert page.count("gone on with by the same one") == 2 and "weld · gone on with by the same one" in page
    assert "by_another" not in page and "gone on with by another" not in page and "handed over" not in page
