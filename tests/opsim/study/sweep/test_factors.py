import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.scenario.schema.sweep import NotARange, between, check_range, number_of, steps
from opsim.study.sweep.factors import UNCHANGED, Factor, factors_of_points

SHARES = st.floats(0, 1, exclude_max=True)


@pytest.mark.parametrize(
    "low, high, share, found",
    [
        ("40 s", "65 s", 0.5, "52.5 s"),
        ("40 s", "60 s", 1, "60 s"),
        (1, 4, 0.0, 1),
        (1, 4, 0.999, 4),
        (0.8, 1.2, 0.25, 0.9),
        (["0 m", "1 m"], ["4 m", "1 m"], 0.5, ["2 m", "1 m"]),
        (["0 m", "3 m"], ["4 m", "1 m"], 0.25, ["1 m", "2.5 m"]),
    ],
)
def test_between_two_values_lies_a_value_with_their_unit(low, high, share, found):
    assert between(low, high, share) == found


@given(st.integers(-5, 5), st.integers(1, 9), SHARES)
def test_between_whole_numbers_lie_whole_numbers(low, wide, share):
    value = between(low, low + wide, share)
    assert isinstance(value, int) and low <= value <= low + wide


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), SHARES, SHARES)
def test_a_larger_share_is_never_a_smaller_value(low, wide, a, b):
    values = [between(low, low + wide, share) for share in sorted((a, b))]
    assert values[0] <= values[1]


def test_steps_have_both_ends_and_whole_numbers_only_once():
    assert steps("40 s", "60 s", 3) == ["40 s", "50 s", "60 s"]
    assert steps(1, 3, 9) == [1, 2, 3]


@pytest.mark.parametrize(
    "low, high, said",
    [
        ("40 s", "1 min", "need the same unit, found 's' and 'min'"),
        ("40 s", 60, "need the same unit, found 's' and no unit"),
        ("60 s", "40 s", "the wrong way round"),
        ("40 s", "40 s", "are the same"),
        ("full", "none", "'full' cannot be the end of a range"),
        ("1 min 30 s", "2 min", "quantities with one unit such as '90 s'"),
        (["1 m"], ["1 m", "2 m"], "lists of 1 and 2"),
        (True, 4, "true cannot be the end"),
    ],
)
def test_what_is_no_range_is_said(low, high, said):
    with pytest.raises(NotARange, match=said):
        check_range(low, high)


@given(st.text(max_size=20))
def test_any_text_is_a_number_or_none(text):
    found = number_of(text)
    assert found is None or isinstance(found[0], float)


def test_quantities_of_one_kind_are_numbers_in_the_unit_of_the_first():
    factor = Factor("release.every", ("30 s", "1 min", "90 s"))
    assert factor.is_number and factor.unit == "s"
    assert [factor.number(value) for value in factor.values] == [30, 60, 90] and factor.span == (30, 90)


def test_what_has_no_order_is_numbered():
    factor = Factor("run.variability", ("full", "none"))
    assert factor.categories == 2 and factor.number("none") == 1
    assert Factor("a.b", ("40 s", "2 m")).categories == 2


def test_a_range_of_places_is_a_number_from_0_to_1():
    factor = Factor("layout.places.rack", (["0 m", "0 m"], ["4 m", "2 m"]), is_range=True)
    assert not factor.categories and factor.number(factor.at(0.25)) == pytest.approx(0.25)


def test_points_given_one_by_one_leave_alone_what_they_do_not_name():
    buffer, every = factors_of_points([{"a.buffer": 2}, {"a.buffer": 3, "release.every": "9 s"}])
    assert buffer.values == (2, 3) and every.values == (UNCHANGED, "9 s")
    assert every.categories == 2 and every.words(UNCHANGED) == "as it is"
