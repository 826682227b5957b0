import numpy as np
from made_scene import run_of, scene

from opsim.log import TRANSPORT
from opsim.viewer.segments import IN_HANDS, ON_VEHICLE


def test_a_vehicle_is_always_somewhere():
    shown, plan = scene("forklift"), run_of("forklift").plan
    n = sum(pool.n for pool in plan.transporters)
    moves = shown.moves
    for time_s in np.random.default_rng(0).uniform(shown.low_s, shown.high_s, 40):
        there = (moves.start_s <= time_s) & (moves.end_s > time_s) & (moves.kind == ON_VEHICLE)
        assert there.sum() == n


def test_what_is_carried_is_in_the_hands_of_who_walks():
    shown, log = scene("walking_cell"), run_of("walking_cell").log()
    moves = shown.moves
    carried = np.flatnonzero(moves.kind == IN_HANDS)
    assert carried.size == ((log["kind"] == TRANSPORT) & (log["job"] >= 0)).sum()
    for row in carried[:20]:
        at = shown.segments.row(int(moves.worker[row]), float(moves.start_s[row]))
        assert shown.states[shown.segments.state[at]] == "walk"
