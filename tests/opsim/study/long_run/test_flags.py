from collections import Counter

import numpy as np
import pytest

from opsim.study.long_run import flags
from opsim.study.long_run.flags import growth
from tests.opsim.study.long_run.waits import autoregressions, mm1_waits


def codes(series, **how):
    return [flag.code for flag in flags(series, **how)]


def test_an_overloaded_queue_is_flagged_and_a_stable_one_is_not():
    """M/M/1 from empty, 20,000 customers, 50 seeds: load 1.1 always, 0.8 never; 0.8 is hardly ever flagged at all."""
    over = [codes(mm1_waits(1.1, 20_000, seed)) for seed in range(50)]
    stable = [codes(mm1_waits(0.8, 20_000, seed)) for seed in range(50)]
    assert all(found[0] == "unstable" for found in over)
    assert not any("unstable" in found for found in stable)
    assert sum(not found for found in stable) >= 42


def test_a_run_too_short_for_its_load_is_flagged_as_short_and_not_as_unstable():
    found = [codes(mm1_waits(0.95, 20_000, seed)) for seed in range(50)]
    assert sum("too_short" in one for one in found) >= 45 and not any("unstable" in one for one in found)


def test_growth_of_what_does_not_pile_up_is_a_start_that_shows():
    rising = np.linspace(1, 9, 1000) + np.random.default_rng(1).normal(0, 0.5, 1000)
    assert codes(rising)[0] == "unstable" and "unstable" not in codes(rising, piles_up=False)
    assert "start_left" in codes(rising, piles_up=False)


def test_a_start_that_is_left_in_is_seen():
    """AR(1) with 0.5 that begins 5 off and comes down over a tenth of the series; its rest alone is well."""
    made = autoregressions(0.5, 4000, 50, 2)
    biased = made + 5 * np.exp(-np.arange(4000) / 200)
    assert sum("start_left" in codes(one) for one in biased) >= 48
    assert sum("start_left" in codes(one[1600:]) for one in biased) <= 3


def test_each_flag_is_raised_by_luck_alone_in_a_few_of_hundred():
    counted = Counter(code for one in autoregressions(0.5, 4000, 300, 3) for code in codes(one))
    assert all(number <= 9 for number in counted.values()), counted


def test_few_jobs_and_a_warm_up_beyond_half_are_said():
    values = np.random.default_rng(4).normal(size=1000)
    assert codes(values, events=57) == ["few_events"] and codes(values, events=2000) == []
    (flag,) = flags(values, left_out=1500)
    assert flag.code == "too_short" and flag.serious and "more than half" in flag.says


def test_too_few_values_to_judge_are_said():
    assert codes(np.random.default_rng(5).normal(size=40)) == ["too_short"]


def test_a_straight_line_grows_by_what_it_grows():
    by, p = growth(np.arange(1000.0))
    assert by == pytest.approx(1000) and p == 0
    assert growth(np.full(100, 3.0)) == (0.0, 1.0) and growth(-np.arange(1000.0))[1] == 1
