"""What lies in stores, what comes there and what is used; what rides on belts."""

import pytest
from plans import plan

from opsim.log import BLOCKED, CREATE, FINISH, JOIN, QUEUE, STOCK, TRANSPORT
from tests.opsim.kpi.made_logs import found, made, row

FLOOR = """
opsim: 1
name: stores
run: {horizon: 3620 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {a: {at: here, tasks: [t]}, b: {at: here, tasks: [t]}}
stores: {rack: {at: here}}
conveyors: {belt: {from: here, to: there, speed: 1 m/s, pitch: 2 m}}
products:
  bolt: {lot: 10, route: [a, rack]}
  nut: {route: [a, rack]}
  whole: {route: [belt, b], parts: {b: {bolt: 2, nut: 1}}}
sources:
  bolts: {kind: poisson, every: 20 s, products: [bolt]}
  nuts: {kind: poisson, every: 20 s, products: [nut]}
  wholes: {kind: poisson, every: 20 s, products: [whole]}
"""
BELT, RACK = 2, 3
BOLT, NUT, WHOLE = range(3)


def values(*rows):
    p = plan(FLOOR)
    assert [place.name for place in p.stations] == ["a", "b", "belt", "rack"]
    created = {(r[8], r[9]) for r in rows if r[8] >= 0}
    return found(made([*rows, *(row(CREATE, 10, 10, job=job, product=of) for job, of in created)], p), p)


def stock(job, product, start, end):
    return row(QUEUE, start, end, station=RACK, job=job, product=product, cause=STOCK)


def used(job, product, at):
    return row(JOIN, at, at, station=1, job=job, product=product)


ROWS = [
    stock(0, BOLT, 15, 120),
    used(0, BOLT, 120),
    stock(1, BOLT, 60, 160),
    used(1, BOLT, 160),
    stock(2, NUT, 3600, 3620),
    used(3, NUT, 500),
]


def test_stock_is_the_mean_over_the_window_in_all_and_by_product():
    figures = values(*ROWS)
    assert figures["stock", "rack", "bolt"] == pytest.approx(200 / 3600)
    assert figures["stock", "rack", ""] == pytest.approx(220 / 3600)
    assert figures["stock_empty", "rack", "bolt"] == pytest.approx(1 - 140 / 3600)
    assert figures["stock_empty", "rack", ""] == pytest.approx(1 - 160 / 3600)


def test_parts_are_counted_in_units_where_they_come_and_where_they_are_used():
    """A nut that is taken as it comes counts as stored; a bolt that came before the window does not."""
    figures = values(*ROWS)
    assert figures["parts_used_per_h", "bolt", ""] == 20 and figures["parts_used_per_h", "nut", ""] == 1
    assert figures["stored_per_h", "bolt", ""] == 10 and figures["stored_per_h", "nut", ""] == 2
    assert figures["time_to_store_s", "bolt", ""] == 50
    assert figures["time_to_store_s", "nut", ""] == (490 + 3590) / 2


def test_what_ends_in_a_store_has_no_throughput_of_its_own():
    figures = values(*ROWS, row(FINISH, 200, 200, job=5, product=WHOLE))
    assert figures["throughput_per_h", "", ""] == 1
    assert {key[1] for key in figures if key[0] in ("throughput_per_h", "lead_time_s")} == {"", "whole"}


def test_a_lot_counts_as_its_units():
    p = plan(FLOOR.replace("whole: {", "whole: {lot: 4, "))
    log = made([row(CREATE, 30, 30, job=5, product=WHOLE), row(FINISH, 200, 200, job=5, product=WHOLE)], p)
    assert found(log, p)["throughput_per_h", "", ""] == 4


def test_a_belt_is_blocked_while_the_job_at_its_end_finds_no_room():
    rows = [
        row(TRANSPORT, 100, 200, station=BELT, job=5, product=WHOLE),
        row(BLOCKED, 200, 290, station=BELT, job=5, product=WHOLE),
        row(QUEUE, 190, 300, station=BELT, job=6, product=WHOLE),
    ]
    figures = values(*rows)
    assert figures["on_conveyor", "belt", ""] == pytest.approx(300 / 3600)
    assert figures["conveyor_blocked", "belt", ""] == pytest.approx(90 / 3600)
