"""What stands where there is no place for it is found, at points of each kind."""

import pytest
from plans import plan

from opsim.laws.capacity import rooms
from opsim.laws.jobs import Stays
from opsim.log import AFTER, BATCH, BLOCKED, CREATE, HELD, PICKUP, QUEUE, STOCK, TRANSPORT
from tests.opsim.kpi.made_logs import made, row, work

FLOOR = """
opsim: 1
name: rooms
run: {horizon: 100 s}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations:
  a: {at: here, tasks: [t], buffer: 1, buffer_after: 2}
  b: {at: here, tasks: [t], buffer: 3, batch: {size: 2}}
stores: {rack: {at: here, capacity: 2}}
conveyors: {belt: {from: here, to: there, speed: 1 m/s, pitch: 2 m}}
products: {part: {route: [a, belt, b, rack]}, whole: {route: [a], parts: {a: {part: 1}}}}
sources: {parts: {kind: saturated, products: [part]}, wholes: {kind: poisson, every: 20 s, products: [whole]}}
"""
A, B, BELT, RACK = range(4)


def found(*rows):
    p = plan(FLOOR)
    assert [place.name for place in p.stations] == ["a", "b", "belt", "rack"]
    jobs = {r[8] for r in rows}
    log = made([*rows, *(row(CREATE, 0, 0, job=job) for job in jobs)], p)
    return list(rooms(log, p, Stays(log)))


def at(station, kind, n, cause=0):
    return [row(kind, 10, 20, station=station, job=job, cause=cause) for job in range(n)]


@pytest.mark.parametrize(
    ("rows", "most"),
    [
        (lambda n: [work(10, 20, A, job=job) for job in range(n)], 1),
        (lambda n: at(A, QUEUE, n), 1),
        (lambda n: at(A, QUEUE, n, AFTER), 2),
        (lambda n: at(A, QUEUE, n, PICKUP), 2),
        (lambda n: at(A, TRANSPORT, n), 2),
        (lambda n: at(B, HELD, n, BATCH), 2),
        (lambda n: at(B, BLOCKED, n), 2),
        (lambda n: at(BELT, TRANSPORT, n), 2),
        (lambda n: at(BELT, QUEUE, n), 2),
        (lambda n: at(RACK, QUEUE, n, STOCK), 2),
        (lambda n: at(RACK, TRANSPORT, n), 2),
    ],
)
def test_one_more_than_there_is_room_for_is_found(rows, most):
    assert found(*rows(most)) == []
    (complaint,) = found(*rows(most + 1))[:1]
    assert f"{most + 1} jobs at once on {most} " in complaint


def test_who_comes_as_another_leaves_stands_in_his_place():
    assert found(*at(A, QUEUE, 1), row(QUEUE, 20, 30, station=A, job=7)) == []


def test_kinds_of_points_are_called_by_their_names():
    assert "store rack: 3 jobs" in found(*at(RACK, QUEUE, 3, STOCK))[0]
    assert "conveyor belt: 3 jobs" in found(*at(BELT, TRANSPORT, 3))[0]
