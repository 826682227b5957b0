from plans import CELL, plan

from opsim.report.sections.common import flow_order, worked_on

LINE = """
opsim: 1
name: order
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {z: {at: here, tasks: [t], buffer: 1}, a: {at: here, tasks: [t]}, m: {at: here, tasks: [t]},
           b: {at: here, tasks: [t]},
           cut: {at: here, tasks: [t]}}
stores: {shelf: {at: here, initial: {part: 3}}}
products:
  long: {route: [z, m, a, b], parts: {a: {part: 1}}}
  short: {route: [z, a]}
  part: {route: [cut, shelf]}
sources: {in: {kind: saturated, products: [long, short]}, more: {kind: base_stock, store: shelf, level: 3}}
"""


def names(text, order):
    p = plan(text)
    return [p.stations[rank].name for rank in order(p)]


def test_stations_stand_along_the_flow_and_parts_ahead_of_what_they_go_into():
    assert names(LINE, flow_order) == ["cut", "shelf", "z", "m", "a", "b"]
    assert names(LINE, worked_on) == ["cut", "z", "m", "a", "b"]


def test_a_station_that_only_some_visit_stands_where_they_do():
    assert names(LINE.replace("route: [z, a]}", "route: [z, b]}"), flow_order)[2:] == ["z", "m", "a", "b"]
    assert names(
        LINE.replace("long: {route: [z, m, a, b]", "long: {route: [z, a, b]").replace(
            "short: {route: [z, a]}", "short: {route: [z, m, b]}"
        ),
        flow_order,
    )[2:] == ["z", "m", "a", "b"]


def test_every_point_is_there_once():
    assert sorted(names(CELL, flow_order)) == sorted(["unload", "repack1", "repack2", "store"])
