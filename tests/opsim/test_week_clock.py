import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.clock import DAY_S, WEEK_S, clock_words, moment_s

MON_6, H = 6 * 3600.0, 3600.0


def test_days_may_be_written_out_and_clocks_have_seconds():
    assert moment_s("monday 06:00:30", MON_6) == moment_s("MON 6:00:30", MON_6) == 30.0
    assert moment_s("06:00:30.5", MON_6) == 30.5


def test_a_clock_before_the_start_is_that_of_the_next_week():
    assert moment_s("Mon 05:00", MON_6) == WEEK_S - H


@given(st.integers(0, 6 * 86400), st.integers(0, int(WEEK_S) - 1))
def test_the_words_of_a_moment_are_read_as_that_moment(start_s, at_s):
    assert moment_s(clock_words(at_s, start_s), start_s) == at_s


@given(st.floats(0, WEEK_S), st.floats(0, 3 * DAY_S), st.integers(0, 23), st.integers(0, 59))
def test_a_clock_of_the_day_is_at_most_a_day_away(start_s, after_s, hour, minute):
    found_s = moment_s(f"{hour}:{minute:02d}", start_s, after_s)
    assert 0 <= found_s - after_s <= DAY_S + 1e-6
    apart_s = (start_s + found_s - hour * H - minute * 60) % DAY_S
    assert min(apart_s, DAY_S - apart_s) < 1e-3


def test_a_moment_is_said_as_a_scenario_says_it():
    assert clock_words(30 * H) == "Tue 06:00" and clock_words(24 * H + 65, MON_6) == "Tue 06:01:05"
    assert clock_words(7 * DAY_S + 0.2) == "Mon 00:00" and clock_words(DAY_S - 0.1) == "Tue 00:00"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("99:15", "cannot read '99:15' as a clock; write 'Mon 07:30' or '07:30'"),
        ("24:00", "cannot read '24:00'"),
        ("06:60", "cannot read '06:60'"),
        ("06:00:60", "cannot read '06:00:60'"),
        ("Monkey 06:15", "no weekday 'Monkey'; did you mean 'Monday'?"),
        ("Tus 06:00", "no weekday 'Tus'; did you mean 'Tue'?"),
        ("soon", "cannot read 'soon' as a time; write '2 h' or a clock, 'Mon 07:30'"),
        ("90", "has no unit"),
        ("", "write '2 h' or a clock"),
    ],
)
def test_what_is_no_moment_is_refused_in_words(text, said):
    with pytest.raises(ValueError) as refused:
        moment_s(text, MON_6)
    assert said in str(refused.value)
