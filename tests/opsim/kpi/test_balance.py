"""How evenly work is spread."""

from math import isnan, sqrt

import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.kpi.throughput import line_balance

LINE = """
opsim: 1
name: three stations
run: {horizon: 1 h, warm_up: 5 min}
layout: {places: {here: [0 m, 0 m]}}
tasks:
  ten: {fixed: 10 s, automatic: true}
  twenty: {fixed: 10 s, automatic: true, repeat: 2}
  thirty: {fixed: 30 s, automatic: true}
stations:
  a: {at: here, tasks: [ten]}
  b: {at: here, tasks: [twenty]}
  c: {at: here, tasks: [thirty]}
products: {p: {route: [a, b, c]}}
release: {kind: poisson, every: 2 min}
"""


def balance(text):
    p = plan(text)
    return [f.value for f in line_balance(run_plan(p), p)]


def test_ten_twenty_and_thirty_seconds():
    assert balance(LINE) == pytest.approx([60 / 90, 1 / 3, sqrt(20**2 + 10**2)])


def test_each_server_is_a_place_with_its_share_of_the_work():
    assert balance(LINE.replace("[thirty]", "[thirty], servers: 2")) == pytest.approx(
        [60 / 80, 1 / 4, sqrt(10**2 + 5**2 + 5**2)]
    )


def test_a_job_that_comes_twice_brings_its_work_twice():
    assert balance(LINE.replace("[a, b, c]", "[a, b, a, c]")) == pytest.approx([70 / 90, 2 / 9, sqrt(10**2 + 10**2)])


def test_even_stations_lose_nothing():
    even = LINE.replace("30 s", "10 s").replace("repeat: 2", "repeat: 1")
    assert balance(even) == pytest.approx([1, 0, 0])


def test_a_station_on_no_route_does_not_count():
    assert balance(LINE.replace("[a, b, c]", "[a, b]")) == pytest.approx([30 / 40, 1 / 4, 10])


def test_a_station_that_finished_no_visit_leaves_the_balance_unknown():
    assert all(isnan(value) for value in balance(LINE.replace("30 s", "2 h")))
