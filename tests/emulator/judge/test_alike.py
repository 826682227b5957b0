from dataclasses import replace

import numpy as np
import pytest

from emulator.judge.held_out import apportioned, draw_alike
from tests.emulator.fitted import made


def test_shares_are_whole_and_in_proportion():
    assert apportioned(np.array([7, 7, 6]), 20).tolist() == [7, 7, 6]
    assert apportioned(np.array([7, 7, 6]), 1000).tolist() == [350, 350, 300]
    assert apportioned(np.array([1, 1, 1]), 5).tolist() == [2, 2, 1]


def test_each_worker_is_drawn_as_often_as_recorded():
    motions, _, emulator = made("reach")
    drawn = draw_alike(emulator, motions, 50, np.random.default_rng(0))
    by_one = emulator.sample(10, np.random.default_rng(0), worker=motions.workers[0])
    assert len(drawn) == 50
    assert np.allclose(drawn.scores[:10], by_one.scores)


def test_a_stranger_cannot_be_drawn():
    motions, _, emulator = made("reach")
    strangers = replace(motions, motions=tuple(replace(m, worker="nobody") for m in motions.motions[:3]))
    with pytest.raises(ValueError, match="no worker 'nobody'"):
        draw_alike(emulator, strangers, 5, np.random.default_rng(0))
