import numpy as np
import pytest

from opsim.viewer.routes import Doing, placed


def doing(performances, far_m):
    n = len(performances)
    alike = np.zeros(n, int)
    far = np.array([[far_m.get(performance, 0.0), 0.0] for performance in performances])
    return Doing(np.arange(n), alike, alike, alike, np.array(performances), far)


def ends(done, frames):
    """Where each row begins and ends along x, for who faces +x."""
    x, _, yaw = frames
    return list(zip(x.tolist(), (x + np.cos(yaw) * done.far_m[:, 0]).tolist()))


def still(n):
    return np.zeros(n), np.zeros(n), np.zeros(n)


def test_a_task_that_leads_somewhere_ends_at_the_bench():
    done = doing([4, 7, 5], {7: 3.0})
    assert np.array(ends(done, placed(done, still(3)))) == pytest.approx(np.array([(0, 0), (-3, 0), (0, 0)]))


def test_to_and_fro_meet():
    """Pick up, bring 3 m, put down, go back 3 m: each begins where the one before ended."""
    done = doing([1, 2, 3, 4, 5], {2: 3.0, 4: 3.0})
    found = placed(done, still(5))
    assert np.array(ends(done, found)) == pytest.approx(np.array([(0, 0), (0, -3), (-3, -3), (-3, 0), (0, 0)]))
    assert found[2] == pytest.approx([0, np.pi, np.pi, 0, 0])


def test_pieces_of_one_performance_have_one_frame():
    done = doing([2, 2, 3, 4], {2: 3.0, 4: 3.0})
    found = placed(done, still(4))
    assert found[0][0] == found[0][1] and found[2][0] == found[2][1]


def test_what_leads_nowhere_stays():
    done = doing([1, 2], {})
    assert np.array_equal(placed(done, still(2)), still(2))
