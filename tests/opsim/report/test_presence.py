"""Where people are: all the time that they are on the floor, once."""

import numpy as np
import pytest
from plans import ran

from opsim.log import ABSENT, OFF
from opsim.report.presence import presence
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
    assert found.total == pytest.approx(there_s * 3600 / (high - low))


def test_work_is_where_the_stations_are(shift):
    log, plan = shift
    found = presence(log, plan)
    at = {plan.places[rank] for rank in np.flatnonzero(found.work)}
    assert at == {"p1", "p3", "p5"} and (found.work <= found.at_place + 1e-9).all()
    assert found.on_way and all(a != b for a, b in found.on_way)
