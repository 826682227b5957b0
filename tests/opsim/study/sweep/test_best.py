import numpy as np

from opsim.study.intervals import t_interval
from opsim.study.sweep.effects import best_of

NAN = float("nan")


def best(values, better="more"):
    rows = np.array(values, dtype=float)
    return best_of(rows, [t_interval(row) for row in rows], better)


def test_the_best_has_the_best_mean_and_is_told_from_the_others_pair_by_pair(rng):
    luck = rng.normal(0, 50, 8)
    tie = 5 + 0.1 * (-1.0) ** np.arange(8)
    found = best([luck, luck + tie, luck + tie[::-1] + 0.001])
    assert found.row == 2 and found.like_it == 1 and found.shared == 8


def test_a_point_does_not_win_by_having_values_in_lucky_replications_only(rng):
    luck = np.array([0.0, 0, 0, 10, 10, 10])
    worse = np.where(luck > 0, luck - 1, NAN)
    for better, sign in (("more", 1), ("less", -1)):
        found = best(sign * np.array([worse, luck, luck - 2 - rng.normal(0, 0.1, 6)]), better)
        assert found.row == 1 and found.shared == 3


def test_points_without_any_value_are_no_rivals():
    found = best([[NAN, NAN], [1, 2], [0, 1.5]])
    assert found.row == 1 and found.shared == 2
