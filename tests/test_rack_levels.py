"""The shipped ``rack_levels.yaml``: what its variants and its sweep of heights claim."""

import functools
import json

import numpy as np
import pytest

from opsim.engine.floor import run_plan
from opsim.kpi import figures
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from tests.opsim.cli.calls import opsim

BENT = "trunk_beyond_20_min_per_h"
N = 2


@functools.cache
def replications(variant):
    """(N,) minutes bent an hour, and (N,) throughput, of the first replications."""
    plan = compile_plan(read_scenarios("rack_levels", [variant])[variant])
    rows = []
    for replication in range(N):
        found = figures(run_plan(plan, replication), plan, asked=(BENT,))
        rows.append(
            [next(f.value for f in found if f.kpi == kpi and not f.subject) for kpi in (BENT, "throughput_per_h")]
        )
    return np.array(rows).T


def test_a_higher_low_level_takes_bending_away_and_time_with_it():
    (bent, rate), (bent_up, rate_up) = replications("base"), replications("low_raised")
    assert bent_up.max() < 0.8 * bent.min()
    assert (rate_up > rate).all()


@pytest.mark.slow
def test_heights_are_factors_of_a_sweep_with_paired_intervals(tmp_path):
    code, shown, _ = opsim("sweep", "rack_levels", "--replications", 3, "-o", tmp_path, "--json", "--processes", 1)
    found = json.loads(shown)
    assert code == 0
    (factor,) = found["factors"]
    assert factor["path"] == "layout.places.rack.levels.low" and factor["unit"] == "m"
