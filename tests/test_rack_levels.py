"""The shipped ``rack_levels.yaml``: what its variants and its sweep of heights claim."""

import functools
import json

import numpy as np
import pytest

from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from tests.opsim.cli.calls import opsim

BENT = "trunk_beyond_20_min_per_h"
N = 4


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
    assert rate_up.mean() > rate.mean()


@pytest.mark.slow
def test_heights_are_factors_of_a_sweep_with_paired_intervals(tmp_path):
    """The sweep that stands in the file: the low level from 0.2 to 1 m."""
    code, shown, _ = opsim("sweep", "rack_levels", "-o", tmp_path, "--json", "--processes", 1)
    summary = json.loads(shown)["summary"]
    assert code == 0 and [list(point.values()) for point in summary["points"]] == [
        [f"{height:g} m"] for height in (0.2, 0.4, 0.6, 0.8, 1.0)
    ]
    rate, rula = ([point["mean"] for point in figure["points"]] for figure in summary["figures"])
    (of_rate,), (of_rula,) = (figure["factors"] for figure in summary["figures"])
    assert (np.diff(rate) > 0).all() and rate[-1] > 1.02 * rate[0] and of_rate["clear"]
    assert (np.diff(rula) < 0).all() and of_rula["clear"] and of_rula["lowest_at"] == "1 m"


def test_each_height_is_a_value_for_the_command_line(tmp_path):
    """What no sweep can try is said before its first run."""
    asked = ("--vary", "layout.places.rack.levels.low=0.3 m,2.9 m")
    code, _, wrong = opsim("sweep", "rack_levels", *asked, "-o", tmp_path / "none")
    assert code == 2 and "2.9 m" in wrong and "far outside of what was recorded" in wrong
    asked = ("--vary", "layout.places.rack.levels.lwo=0.3 m,0.4 m")
    code, _, wrong = opsim("sweep", "rack_levels", *asked, "-o", tmp_path / "none")
    assert code == 2 and "this adds a level 'lwo' that nothing uses" in wrong and "'low'" in wrong
