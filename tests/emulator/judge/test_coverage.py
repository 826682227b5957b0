"""Intervals of new people: what they hold."""

import numpy as np
import pytest

from emulator.judge.coverage import LEVELS, QUANTITIES, coverage, inside, pooled_coverage
from emulator.synthetic.tasks import make


def test_intervals_hold_what_is_drawn_from_the_same_law_as_often_as_they_say():
    """The standard error is .005 and .003."""
    own, drawn = np.random.default_rng(0).normal(size=(2, 10_000, 1)) * [1.0, 5.0]
    assert inside(own, drawn) == pytest.approx(LEVELS, abs=0.015)
    assert inside(own + 100.0, drawn) == (0.0, 0.0)


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
