import numpy as np

from emulator.fitting.summary import reconstruction_deg, strangers
from tests.emulator.fitted import made


def test_enough_components_reconstruct_what_lies_in_their_span():
    emulator = made("lift")[1]
    scores = emulator.sample(30, np.random.default_rng(0)).scores
    scores[:, 6 : emulator.posture.n_components] = 0.0
    siem, y = emulator.flatten, emulator.aligned_directions(scores)
    errors = [reconstruction_deg(siem, y, n) for n in (1, 3, 8)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.05


def distances(place):
    apart = np.abs(np.subtract.outer(place, place)).astype(float)
    return apart + np.diag(np.full(len(place), np.inf))


def test_a_repetition_like_no_other_is_named():
    place = np.array([0, 1, 2, 3, 4, 5, 15.0])
    (note,) = strangers(distances(place), "abcdefg")
    assert note.endswith("g (10 times as far as usual)")


def test_neither_kinds_of_repetitions_nor_twins_nor_a_handful_are_strangers():
    assert strangers(distances(np.array([0, 1, 2, 30, 31, 32.0])), "abcdef") == ()
    assert strangers(distances(np.array([0, 0, 1, 1, 2, 2.0])), "abcdef") == ()
    assert strangers(distances(np.array([0, 1, 2, 40.0])), "abcd") == ()
