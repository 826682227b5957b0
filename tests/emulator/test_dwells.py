import numpy as np
import pytest
from scipy.special import ndtri

from emulator.model.dwell_times import NONE, Dwells
from emulator.model.joint_coordinates import Margin

NORMAL = Margin(np.zeros(1), np.array([0.3]), 0.25)
TWO = Dwells(np.array([0.2, 0.7]), np.array([0.6, 0.0]), (NORMAL, NORMAL), np.zeros((0, 2)))


def test_below_the_threshold_there_is_no_pause():
    at = ndtri(0.6)
    assert TWO.seconds(np.array([[at - 1e-9, 0.0], [at + 1e-3, 0.0]]))[:, 0].tolist()[0] == 0.0
    assert TWO.seconds(np.array([[at + 1e-3, 0.0]]))[0, 0] > 0


def test_a_site_where_all_pause_has_no_threshold():
    assert TWO.seconds(np.array([[0.0, 1.5]]))[0, 1] == pytest.approx(np.exp(0.3 + 0.25 * 1.5))


def test_dwells_rise_with_their_coordinate():
    seconds = TWO.seconds(np.linspace(-6, 6, 400)[:, None] * np.ones(2))
    assert np.all(np.diff(seconds, axis=0) >= 0)


def test_normal_coordinates_give_the_share_of_no_pause_and_the_law_of_the_others():
    drawn = TWO.seconds(np.random.default_rng(0).standard_normal((200_000, 2)))[:, 0]
    assert np.mean(drawn == 0) == pytest.approx(0.6, abs=0.005)
    logs = np.log(drawn[drawn > 0])
    assert (logs.mean(), logs.std()) == (pytest.approx(0.3, abs=0.005), pytest.approx(0.25, abs=0.005))


def test_the_mean_is_that_of_many_draws():
    mean, spread = np.array([0.2, -0.1]), np.array([0.8, 1.1])
    drawn = TWO.seconds(mean + spread * np.random.default_rng(0).standard_normal((400_000, 2)))
    assert np.allclose(TWO.mean_s(mean, spread), drawn.mean(0), atol=4 * drawn.std(0).max() / np.sqrt(400_000))


def test_without_sites_nothing_pauses():
    assert len(NONE) == 0 and NONE.seconds(np.zeros((3, 0))).shape == (3, 0)
