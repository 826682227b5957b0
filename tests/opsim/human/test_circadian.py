import pytest

from opsim.human.fatigue import Circadian

HOUR_S = 3600.0


@pytest.mark.parametrize(
    ("clock_h", "shift"), [(16.8, -0.1), (4.8, 0.1), (10.8, 0.0), (22.8, 0.0), (16.8 + 24 * 6, -0.1)]
)
def test_quickest_at_the_peak_slowest_twelve_hours_off_whatever_the_day(clock_h, shift):
    assert Circadian(amplitude=0.1).shift(clock_h * HOUR_S) == pytest.approx(shift, abs=1e-12)


def test_over_a_day_nothing_is_won_or_lost():
    model = Circadian(amplitude=0.2, peak_s=7.0 * HOUR_S)
    assert sum(model.shift(minute * 60.0) for minute in range(1440)) == pytest.approx(0.0, abs=1e-9)


def test_no_amplitude_shifts_by_nothing():
    assert all(0.0 + Circadian(amplitude=0.0).shift(hour * HOUR_S) == 0.0 for hour in range(48))
