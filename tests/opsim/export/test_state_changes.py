import numpy as np
import pytest

from opsim import log as kinds
from opsim.export.ocel_objects import station_changes, worker_changes
from tests.opsim.export.made_export import MANY, ran

FIRST_OF = (
    (kinds.WORK, "work"),
    (kinds.SETUP, "set up"),
    (kinds.OFF, "closed"),
    (kinds.REPAIR, "repair"),
    (kinds.DOWN, "down"),
    (kinds.BLOCKED, "blocked"),
    (kinds.HELD, "waiting"),
)


def naive_station(log, rank, time_s):
    """What a station is doing at a time, row by row."""
    here = (log["station"] == rank) & (log["start_s"] <= time_s) & (time_s < log["end_s"])
    for kind, word in FIRST_OF:
        of_station = kind in kinds.STATION_KINDS
        alone = (log["job"] < 0) & (log["worker"] < 0)
        if np.any(here & (log["kind"] == kind) & (alone if of_station else log["job"] >= 0)):
            return word
    return "starved"


def at(changes, time_s):
    return [word for from_s, word in changes if from_s <= time_s][-1]


@pytest.mark.parametrize("name", MANY)
def test_stations_are_doing_what_their_rows_say_at_any_time(name):
    log, plan = ran(name)
    times_s = np.random.default_rng(0).uniform(0, log.horizon_s, 25)
    for rank, (point, changes) in enumerate(zip(plan.stations, station_changes(log, plan), strict=True)):
        if point.kind != "station":
            assert changes == []
            continue
        assert changes[0][0] == 0.0
        for time_s in times_s:
            assert at(changes, time_s) == naive_station(log, rank, time_s)


@pytest.mark.parametrize("name", MANY)
def test_workers_are_doing_what_their_rows_say_at_any_time(name):
    log, plan = ran(name)
    words = {kinds.OFF: "off duty", kinds.SETUP: "set up"}
    for rank, changes in enumerate(worker_changes(log, plan)):
        assert changes[0][0] == 0.0
        for time_s in np.random.default_rng(rank).uniform(0, log.horizon_s, 25):
            own = np.flatnonzero(
                (log["worker"] == rank)
                & np.isin(log["kind"], kinds.WORKER_KINDS)
                & (log["start_s"] <= time_s)
                & (time_s < log["end_s"])
            )
            kind = int(log["kind"][own[0]])
            assert at(changes, time_s) == words.get(kind, kinds.KINDS[kind])
