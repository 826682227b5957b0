"""Amounts and limits as people write them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.kpi.catalogue import AskedFigure as Asked
from opsim.kpi.targets import LimitText, amount, bounds, check_indifference, percent, read_limit, unit_of


@pytest.mark.parametrize(("said", "unit", "found"), [
    (2, "1/h", 2.0), ("2 an hour", "1/h", 2.0), ("0.5/h", "1/h", 0.5), ("20 s", "s", 20.0), ("1 min 30 s", "s", 90.0),
    ("3 km", "m", 3000.0), ("2 h", "h", 2.0), ("5 %", "share", 0.05), (0.05, "share", 0.05),
    ("10 min/h", "min/h", 10.0),
    ("4.5", "1", 4.5),
])  # fmt: skip
def test_an_amount_is_read_in_the_figures_unit(said, unit, found):
    assert amount(said, unit, "figure") == pytest.approx(found)


@pytest.mark.parametrize(("said", "unit", "words"), [
    (2, "s", "2 has no unit"), ("2 s", "1/h", "is per hour: write 2"), ("2 m", "s", "is a length"),
    ("x", "1", "expected a"),
    ("3 s", "share", "is a share: write 0.05 or '5 %'"), ("1e999", "1/h", "expected a"),
    (True, "1/h", "a number"),
    ("2 h", "1", "has another unit, or none: write 2"),
])  # fmt: skip
def test_an_amount_in_a_wrong_unit_is_refused_in_words(said, unit, words):
    with pytest.raises(ValueError, match=words):
        amount(said, unit, "the figure")


def test_per_cent_are_of_the_base_unless_the_figure_is_in_per_cent():
    assert (percent("2 %", "1/h"), percent("2 %", "share"), percent("2", "1/h")) == (0.02, None, None)


def test_a_limit_is_read_with_its_tolerance():
    found = read_limit("rula_from_5_min_per_h/worst <= 10 +- 0.5")
    assert found == LimitText(Asked("rula_from_5_min_per_h", "worst", "", "less"), "<=", "10", "0.5")
    assert bounds(found, "min/h") == (10.0, 0.5)
    assert bounds(read_limit("time_in_system_s <= 20 min"), "s") == (1200.0, 24.0)


@pytest.mark.parametrize(("text", "words"), [
    ("throughput_per_h > 60", "no limit"), ("walked <= 3", "did you mean 'walked_m'"),
    ("late_share <= 0", "how near is"),
    ("throughput_per_h >= 3 %", "per cent of what"), ("late_share <= 5 % +- 0", "a tolerance is more than 0"),
    ("time_in_system_s <= 20", "20 has no unit"),
])  # fmt: skip
def test_a_limit_that_is_none_is_refused_in_words(text, words):
    with pytest.raises(ValueError, match=words):
        read_limit(text)


def test_an_indifference_of_nothing_is_refused():
    for said in (0, -1, "0 %"):
        with pytest.raises(ValueError, match="expected more than 0"):
            check_indifference(said, "throughput_per_h")


@pytest.mark.parametrize(("kpi", "unit"), [
    ("throughput_per_h", "1/h"), ("rula_from_5_min_per_h", "min/h"), ("energy_kcal_per_min", "kcal/min"),
    ("time_in_system_s", "s"), ("walked_m", "m"), ("late_share", "share"), ("on_duty_h", "h"), ("rula_mean", ""),
])  # fmt: skip
def test_the_unit_is_in_the_name(kpi, unit):
    assert unit_of(kpi) == unit


@given(st.text(max_size=40))
def test_any_text_is_a_limit_or_is_refused_in_words(text):
    for said in (text, f"throughput_per_h <= {text}", f"rula_mean <= 3 +- {text}"):
        try:
            bound, tolerance = bounds(read_limit(said), "1/h")
        except ValueError as error:
            assert str(error)
        else:
            assert bound == bound and tolerance > 0
