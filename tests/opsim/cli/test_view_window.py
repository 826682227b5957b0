import pytest

from opsim.cli.view import window_s

MON_6, H = 6 * 3600.0, 3600.0


def test_times_of_the_run_and_clocks_say_the_same():
    assert window_s("1 h 30 min", "Mon 09:00", MON_6, 8 * H) == (1.5 * H, 3 * H)


def test_one_end_alone_leaves_the_other_where_the_run_has_it():
    assert window_s("2 h", None, MON_6, 8 * H) == (2 * H, 8 * H)
    assert window_s(None, "2 h", MON_6, 8 * H) == (0.0, 2 * H)
    assert window_s(None, None, MON_6, 8 * H) is None


def test_a_clock_without_a_day_is_the_first_such_moment_and_the_second_end_comes_after_the_first():
    assert window_s("Tue 07:30", "08:00", MON_6, 48 * H) == (25.5 * H, 26 * H)
    assert window_s("22:00", "02:00", MON_6, 48 * H) == (16 * H, 20 * H)


@pytest.mark.parametrize(
    ("low", "high", "said"),
    [
        (
            "Mon 15:00",
            None,
            "--from: found 'Mon 15:00' (Mon 15:00), expected a moment of the run, Mon 06:00",
        ),
        ("9 h", None, "--from: found '9 h' (Mon 15:00)"),
        (None, "-1 h", "--to: found '-1 h' (before the start)"),
        ("3 h", "2 h", "expected the later one last"),
        ("2 h", "2 h", "--from and --to: found Mon 08:00 and Mon 08:00"),
        ("90", None, "has no unit"),
        ("soon", None, "--from: cannot read 'soon'"),
        ("25:00", None, "cannot read '25:00' as a clock; write 'Mon 07:30'"),
        ("Mno 07:00", None, "no weekday 'Mno'; did you mean 'Mon'?"),
    ],
)
def test_a_stretch_that_is_none_is_refused_in_words(low, high, said):
    with pytest.raises(ValueError) as refused:
        window_s(low, high, MON_6, 8 * H)
    assert said in str(refused.value)


def test_both_ends_are_judged_at_once():
    with pytest.raises(ValueError) as refused:
        window_s("soon", "Sun 06:00", MON_6, 8 * H)
    assert [line.split(":")[0] for line in str(refused.value).splitlines()] == ["--from", "--to"]
