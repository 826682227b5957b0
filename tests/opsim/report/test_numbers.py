import pytest

from opsim.report.numbers import (
    clock,
    digits,
    interval_cells,
    kpi_name,
    listing,
    percent,
    plus_minus,
    quantity,
    rough,
    three_digits,
)
from opsim.report.plot.svg_chart import LONGEST, places, shortened
from opsim.report.sections.learning_fatigue import learned_over_all, tired_over_all
from opsim.report.sections.summary import sentences
from tests.made.result import kpi, summary


@pytest.mark.parametrize(
    ("value", "said"), [(9.6191, "9.62"), (145.4, "145"), (1204.4, "1,204"), (999.7, "1,000"), (0.0, "0"), (23.0, "23")]
)
def test_three_digits_are_enough(value, said):
    assert three_digits(value) == said


def test_an_amount_has_the_unit_of_people():
    assert (rough(1384.0), rough(45.6, of=500.0), percent(0.356)) == ("23.1 min", "0.76 min", "36 %")


def box(place, name):
    x, y, anchor = place
    left = x if anchor == "start" else x - 8 * len(name)
    return left, y - 12, left + 8 * len(name), y + 3.5


def shared(a, b):
    return max(0, min(a[2], b[2]) - max(a[0], b[0])) * max(0, min(a[3], b[3]) - max(a[1], b[1]))


def test_names_of_points_that_are_near_each_other_do_not_cover_each_other():
    at, names = [(100, 100), (104, 102), (97, 98)], ["one of them", "another", "a third"]
    found = [box(place, name) for place, name in zip(places(at, names, [], 400), names)]
    assert all(shared(a, b) == 0 for i, a in enumerate(found) for b in found[:i])


def test_a_name_at_the_edge_stands_inside():
    ((x, _, anchor),) = places([(390, 50)], ["at the edge"], [], 400)
    assert anchor == "end" and x < 390


def test_a_place_that_is_taken_is_avoided():
    (free,) = places([(100, 100)], ["name"], [], 400)
    (other,) = places([(100, 100)], ["name"], [box(free, "name")], 400)
    assert shared(box(other, "name"), box(free, "name")) == 0


def test_a_long_name_is_cut():
    assert len(shortened("n" * 60)) == LONGEST and shortened("short") == "short"


def test_throughput_says_of_what():
    assert kpi_name("throughput_per_h") == "Throughput (good units)"
    assert kpi_name("throughput_per_h", hours=True) == "Throughput (good units), per scheduled hour"
    assert kpi_name("time_in_system_s", hours=True) == kpi_name("time_in_system_s")


@pytest.mark.parametrize("half_width", [0.0, 3e-17])
def test_an_interval_of_no_width_is_written_in_one_way_whatever_rounding_left_of_it(half_width):
    assert plus_minus(kpi("x", unit="share", mean=0.26, half_width=half_width)) == "26.00 ± 0 %"
    cells = interval_cells(kpi("x", unit="share", mean=0.26, half_width=half_width))
    assert (cells["mean"], cells["interval"]) == ("26.00", "26.00 to 26.00")
    assert plus_minus(kpi("x", unit="share", mean=0.0, half_width=0.0)) == "0 ± 0 %"


@pytest.mark.parametrize(
    "value, half_width, said",
    [
        (60.123, 1.04, "60.1"),
        (60.123, 0.66, "60.1"),
        (60.123, 6.6, "60"),
        (0.7, 0.025, "0.700"),
        (12345.6, 40.0, "12,346"),
        (-0.001, 1.0, "0.0"),
        (-3.2, 1.0, "−3.2"),
        (2.5678, None, "2.568"),
        (5.0, 0.0, "5.000"),
        (87.204106, 0.000032, "87.204"),
        (2.756183, 1e-6, "2.7562"),
        (-0.000002, 0.000001, "−0.000002"),
        (None, 1.0, "–"),
        (float("nan"), 1.0, "–"),
        (float("inf"), None, "–"),
    ],
)
def test_digits_are_those_the_half_width_supports(value, half_width, said):
    assert digits(value, half_width) == said


@pytest.mark.parametrize(
    "value, unit, said",
    [
        (0.825, "share", "82.50 %"),
        (1384, "s", "23.07 min"),
        (83, "s", "83.00 s"),
        (9000, "s", "2.500 h"),
        (5400, "m", "5.400 km"),
        (60, "1/h", "60.00 per hour"),
        (None, "s", "–"),
    ],
)
def test_quantities_stand_in_the_unit_people_use(value, unit, said):
    assert quantity(value, unit) == said


def test_a_kpi_row_shows_mean_interval_and_relative_half_width():
    cells = interval_cells(kpi("x", unit="s", mean=600.0, half_width=6.0))
    assert cells == {"mean": "10.00", "interval": "9.90 to 10.10", "relative": "1 %", "unit": "min", "n": "20"}


def test_one_replication_has_no_interval():
    cells = interval_cells(kpi("x", mean=5.0, half_width=None, n=1))
    assert (cells["mean"], cells["interval"], cells["relative"]) == ("5.000", "one replication", "–")


