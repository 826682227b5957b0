import pytest

from opsim.human.learning import DualPhase, Hyperbolic


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
