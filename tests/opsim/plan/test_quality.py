"""Quality and tools as numbers: where rework goes back to, detours, marks as moments."""

from math import inf

import pytest
from plans import plan

from opsim.plan.products import NOWHERE
from opsim.plan.tasks import Moment

LINE = """
opsim: 1
name: line
run: {horizon: 100 s}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
tools: {gun: {n: 2}, jig: {}}
tasks: {t: {fixed: 1 s}, bolt: {emulator: work/fasten, hold: {tool: gun, from: start, to: 0.9}, needs: {jig: 1}}}
stations:
  cut:   {at: a, tasks: [t], buffer: 1, yield: 0.9}
  drill: {at: a, tasks: [bolt], needs: {gun: 1}}
  look:  {at: a, tasks: [t], inspect: {finds: 0.8, then: {rework: REWORK}, most: 3}}
  bench: {at: a, tasks: [t], scrap: 0.25}
products:
  a: {share: 0.5, route: [cut, drill, cut, look]}
  b: {share: 0.5, route: [drill, look, bench]}
release: {kind: poisson, every: 9 s}
workers: {w: {skills: {cut: 1.0, drill: 1.0, look: 1.0, bench: 1.0}}}
"""


def planned(rework, *changes):
    text = LINE.replace("REWORK", rework)
    for old, new in changes:
        text = text.replace(old, new)
    return plan(text)


def of(p, station):
    rank = next(rank for rank, one in enumerate(p.stations) if one.name == station)
    return next(one for one in p.quality if one.station == rank)


def test_rework_goes_back_to_the_last_time_before():
    assert of(planned("drill"), "look").back == ((NOWHERE, NOWHERE, NOWHERE, 1), (NOWHERE, 0, NOWHERE))
    assert of(planned("cut"), "look").back[0] == (NOWHERE, NOWHERE, NOWHERE, 2)


def test_rework_at_the_inspecting_station_is_done_there_again():
    assert of(planned("look"), "look").back == ((NOWHERE, NOWHERE, NOWHERE, 3), (NOWHERE, 1, NOWHERE))


def test_rework_off_the_way_is_a_step_behind_the_last_that_leads_back():
    p = planned("bench", (", bench]}", "]}"))
    for product, looked in zip(p.products, (3, 1)):
        assert product.route[-1].name == "bench"
        assert product.onward[-1] == ((1.0, looked),)
        assert product.visits()[-1] == 0 and product.visits()[:-1] == pytest.approx([1] * (len(product.route) - 1))
    assert of(p, "look").back == ((NOWHERE, NOWHERE, NOWHERE, 4, NOWHERE), (NOWHERE, 2, NOWHERE))


def test_a_product_without_rework_has_no_step_more():
    assert [len(product.route) for product in planned("drill").products] == [4, 3]


def test_scrap_is_a_yield_and_a_perfect_inspection():
    bench = of(planned("drill"), "bench")
    assert (bench.yield_share, bench.inspects, bench.finds, bench.back, bench.most) == (0.75, True, 1.0, (), inf)


def test_stations_without_quality_have_no_plan_of_it():
    p = planned("drill")
    assert [p.stations[one.station].name for one in p.quality] == ["bench", "cut", "look"]


def test_tools_are_numbered_in_natural_order_and_marks_are_moments():
    p = planned("drill")
    assert [(tool.name, tool.n) for tool in p.tools] == [("gun", 2), ("jig", 1)]
    bolt = next(task for task in p.tasks if task.name == "bolt")
    assert bolt.needs == ((1, 1),)
    assert (bolt.hold.tool, bolt.hold.start, bolt.hold.end) == (0, Moment(mark=0), Moment(share=0.9))
    assert next(station for station in p.stations if station.name == "drill").needs == ((0, 1),)
