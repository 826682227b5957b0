import numpy as np

from emulator.geometry import sphere
from emulator.geometry.flattening import SIEM
from emulator.judge import joint_reconstruction, reconstruction_error
from emulator.model.reduction import JointPCA
from tests.emulator.judge.made import sequences


def test_the_error_is_the_mean_over_time_of_the_summed_arcs():
    x, y = sequences(3), sequences(3, seed=1)
    assert np.isclose(reconstruction_error(x, y), sphere.angle(x, y).sum(axis=2).mean())
    assert reconstruction_error(x, x) < 1e-12


def test_components_give_back_what_lies_in_their_span_and_more_lose_less():
    x = sequences(9)
    siem = SIEM.fit(x)
    flat = siem.forward(x).reshape(9, -1)
    error = [reconstruction_error(x, joint_reconstruction(siem, JointPCA.fit(flat, k), x)) for k in (1, 3, 8)]
    assert error[0] > error[1] > error[2]
    assert error[2] < 1e-9
