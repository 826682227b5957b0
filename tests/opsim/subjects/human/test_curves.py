import math
from math import inf

import pytest
from hypothesis import given
from hypothesis import strategies as st
from naive.learning import exponent, remembered

from opsim.subjects.human.fatigue import Circadian, ErrorsByFatigue, Schultz
from opsim.subjects.human.forgetting import LearnForgetCurve
from opsim.subjects.human.learning import DeJong, DualPhase, Hyperbolic, Plateau, StanfordB, Wright

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


@pytest.mark.parametrize(("level", "good"), [(0.0, 1.0), (0.5, 0.9), (1.0, 0.8), (1.7, 0.8), (-0.1, 1.0)])
def test_the_chance_of_a_defect_grows_with_fatigue(level, good):
    """A fifth at full fatigue: half as tired, a tenth."""
    assert ErrorsByFatigue(at_full_fatigue=0.2).share_of_good(level) == pytest.approx(good)


def test_without_errors_all_work_of_the_tired_is_good():
    assert all(ErrorsByFatigue(at_full_fatigue=0.0).share_of_good(level / 7) == 1.0 for level in range(8))


ALWAYS = {"least_pause_s": 0.0}


def test_a_tenth_root_of_the_way_by_hand():
    """b = 0.5, T_1 = 1: t(100) = 20. D = 1980: f = 0.25 ln 100 / ln 100 = 0.25. d = 180: S = 100 (1 + 9)^2 = 10,000.

    alpha = 100^(1 + 0.5) * 10,000^-0.5 = 1000 / 100 = 10.
    """
    learned = Wright(0.5**0.5)
    model = LearnForgetCurve(forgotten_in_s=1980.0, **ALWAYS)
    assert model.remembered(100.0, 180.0, 1.0 * learned.work(100.0)) == pytest.approx(10.0)


@given(
    rate=st.floats(0.55, 0.99),
    q=st.floats(1.0, 1e5),
    first=st.floats(1.0, 1e4),
    times=st.floats(1.0, 1e5),
    share=st.floats(0.01, 0.999),
)
def test_what_is_remembered_is_the_papers_own_formula(rate, q, first, times, share):
    worked = first * Wright(rate).work(q)
    total = times * worked
    found = LearnForgetCurve(forgotten_in_s=total, **ALWAYS).remembered(q, share * total, worked)
    assert math.isclose(found, remembered(q, share * total, total, first, exponent(rate)), rel_tol=1e-9)


@given(q=st.floats(0.0, 1e6), pause=st.floats(0.0, 1e9), worked=st.floats(1e-3, 1e9))
def test_never_forgotten_is_remembered_to_the_bit(q, pause, worked):
    assert LearnForgetCurve(forgotten_in_s=math.inf, **ALWAYS).remembered(q, pause, worked) == q


@given(q=st.floats(0.0, 1e6), pause=st.floats(0.0, 1e7), more=st.floats(1.0, 10.0), worked=st.floats(1e-3, 1e9))
def test_a_longer_pause_leaves_no_more(q, pause, more, worked):
    model = LearnForgetCurve(forgotten_in_s=1e7, **ALWAYS)
    kept = model.remembered(q, pause, worked)
    assert 0 <= model.remembered(q, pause * more, worked) <= kept * (1 + 1e-12) <= q * (1 + 1e-9)


def test_at_the_end_one_repetition_is_left_and_then_none():
    model = LearnForgetCurve(forgotten_in_s=1000.0, **ALWAYS)
    assert model.remembered(50.0, 1000.0 * (1 - 1e-12), 10.0) == pytest.approx(1.0)
    assert model.remembered(50.0, 1000.0, 10.0) == 0.0


def test_a_night_is_no_interruption_where_the_least_pause_is_a_day():
    model = LearnForgetCurve(forgotten_in_s=1e7)
    assert model.remembered(50.0, 57_600.0, 100.0) == 50.0
    assert model.remembered(50.0, 86_400.0, 100.0) < 50.0


def test_at_eighty_percent_the_eighth_unit_takes_0_512_of_the_first():
    """Three doublings: 0.8 * 0.8 * 0.8 (Wright 1936, as every textbook tabulates it)."""
    assert Wright(0.8).multiplier(8) == pytest.approx(0.512, abs=1e-12)


@pytest.mark.parametrize(("n", "time"), [(1, 1.0), (2, 0.8), (4, 0.64), (8, 0.6), (800, 0.6)])
def test_nobody_gets_below_the_plateau(n, time):
    assert Plateau(0.8, floor=0.6).multiplier(n) == pytest.approx(time, abs=1e-12)


