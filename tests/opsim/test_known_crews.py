"""Bucket brigades against theory, from a scenario file: where people hand over, and how much they make."""

import numpy as np
import pytest
from known_answers.crews import VELOCITIES, WORK_S, brigade, expected, positions, rates


@pytest.mark.parametrize("variant", VELOCITIES)
def test_slowest_to_fastest_hand_overs_and_rate_converge_to_theory(variant):
    handoffs, rate = expected(variant)
    found, finish_s, members = brigade(variant)
    for position, answer in zip(positions(found, members), handoffs, strict=True):
        assert np.abs(position[120:] - answer).max() <= 1e-9
        assert abs(position[0] - answer) > 1e-3  # they do not begin there
    assert np.abs(rates(finish_s)[120:] / rate - 1).max() <= 1e-9


def test_the_distance_from_where_they_end_up_shrinks_by_a_third_each_time():
    """Of two the map is x -> (v1 / v2) (1 - x): its slope is -1 / 1.5 (Bartholdi & Eisenstein 1996)."""
    found, _, members = brigade("two")
    away = positions(found, members)[0][:20] - 0.4
    assert away[1:] / away[:-1] == pytest.approx(np.full(19, -2 / 3), rel=1e-5)


def test_fastest_first_they_catch_up_and_come_out_in_bunches_at_the_pace_of_the_slowest():
    """Nobody hands over in the middle of work: all three are done with theirs when the slowest is."""
    found, finish_s, members = brigade("fastest_first")
    assert not any(position.size for position in positions(found, members))
    assert np.diff(finish_s).tolist() == [0.0, 0.0, WORK_S] * 118 + [0.0, 0.0]


def test_in_single_file_they_wait_behind_each_other_and_make_little_more_than_half():
    """Hand-overs end up where benches do, at 0.2 and 0.7: 3 h at pace 1 is all that v10 does of each piece."""
    found, finish_s, members = brigade("in_single_file")
    assert [position[-1] for position in positions(found, members)] == pytest.approx([0.2, 0.7], abs=1e-9)
    assert rates(finish_s)[-50:] == pytest.approx(np.full(50, 10 / 3), rel=1e-9)