def test_a_kpi_without_any_value_says_so():
    assert interval_cells(kpi("x", mean=None, half_width=None, n=0))["interval"] == "no value in any replication"


def test_rows_of_one_figure_share_the_unit_of_the_largest():
    assert plus_minus(kpi("walked_m", unit="m", mean=500.0, half_width=10.0), 5000.0) == "0.500 ± 0.010 km"


def test_an_unknown_kpi_loses_its_unit_and_underscores():
    assert kpi_name("spine_load_kg") == "Spine load"
    assert kpi_name("time_in_system_s") == "Time in system"
    assert kpi_name("_s") == "_s"


def test_the_clock_runs_over_midnight_and_the_week():
    assert clock("Mon 06:00", 1800) == "Mon 06:30"
    assert clock("Sun 22:00", 3 * 3600) == "Mon 01:00"
    assert clock("some day", 7200) == "2 h after some day"


def test_a_half_width_below_the_last_digit_of_its_mean_is_rounded_up_to_it():
    assert plus_minus(kpi("x", unit="share", mean=0.87204106, half_width=3.2e-7)) == "87.204 ± 0.001 %"
    assert plus_minus(kpi("x", unit="s", mean=60.123, half_width=1.04)) == "60.1 ± 1.0 s"


def test_a_list_reads_as_a_sentence():
    assert [listing(words) for words in ([], ["a"], ["a", "b", "c"])] == ["", "a", "a, b and c"]


def test_the_summary_gives_each_figure_with_its_interval():
    first, worker, station, certainty = sentences(summary())
    assert first == (
        "60.1 (59.1 to 61.1) jobs an hour are finished, a job stays 23.1 min (22.1 to 24.1) and 7.10 jobs "
        "(6.90 to 7.30) are inside on average."
    )
    assert worker == "The busiest worker is ana: 82.0 % (81.0 to 83.0) of the time at work."
    assert "most often blocked is weld: 20.0 % (19.0 to 21.0)" in station
    assert certainty.startswith("20 replications, counted from Mon 06:30 to Mon 14:00; in brackets the 95 %")


def test_where_hours_are_kept_and_stock_lies_the_first_sentence_says_so():
    rows = [*summary()["kpis"], kpi("stock", "shelf", unit="jobs")]
    first = sentences(summary(kpis=rows, scheduled_h=6.5))[0]
    assert first.startswith("60.1 (59.1 to 61.1) jobs per scheduled hour are finished")
    assert first.endswith("are inside on average, stock included.")


def test_one_replication_is_said_to_prove_nothing():
    alone = [kpi("throughput_per_h", unit="1/h", mean=60.0, half_width=None, n=1)]
    first, certainty = sentences(summary(kpis=alone, replications=1))
    assert first == "60.00 jobs an hour are finished."
    assert "there is no interval" in certainty


def test_without_figures_only_the_certainty_is_left():
    assert len(sentences(summary(kpis=[]))) == 1


def test_with_shifts_the_busiest_worker_is_so_of_his_time_on_duty():
    duty = [
        kpi("duty_use", name, unit="share", mean=mean, half_width=0.01) for name, mean in (("ana", 0.5), ("ben", 0.9))
    ]
    all_of_them = kpi("duty_use", unit="share", mean=0.95, half_width=0.01)
    found = sentences(summary(kpis=[*summary()["kpis"], all_of_them, *duty]))
    assert found[1] == (
        "The busiest worker is ben: at work or on the way for 90.0 % (89.0 to 91.0) of the time on duty, breaks aside."
    )


def test_overtime_and_absence_are_said_where_there_were_some():
    def said(over, missed):
        rows = [kpi("overtime_h", unit="h", mean=over, half_width=None), kpi("absent_share", unit="share", mean=missed)]
        return sentences(summary(kpis=rows))[:-1]

    assert said(0.0, 0.0) == []
    assert said(2.5, 0.0) == ["After their shifts people stay for 2.500 h in all."]
    assert said(0.0, 0.05)[0].startswith("5") and said(0.0, 0.05)[0].endswith("of the time of shifts is missed.")


def row(subject, mean, half=0.01, part="", n=8):
    ends = {} if half is None else {"low": mean - half, "high": mean + half}
    return {"subject": subject, "part": part, "mean": mean, "n": n, "low": None, "high": None} | ends


def test_the_most_tired_are_told_with_their_intervals_over_all_replications():
    rows = [row("", 0.3), row("ana", 0.18), row("ben", 0.19), row("ben", 0.4, part="neck")]
    assert list(tired_over_all(rows)) == [
        "The highest fatigue in the mean over 8 replications, with intervals: ben 19.0 % (18.0 to 20.0); "
        "ana 18.0 % (17.0 to 19.0)."
    ]


def test_what_is_left_to_learn_is_told_by_task():
    rows = [row("ana", 0.5), row("ana", 0.43, part="wire"), row("bo", 0.61, part="mount")]
    (said,) = learned_over_all(rows)
    assert "bo, mount 61.0 % (60.0 to 62.0); ana, wire 43.0 % (42.0 to 44.0)." in said


def test_one_replication_says_nothing_of_all():
    assert not list(tired_over_all([row("ana", 0.2, None, n=1)])) and not list(learned_over_all([]))