@pytest.mark.parametrize(("n", "time"), [(1, 1.0), (2, 0.85), (8, 0.634)])
def test_a_quarter_of_the_time_is_not_shortened_by_practice(n, time):
    """0.25 + 0.75 * 0.8 = 0.85; 0.25 + 0.75 * 0.512 = 0.634."""
    assert DeJong(0.8, incompressible=0.25).multiplier(n) == pytest.approx(time, abs=1e-12)


@pytest.mark.parametrize(("n", "time"), [(1, 1.0), (6, 0.8), (16, 0.64)])
def test_who_brings_four_repetitions_has_doubled_them_at_the_sixth(n, time):
    """(6 + 4) / (1 + 4) = 2, (16 + 4) / (1 + 4) = 4."""
    assert StanfordB(0.8, prior=4).multiplier(n) == pytest.approx(time, abs=1e-12)


def test_the_recorded_time_is_that_of_the_repetition_it_was_measured_at():
    """Measured at the fourth: the eighth is a doubling on, the first two doublings before: 1 / 0.64."""
    model = Wright(0.8, measured_at=4)
    assert [model.multiplier(n) for n in (1, 4, 8)] == pytest.approx([1.5625, 1.0, 0.8])


def test_the_work_of_the_first_repetitions_by_hand():
    """b = 0.5: 100^0.5 / 0.5 = 20. De Jong with M = 0.25: 0.25 * 100 + 0.75 * 20 = 40."""
    rate = 0.5**0.5
    assert Wright(rate).work(100) == pytest.approx(20.0)
    assert DeJong(rate, incompressible=0.25).work(100) == pytest.approx(40.0)


def test_the_plateau_is_worked_at_its_floor():
    """b = 0.5, floor 0.1: reached at n = 100 after 20, then 0.1 each: 20 + 0.1 * 300 = 50."""
    assert Plateau(0.5**0.5, floor=0.1).work(400) == pytest.approx(50.0)


@pytest.mark.parametrize(("n", "time"), [(1, 1.0), (10, 16.5 / 21), (990, 1.01 * 11 / 21)])
def test_output_is_half_of_its_limit_where_practice_is_half_at(n, time):
    """p = r = 10: output 11/21, 20/30, 1000/1010 of the limit; 11/21 over 20/30 is 16.5/21."""
    assert Hyperbolic(prior=10, half_at=10).multiplier(n) == pytest.approx(time, abs=1e-12)


@pytest.mark.parametrize(("n", "time"), [(1, 1.0), (2, 0.8), (4, 0.65)])
def test_thinking_and_moving_are_learned_each_at_its_own_rate(n, time):
    """Half each: (0.7 + 0.9) / 2 = 0.8; (0.49 + 0.81) / 2 = 0.65."""
    assert DualPhase(0.7, 0.9, 0.5).multiplier(n) == pytest.approx(time, abs=1e-12)


def test_all_thought_is_wright_at_the_cognitive_rate():
    assert DualPhase(0.8, 0.9, 1.0).multiplier(8) == pytest.approx(0.512, abs=1e-12)


SHARES = st.floats(0.0, 1.0)


@pytest.mark.parametrize(
    ("before", "after", "shift"),
    [(1.0, 0.0, -0.2), (0.0, 1.0, 0.1), (0.75, 0.25, -0.1), (0.25, 0.75, 0.05), (0.5, 0.5, 0.0)],
)
def test_who_holds_others_up_is_faster_by_what_the_buffers_differ(before, after, shift):
    """faster 0.2, slower 0.1: -0.2 * (0.75 - 0.25) = -0.1; 0.1 * (0.75 - 0.25) = 0.05."""
    assert Schultz(faster=0.2, slower=0.1).shift(before, after) == pytest.approx(shift)


@given(before=SHARES, after=SHARES)
def test_neutral_shifts_by_nothing(before, after):
    assert 0.0 + Schultz(faster=0.0, slower=0.0).shift(before, after) == 0.0


@given(before=SHARES, after=SHARES, more=SHARES)
def test_a_fuller_buffer_before_never_makes_slower(before, after, more):
    model = Schultz(faster=0.3, slower=0.2)
    assert model.shift(max(before, more), after) <= model.shift(before, after)


@pytest.mark.parametrize(
    ("waiting", "places", "share"), [(2, 4, 0.5), (9, 4, 1.0), (0, 0, 0.0), (1, 0, 1.0), (5, inf, 0.5), (50, inf, 1.0)]
)
def test_how_full_a_buffer_is(waiting, places, share):
    """A buffer without limit counts as full with ten jobs."""
    assert Schultz(full_at=10).share(waiting, places) == share
