"""What each stop costs, by hand."""

import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.kpi.resources import stops

TEXT = """
opsim: 1
name: one machine
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {press: {fixed: 10 s, automatic: true}}
stations:
  m:
    at: hall
    tasks: [press]
    buffer: 1
    breakdowns: {jam: {every: {fixed: 15 s}, repair: {fixed: 7 s}, team: crew}}
    maintenance: {oil: {every: 90 s, lasts: 3 s, when: at_once}}
products: {part: {route: [m]}}
release: {kind: saturated}
repair_teams: {crew: {n: 2}}
"""


def found(text):
    p = plan(text)
    return {(f.kpi, f.subject, f.part): f.value for f in stops(run_plan(p), p)}


def test_the_time_of_each_stop_inside_the_window_stands_under_its_name():
    """Repairs 15-22, 37-44, 59-66, 81-88, of which 2 + 7 + 7 + 7 s in the window of 80 s; oil 90-93."""
    values = found(TEXT)
    assert values["stop_share", "m", "jam"] == pytest.approx(23 / 80)
    assert values["stop_share", "m", "oil"] == pytest.approx(3 / 80)
    assert values["repair_team_use", "crew", ""] == pytest.approx(23 / 160)


def test_a_floor_that_never_stops_has_no_such_figures():
    bare = "\n".join(line for line in TEXT.split("\n") if not any(w in line for w in ("jam", "oil", "repair_")))
    assert found(bare) == {}
