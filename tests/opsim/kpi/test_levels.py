import numpy as np
import pytest

from opsim.ergonomics.shift.ledger import BINS, Ledger
from opsim.kpi.exposure import LEVEL_KPIS as LEVELS
from opsim.kpi.exposure import bounds_of_level, mean_score, minutes, quantile


def ledger(**seconds):
    """One cell; by name of ``BINS`` seconds by value, None for not known. What is not named is not known for 100 s."""
    bins = {name: np.zeros((1, 1 + b.n)) for name, b in BINS.items()}
    for name in BINS:
        for value, spent_s in seconds.get(name, {None: 100.0}).items():
            bins[name][0, 0 if value is None else 1 + value - BINS[name].first] = spent_s
    return Ledger(np.zeros((1, 5), int), bins)


def test_minutes_are_those_at_the_level_or_beyond():
    found = ledger(rula={4: 30.0, 5: 60.0, 7: 120.0}, rula_at_most={7: 210.0}, trunk={19: 60.0, 20: 120.0})
    assert minutes(found, "rula_from_5")[0] == 3 and minutes(found, "rula_from_7")[0] == 2
    assert minutes(found, "rula_from_5", "_at_most")[0] == 3.5 and minutes(found, "trunk_beyond_20")[0] == 2


def test_what_nobody_measured_is_not_known_and_what_nobody_did_is_nothing():
    assert np.isnan(minutes(ledger(), "rula_from_5")[0]) and np.isnan(mean_score(ledger(), "rula")[0])
    idle = ledger(**{name: {None: 0.0} for name in BINS})
    assert minutes(idle, "rula_from_5")[0] == 0 and np.isnan(quantile(idle, "rula", 0.9)[0])


@pytest.mark.parametrize(("q", "expected"), [(0.05, 2), (0.1, 2), (0.5, 3), (0.9, 3), (0.91, 6), (1.0, 6)])
def test_the_quantile_is_the_score_at_or_below_which_that_share_of_the_time_is(q, expected):
    assert quantile(ledger(rula={2: 10.0, 3: 80.0, 6: 10.0}), "rula", q)[0] == expected


def test_the_mean_is_over_the_known_time():
    assert mean_score(ledger(reba={None: 900.0, 1: 30.0, 15: 10.0}), "reba")[0] == pytest.approx((30 + 150) / 40)


def test_scores_have_two_bounds_and_angles_one():
    assert {name: len(bounds_of_level(name)) for name in LEVELS} == {
        name: 2 if name.startswith(("rula", "reba", "owas")) else 1 for name in LEVELS
    }
