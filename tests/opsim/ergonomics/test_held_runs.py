"""Marks of held frames made into runs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.held_runs import RunsOf


@given(st.lists(st.booleans(), max_size=30), st.integers(0, 30))
def test_runs_do_not_depend_on_where_stretches_are_cut(held, cut):
    held = np.array(held, bool)
    angle, start_s, seconds = np.arange(held.size) * 1.0, np.arange(held.size) * 0.5, np.full(held.size, 0.5)
    found = []
    for edges in ([], [min(cut, held.size)]):
        runs = RunsOf(0.1)
        for part in np.split(np.arange(held.size), edges):
            runs.add(0, start_s[part], seconds[part], angle[part], held[part])
        found.append(runs.runs())
    for name in ("start_s", "seconds", "angle_deg"):
        assert getattr(found[0], name) == pytest.approx(getattr(found[1], name))
    assert found[0].seconds.sum() == pytest.approx(0.5 * held.sum())
