"""Parts of figures in words, and which are shown."""

from opsim.report.sections.common import is_shown, part_name, without_again
from tests.made_result import kpi, page, summary

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
    text = page(summary(kpis=[*rows, *broken_off("weld", **FATES)]))
    assert text.count("gone on with by the same one") == 2 and "weld · gone on with by the same one" in text
    assert "by_another" not in text and "gone on with by another" not in text and "handed over" not in text


def test_nothing_of_a_figure_that_has_parts_alone_is_an_answer_and_the_unknown_none():
    for name in ("rest_allowance_share", "iso_11226_min_per_h", "exposure_gini"):
        assert is_shown(name, "murrell", [{"mean": 0.0}]) and not is_shown(name, "murrell", [{"mean": None}])
    rows = [kpi("iso_11226_min_per_h", "ana", "trunk", "min/h", 0.0, 0.0)]
    assert "Held beyond ISO 11226" in page(summary(kpis=rows))


def test_what_there_is_at_most_is_left_out_where_it_is_what_there_is_at_least():
    rows = [
        kpi("rest_allowance_share", "ana", part, "share", mean)
        for part, mean in [("murrell", 0.1), ("murrell_at_most", 0.1), ("price", 0.1), ("price_at_most", 0.2)]
    ]
    alone = kpi("lifting_index", "lift", "at_most", "", 2.0)
    assert without_again([*rows, alone]) == [rows[0], rows[2], rows[3], alone]


def test_the_report_leaves_them_out_too():
    rows = [kpi("rula_mean", "ana", part, "", 3.0) for part in ("", "at_most")]
    text = page(summary(kpis=[*rows, kpi("rula_p90", "ana", "", "", 3.0)]))
    assert "at most" not in text and "Other figures: bodies" in text and "Other figures: flow" not in text
