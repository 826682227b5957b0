"""The shipped ``bench_height.yaml``: the best height of a bench moves with the people who stand at it."""

import functools

import pytest

from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios

HEIGHTS_M = (0.7, 0.9, 1.3, 1.5)


@functools.cache
def rates(variant):
    """Throughput by height of the surface, of the first replication."""
    found = []
    for height_m in HEIGHTS_M:
        changes = {"layout.places.bench.surface": f"{height_m} m"}
        plan = compile_plan(read_scenarios("bench_height", [variant], changes)[variant])
        rows = figures(run_plan(plan, 0), plan, asked=("throughput_per_h",))
        found.append(next(one.value for one in rows if one.kpi == "throughput_per_h" and not one.subject))
    return dict(zip(HEIGHTS_M, found))


@pytest.mark.parametrize(("variant", "best_m"), [("short", 0.9), ("tall", 1.3)])
def test_the_best_height_goes_with_stature(variant, best_m):
    found = rates(variant)
    assert max(found, key=found.get) == best_m
    assert found[best_m] > 1.02 * max(found[0.7], found[1.5])


def test_a_bench_for_both_is_best_for_neither():
    """At the best of one crew the mixed crew makes less than that crew does."""
    for variant, height_m in (("short", 0.9), ("tall", 1.3)):
        assert rates("base")[height_m] < 0.99 * rates(variant)[height_m]
