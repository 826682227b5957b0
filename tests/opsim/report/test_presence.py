"""Where people are: all the time that they are on the floor, once."""

import numpy as np
import pytest
from plans import plan, ran

from opsim.log import ABSENT, OFF, REPAIR
from opsim.report.sections.common import presence, staffed_h
from tests.opsim.kpi.made_logs import made, row
from tests.opsim.study.layout.made_floor import FLOOR

SHIFT = (("workers: {ana: {", "shifts: {s: {from: '00:10', to: '00:50'}}\nworkers: {ana: {shift: s, "),)
STARTS = (("run: {horizon: 1 h", "run: {start: Mon 00:00, horizon: 1 h, warm_up: 5 min"),)


@pytest.fixture(scope="module")
def shift():
    return ran(FLOOR, *SHIFT, *STARTS)


def test_the_time_of_all_is_the_time_that_they_are_there(shift):
    log, plan = shift
    found = presence(log, plan)
    low, high = plan.window_s
    gone = log.where(np.isin(log["kind"], (OFF, ABSENT)) & (log["worker"] >= 0)).clipped_s(low, high).sum()
    assert gone > 0
    there_s = len(plan.workers) * (high - low) - gone
    assert found.total == pytest.approx(there_s * 3600 / (40 * 60)), "an hour of the 40 min of the shift"


def test_an_hour_is_one_in_which_somebody_is_on_duty_or_the_floor_is_open():
    log, plan = ran(FLOOR, *SHIFT, ("run: {horizon: 1 h", "run: {start: Mon 00:00, horizon: 20 h"))
    assert staffed_h(plan) == pytest.approx(40 / 60)
    assert 2 * 3600 <= presence(log, plan).total < 2.1 * 3600, "two people, all the shift"


def test_repair_is_work():
    made_plan = plan(FLOOR)
    at = made_plan.stations[0].place
    rows = [row(REPAIR, 0, 600, worker=0, station=0, places=(at, at))]
    found = presence(made(rows, made_plan), made_plan)
    assert found.work[at] == pytest.approx(600) and found.work.sum() == pytest.approx(600)


def test_work_is_where_the_stations_are(shift):
    log, plan = shift
    found = presence(log, plan)
    at = {plan.places[rank] for rank in np.flatnonzero(found.work)}
    assert at == {"p1", "p3", "p5"} and (found.work <= found.at_place + 1e-9).all()
    assert found.on_way and all(a != b for a, b in found.on_way)
