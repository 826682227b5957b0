import pytest

from opsim.export.tables import run_s, start_of

TUESDAY_SIX = 86_400.0 + 6 * 3600.0


@pytest.mark.parametrize(
    ("text", "found_s"),
    [
        ("Tue 06:00", 0.0),
        ("Tue 10:15:30", 4 * 3600 + 15 * 60 + 30),
        ("Tuesday 10:15:30.5", 4 * 3600 + 15 * 60 + 30.5),
        ("tue 6:01", 60.0),
        ("10:00", 4 * 3600.0),
        ("05:00", 23 * 3600.0),
        ("Wed 05:00", 23 * 3600.0),
        ("95 min", 5700.0),
        ("12.5 s", 12.5),
    ],
)
def test_a_time_of_the_week_is_the_first_such_time_of_the_run(text, found_s):
    assert run_s(text, TUESDAY_SIX, 86_400.0) == found_s


@pytest.mark.parametrize("text", ["Mon 06:00", "Wed 07:00", "25 h", "-1 h", "Tus 06:00", "99:15", "soon", "", "12"])
def test_other_times_are_refused_in_words(text):
    with pytest.raises(ValueError, match="--at"):
        run_s(text, TUESDAY_SIX, 86_400.0)


def test_the_start_is_read_as_a_summary_says_it():
    assert start_of("Tue 06:00") == TUESDAY_SIX
