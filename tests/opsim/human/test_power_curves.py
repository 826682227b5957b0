import pytest

from opsim.human.learning import DeJong, Plateau, StanfordB, Wright


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
