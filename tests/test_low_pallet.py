"""The shipped ``low_pallet.yaml``: what its variants claim."""

import functools

import numpy as np
import pytest

from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from opsim.study.intervals import t_interval

BENT = "trunk_beyond_60_min_per_h"
N = 6


@functools.cache
def replications(variant, n=N):
    """(n,) minutes bent an hour, and (n,) throughput, of the first replications."""
    plan = compile_plan(read_scenarios("low_pallet", [variant])[variant])
    rows = []
    for replication in range(n):
        found = figures(run_plan(plan, replication), plan, asked=(BENT,))
        rows.append(
            [next(f.value for f in found if f.kpi == kpi and not f.subject) for kpi in (BENT, "throughput_per_h")]
        )
    return np.array(rows).T


@pytest.mark.slow
def test_drawing_times_and_postures_apart_misses_bent_time_and_no_throughput():
    """Who bends deeper takes longer: apart, the deep postures are given shorter times."""
    bent, rate = replications("base", 16)
    bent_apart, rate_apart = replications("times_apart_from_bodies", 16)
    assert np.array_equal(rate, rate_apart)
    missed = t_interval(bent - bent_apart, 0.95)
    assert missed.low > 0
    assert 0.01 < missed.mean / bent.mean() < 0.12


@pytest.mark.slow
def test_a_raised_pallet_takes_the_bending_away():
    assert replications("pallet_raised")[0].max() < 0.05 * replications("base")[0].min()
