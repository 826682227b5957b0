"""What becomes of the rest of a performance that was broken off."""

import pytest
from plans import plan

from opsim.history import FATES, job_pieces
from opsim.log import SETUP
from tests.opsim.kpi.made_logs import made, row, work
from tests.opsim.laws.test_progress import FLOOR, piece


def fates(*rows):
    return [FATES[fate] for fate in job_pieces(made(rows, plan(FLOOR))).fate]


@pytest.mark.parametrize(
    ("rest", "fate"),
    [
        (piece(50, 56, 0.4, 1), "resumed"),
        (piece(4, 10, 0.4, 1), "resumed"),
        (piece(50, 56, 0.4, 1, worker=1, performance=1), "by_another"),
        (piece(4, 10, 0.4, 1, worker=1, performance=1), "handed_over"),
        (piece(50, 60, 0, 1, performance=1), "restarted"),
        (piece(50, 60, 0, 1, station=1, performance=1), "open"),
    ],
)
def test_the_piece_that_follows_says_what_became_of_the_rest(rest, fate):
    assert fates(piece(0, 4, 0, 0.4), rest) == [fate, "finished"]


def test_a_rest_that_nobody_takes_up_stays_open():
    assert fates(piece(0, 4, 0, 0.4)) == ["open"] and fates(piece(0, 10, 0, 1)) == ["finished"] and fates() == []


def test_pieces_are_told_apart_by_job_and_set_ups_from_work():
    setup = row(SETUP, 20, 24, worker=0, station=0, job=0, task=1, k=9, progress=(0, 1))
    found = job_pieces(
        made([piece(0, 4, 0, 0.4), setup, work(5, 15, 0, job=1, k=4), piece(50, 56, 0.4, 1)], plan(FLOOR))
    )
    assert found.before.tolist() == [-1, 0, -1, -1] and found.left.tolist() == [False, True, False, False]
