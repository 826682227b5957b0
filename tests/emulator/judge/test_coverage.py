"""Intervals of new people: whether the axes that they are asked along favour anybody."""

import numpy as np
import pytest

from emulator.judge.coverage import LEVELS, QUANTITIES, coverage, inside, leading_axes, pooled_coverage
from emulator.synthetic.tasks import make

SPREAD_BETWEEN, SPREAD_WITHIN = 1.0 / np.arange(1, 31) ** 0.5, 0.7 / np.arange(30, 0, -1) ** 0.5


def _held(n_people, of_all, rng):
    """Shares of people drawn from a normal law inside the intervals of that very law, one left out of each crew."""
    truth = rng.normal(size=(2000, 30)) * np.hypot(SPREAD_BETWEEN, SPREAD_WITHIN)
    shares = []
    for _ in range(500):
        people = rng.normal(size=(n_people, 1, 30)) * SPREAD_BETWEEN
        rows = people + rng.normal(size=(n_people, 6, 30)) * SPREAD_WITHIN
        stayed = rows[1:].reshape(-1, 30)
        axes = leading_axes(stayed, np.repeat(np.arange(n_people - 1), 6))
        if of_all:
            everybody = rows.reshape(-1, 30) - rows.mean(axis=(0, 1))
            axes = np.linalg.svd(everybody, full_matrices=False)[2][:3]
        shares.append(inside(rows[0] @ axes.T, truth @ axes.T))
    return np.mean(shares, axis=0)


@pytest.mark.parametrize("n_people", [3, 6])
def test_people_of_the_law_itself_are_held_as_often_as_its_intervals_say(n_people):
    """The standard error is .01; along leading axes of everybody the truth itself would be refused."""
    assert np.allclose(_held(n_people, False, np.random.default_rng(1)), LEVELS, atol=0.03)
    assert np.all(_held(n_people, True, np.random.default_rng(1)) < np.array(LEVELS) - 0.04)


def test_axes_of_people_with_one_repetition_each_are_those_of_all():
    rows = np.random.default_rng(0).normal(size=(4, 9)) * [9, 1, 1, 1, 1, 1, 1, 1, 1]
    axes = leading_axes(rows, np.arange(4))
    assert axes.shape == (3, 9) and np.allclose(axes @ axes.T, np.eye(3)) and abs(axes[0, 0]) > 0.9


@pytest.mark.slow
def test_left_out_people_are_looked_for_among_new_ones():
    motions = make("reach", 3, 4, seed=2)[0]
    rows = coverage(motions, n_drawn=60)
    assert [row.name for row in rows] == list(motions.workers) and not any(row.refused for row in rows)
    for quantity in QUANTITIES:
        half, most = pooled_coverage(rows, quantity)
        assert 0 <= half <= most <= 1
    told = []
    few = motions.subset([0, 1, 4, 5])
    refused = coverage(few, n_drawn=20, progress=lambda *step: told.append(step))
    assert all("at least 3 repetitions" in row.refused for row in refused) and len(told) == 2
    assert np.isnan(pooled_coverage(refused, "duration")).all()
    with pytest.raises(ValueError, match="found one person"):
        coverage(motions.subset([0, 1, 2, 3]))
