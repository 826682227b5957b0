import numpy as np

from emulator.fit_judge import reconstruction_deg
from tests.emulator.fitted import made


def test_enough_components_reconstruct_what_lies_in_their_span():
    emulator = made("reach")[2]
    scores = emulator.sample(30, np.random.default_rng(0)).scores
    scores[:, 6 : emulator.posture.n_components] = 0.0
    siem, y = emulator.flatten, emulator.aligned_directions(scores)
    errors = [reconstruction_deg(siem, y, n) for n in (1, 3, 8)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.05
