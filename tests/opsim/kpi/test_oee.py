"""Overall equipment effectiveness."""

from math import isnan

import pytest
from plans import CELL, plan

from opsim.engine.floor import run_plan
from opsim.log import HELD
from tests.opsim.kpi.made_logs import found, made, row, work

ONE = """
opsim: 1
name: one station
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {a: {at: here, tasks: [t], servers: 2, buffer: 1}, b: {at: here, tasks: [t]}}
products: {p: {route: [a, b]}}
release: {kind: saturated}
workers: {w: {skills: {a: 1.0, b: 1.25}}}
"""


def test_slow_work_of_half_the_time_by_hand():
    """16 s for each 10 s of plan; of the first only half lies in the window; the last is cut at 3/8 of its 16 s."""
    p = plan(ONE)
    rows = [work(12, 28, 0), work(28, 44, 0, job=1), work(94, 100, 0, job=2, progress=(0.0, 0.375))]
    values = found(made([*rows, row(HELD, 50, 60, station=0, job=2)], p), p)
    assert values["oee", "a", ""] == pytest.approx((5 + 10 + 3.75) / 160)
    assert values["oee_factor", "a", "speed"] == pytest.approx(10 / 16)
    assert values["oee_factor", "a", "use"] == pytest.approx((8 + 16 + 6) / 160)
    assert values["oee", "b", ""] == 0 and isnan(values["oee_factor", "b", "speed"])


def test_a_better_skill_is_speed():
    p = plan(ONE)
    values = found(run_plan(p), p)
    assert values["oee_factor", "a", "speed"] == pytest.approx(1)
    assert values["oee_factor", "b", "speed"] == pytest.approx(1.25)


def test_oee_is_its_factors_and_use_is_the_share_of_work():
    p = plan(CELL)
    values = found(run_plan(p), p)
    for station in p.stations:
        factor = {part: value for (kpi, of, part), value in values.items() if (kpi, of) == ("oee_factor", station.name)}
        assert values["oee", station.name, ""] == factor["availability"] * factor["performance"] * factor["quality"]
        assert factor["performance"] == pytest.approx(factor["speed"] * factor["use"])
        assert factor["use"] == pytest.approx(values["station_states", station.name, "work"])
        assert 0 < factor["performance"] < 1
