from hypothesis import given
from hypothesis import strategies as st

from opsim.clock import TICKS_PER_S, on_grid, ticks


def test_a_delay_is_at_least_one_tick():
    assert on_grid(0.0) == on_grid(1e-12) == 2.0**-20


@given(st.lists(st.floats(1e-3, 1e6), min_size=1, max_size=50))
def test_sums_on_the_grid_are_exact_in_any_order(delays):
    grid = [on_grid(delay) for delay in delays]
    assert sum(grid) == sum(reversed(grid)) == sum(ticks(grid).tolist()) / TICKS_PER_S


@given(st.floats(1e-3, 1e6))
def test_rounding_moves_a_delay_by_half_a_tick_at_most(delay):
    assert abs(on_grid(delay) - delay) <= 0.5 / TICKS_PER_S
