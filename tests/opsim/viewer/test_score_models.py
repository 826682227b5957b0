import numpy as np

from emulator import root, sphere
from emulator.skeleton import standard_skeleton
from opsim.libraries import load_library
from opsim.shipped import shipped_folder
from opsim.viewer import score_models
from opsim.viewer.score_models import is_of_scores


def drawn(library, task, **condition):
    model = load_library(shipped_folder() / "libraries" / library)[task]
    return model.sample(3, np.random.default_rng(0), condition=condition or None)


def test_feet_and_softness_are_the_emulators_own():
    channel = root.RootChannel(standard_skeleton())
    names = standard_skeleton().names
    assert score_models.SOFT_M == root.SOFT_M
    assert [names.index(name) for name in score_models._FEET] == channel._feet
    assert score_models._LEGS == root._LEGS


def test_tangent_axes_are_the_emulators_own():
    reference = sphere.normalise(np.random.default_rng(0).normal(size=(20, 3)))
    assert np.allclose(score_models._frame(reference)[:, 1:], sphere.basis(reference), atol=1e-15)


def test_only_what_is_drawn_from_coefficients_is_sent_as_such():
    assert is_of_scores(drawn("bench_work.npz", "stoop"))
    assert not is_of_scores(drawn("walking.npz", "walk", distance_m=3.0))
