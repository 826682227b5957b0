"""How far draws of known people may go: as far as they move like a body."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.fitting.noise import MOST_JERK, N_DRAWN, naturally
from emulator.judge.clips import Clips, frame_rate_hz
from emulator.judge.joint_speeds import peak_ratio
from emulator.model.smoothed import distance_to_recordings
from tests.emulator.fitted import made


def blurred(postures, paces=1.0):
    """The emulator of lifts with noise of postures and of paces so many times as large."""
    model = made("lift")[1]
    known = model.workforce.smoothed
    factor = known.factor.copy()
    factor[:, model.scale.block("posture")] *= postures
    factor[:, model.scale.block("pace")] *= paces
    return replace(model, workforce=replace(model.workforce, smoothed=replace(known, factor=factor)))


def far(model):
    at = model.scale.block("posture")
    return distance_to_recordings(model.workforce.smoothed, at, model.scale.spread[at])


def jerk(model, motions):
    drawn = model.sample(N_DRAWN, np.random.default_rng(1), worker=motions.motions[0].worker)
    clips = Clips.drawn(drawn, frame_rate_hz(motions))
    return peak_ratio(clips, Clips.recorded(motions, model.skeleton), 3)


def test_the_larger_noise_is_the_farther_draws_are_from_recordings():
    assert far(blurred(0.5)) < far(blurred(1.0)) < far(blurred(2.0))


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0)])
def test_of_laws_that_move_like_a_body_the_one_that_goes_farthest_is_taken(order):
    motions, laws = made("lift")[0], (blurred(0.5), blurred(1.0), blurred(2.0, paces=40.0))
    assert jerk(laws[2], motions) > MOST_JERK and far(laws[2]) > far(laws[1])
    assert naturally([((float(i), 0.7), laws[i]) for i in order], motions)[0] == (1.0, 0.7)


@pytest.mark.parametrize(("more", "taken"), [(1.01, 0.0), (1.3, 1.0)])
def test_of_laws_that_go_about_as_far_the_least_stiff_is_taken(more, taken):
    """They come from the least stiff on."""
    laws = blurred(1.0), blurred(more)
    assert far(laws[0]) < far(laws[1])
    assert naturally([((float(i), 0.7), law) for i, law in enumerate(laws)], made("lift")[0])[0] == (taken, 0.7)


def test_where_none_moves_like_a_body_the_one_that_goes_least_is_taken():
    motions, laws = made("lift")[0], (blurred(3.0, paces=40.0), blurred(2.0, paces=40.0))
    assert naturally([((float(i), 0.7), law) for i, law in enumerate(laws)], motions)[0] == (1.0, 0.7)
