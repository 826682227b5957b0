"""The chains behind the known answers of kits and batches, against what is known without them."""

import pytest
from known_answers.assembly import jobs_in_batches, kitting


@pytest.mark.parametrize("room", [1, 3])
def test_kits_without_work_go_as_a_walk_between_two_walls(room):
    """The lead of one part over the other is a walk from -room to room, all 2 room + 1 places alike."""
    rate, stock = kitting((1.0, 1.0), (1, 1), (room, room), 1e-6)
    assert rate == pytest.approx(2 * room / (2 * room + 1), rel=1e-4)
    assert stock((room, room)) == pytest.approx(room * (room + 1) / (2 * room + 1), rel=1e-4)


def test_batches_of_one_are_a_queue():
    assert jobs_in_batches(1, 1.0, 0.75) == pytest.approx(3.0, rel=1e-9)
