from collections import Counter

import numpy as np
import pytest

from opsim.study.long_run import batch_means, flags
from tests.opsim.study.long_run.waits import autoregressions, mm1_waits


def codes(series, **how):
    return [flag.code for flag in flags(series, **how)]


def test_an_overloaded_queue_is_flagged_and_a_stable_one_is_not():
    """M/M/1 from empty, 20,000 customers, 50 seeds: load 1.1 always, 0.8 never; 0.8 is hardly ever flagged at all."""
    over = [codes(mm1_waits(1.1, 20_000, seed)) for seed in range(50)]
    stable = [codes(mm1_waits(0.8, 20_000, seed)) for seed in range(50)]
    assert all(found[0] == "growing" for found in over)
    assert not any("growing" in found for found in stable)
    assert sum(not found for found in stable) >= 42


def test_a_run_too_short_for_its_load_is_flagged_as_short_and_not_as_growing():
    found = [codes(mm1_waits(0.95, 20_000, seed)) for seed in range(50)]
    assert sum("too_short" in one for one in found) >= 45 and not any("growing" in one for one in found)


def test_growth_of_what_does_not_pile_up_is_a_start_that_shows():
    rising = np.linspace(1, 9, 1000) + np.random.default_rng(1).normal(0, 0.5, 1000)
    assert codes(rising)[0] == "growing" and "growing" not in codes(rising, piles_up=False)
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


def short_queues(load, n, replications, how_many):
    """(how_many, replications, 0.9 n) waits from empty, the first tenth left out."""
    made = [mm1_waits(load, n, seed)[n // 10 :] for seed in range(how_many * replications)]
    return np.reshape(made, (how_many, replications, -1))


@pytest.mark.parametrize("load, n, replications, mean", [(0.9, 200, 5, 8.1), (0.95, 400, 10, 18.05)])
def test_replications_too_short_to_forget_their_start_are_flagged_though_they_are_independent(
    load, n, replications, mean
):
    """M/M/1 from empty, 100 times: many intervals miss theory, and hardly any goes without a flag."""
    clean, covered = 0, 0
    for rows in short_queues(load, n, replications, 100):
        found = batch_means(rows)
        clean += not flags(rows)
        covered += found.low <= mean <= found.high
    assert covered <= 70 and clean <= 8


def test_a_stable_queue_that_grows_within_its_run_is_called_short_too_and_never_unstable():
    """M/M/1 at load 0.95: many studies of ten short runs grow by luck."""
    found = [flags(rows) for rows in short_queues(0.95, 400, 10, 100)]
    growing = [{flag.code: flag for flag in one} for one in found if one and one[0].code == "growing"]
    assert len(growing) >= 30 and all("too_short" in one and "unstable" not in one for one in growing)
    assert all("either more comes than leaves, or the run is too short" in one["growing"].says for one in growing)


def test_no_longer_run_helps_is_only_said_where_something_else_shows_that_more_comes_than_leaves():
    over = mm1_waits(1.1, 20_000, 1)
    (flag,) = flags(over, overloaded=True)
    assert flag.code == "unstable" and "no longer run helps" in flag.says
    assert "no longer run helps" not in flags(over)[0].says
    assert codes(mm1_waits(0.8, 20_000, 2), overloaded=True) == codes(mm1_waits(0.8, 20_000, 2))


def test_long_replications_of_a_stable_queue_are_called_too_short_in_a_few_of_hundred():
    """Five of 20,000 customers at load 0.8."""
    found = [codes(rows) for rows in short_queues(0.8, 20_000, 5, 20)]
    assert sum("too_short" in one for one in found) <= 1 and not any("growing" in one for one in found)


def test_replications_of_a_few_values_show_nothing_of_their_start():
    (flag,) = flags(np.random.default_rng(6).normal(size=(20, 4)))
    assert flag.code == "too_short" and "4 values" in flag.says and flag.by == pytest.approx(2.5)
