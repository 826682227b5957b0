import numpy as np
import pytest
from made_scene import run_of, scene

from opsim.log import QUEUE, STOCK, WORK
from opsim.plan.stations import STATION, STORE


def level(courses, subject, name, time_s):
    begin, end = courses.first[subject], courses.first[subject + 1]
    at = begin + np.searchsorted(courses.at_s[begin:end], time_s, side="right") - 1
    return courses.columns[name][at]


@pytest.mark.parametrize("name", ["walking_cell", "two_shift_plant"])
def test_queues_stores_and_work_are_the_rows_that_are_open(name):
    run, shown = run_of(name), scene(name)
    log, plan = run.log(), run.plan
    stations, stores = ([k for k, one in enumerate(plan.stations) if one.kind == kind] for kind in (STATION, STORE))
    for time_s in np.random.default_rng(0).uniform(shown.low_s, shown.high_s, 30):
        there = (log["start_s"] <= time_s) & (log["end_s"] > time_s) & (log["job"] >= 0)
        for subject, rank in enumerate(stations):
            here = there & (log["station"] == rank)
            assert level(shown.stations, subject, "queue", time_s) == (here & (log["kind"] == QUEUE)).sum()
            assert (level(shown.stations, subject, "busy", time_s) > 0) == (here & np.isin(log["kind"], [WORK])).any()
        for subject, rank in enumerate(stores):
            lies = there & (log["station"] == rank) & (log["kind"] == QUEUE) & (log["cause"] == STOCK)
            assert level(shown.stores, subject, "level", time_s) == lies.sum()


def test_a_station_at_work_says_so():
    shown = scene("walking_cell")
    busy, state = shown.stations.columns["busy"], shown.stations.columns["state"]
    assert np.array_equal(busy > 0, state == shown.station_states.index("work"))
