import pytest

from opsim.report.numbers import clock, digits, interval_cells, kpi_name, listing, plus_minus, quantity
from tests.made_result import kpi


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
