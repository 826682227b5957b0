import numpy as np
import pytest
from plans import plan

from opsim.clock import on_grid
from opsim.history import on_grid_each, walks_of
from opsim.log import WAIT, WALK
from tests.opsim.kpi.made_logs import made, row

FLOOR = """
opsim: 1
name: floor
run: {horizon: 100 s}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [6 m, 2 m]}}
tasks: {t: {fixed: 10 s}}
stations: {s: {at: b, tasks: [t], buffer: 0}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {ana: {walk: 1 m/s, skills: {s: 1.0}}, ben: {walk: 2 m/s, skills: {s: 1.0}}}
"""


def test_walks_are_numbered_by_worker_and_time():
    p = plan(FLOOR)
    walks = walks_of(
        made(
            [
                row(WALK, 50, 58, worker=0, places=(0, 2)),
                row(WALK, 20, 21, worker=1, places=(2, 1)),
                row(WAIT, 10, 20, worker=0),
                row(WALK, 3, 9, worker=0, places=(0, 1)),
                row(WALK, 97, 100, worker=0, places=(2, 0)),
            ],
            p,
        ),
        p,
    )
    assert walks.worker.tolist() == [0, 0, 0, 1] and walks.k.tolist() == [0, 1, 2, 0]
    assert walks.start_s.tolist() == [3, 50, 97, 20] and walks.end_s.tolist() == [9, 58, 100, 21]
    assert walks.distance_m.tolist() == [6, 8, 8, 2]
    assert walks.whole_s.tolist() == [6, 8, 8, 1]
    assert (walks.place_from.tolist(), walks.place_to.tolist()) == ([0, 0, 2, 2], [1, 2, 0, 1])


def test_nobody_walks():
    p = plan(FLOOR)
    assert walks_of(made([], p), p).k.size == 0


@pytest.mark.parametrize("seconds", [0.0, 1e-9, 0.1, 1 / 3, 4.2, 1e6 / 7])
def test_each_time_is_on_the_grid_of_the_engine(seconds):
    assert on_grid_each(np.array([seconds])).tolist() == [on_grid(seconds)]
