import numpy as np
import pytest

from emulator.judge.comparison import resampler
from emulator.judge.held_out import COPIER, KNOWN, RECORDED, SHAKER, USUAL, drawer, kind, unknown_names
from emulator.judge.posture_tests import reconstruction_error
from emulator.schemes import SCHEMES, Scheme
from tests.emulator.judge.halved import halves


def test_all_schemes_of_the_paper_and_ours_have_a_name():
    assert set(SCHEMES) < set(KNOWN) and set(USUAL) <= set(KNOWN)
    assert unknown_names(KNOWN) == []


def test_names_of_emulators_mean_the_emulator_and_others_the_scheme():
    assert [kind(n) for n in ("SIEM/JointPCA/MVG", *USUAL)] == ["emulator", "emulator", "scheme"]
    assert [kind(n) for n in (RECORDED, COPIER, SHAKER)] == ["recordings", "control", "control"]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("SIEM/JointPCA/Smothed", "did you mean 'SIEM/JointPCA/Smoothed'?"),
        ("siem/jointpca/smoothed", "did you mean 'SIEM/JointPCA/Smoothed'?"),
        ("SIEM/SequentialPCA/MGV", "no 'MGV', did you mean 'MVG'?"),
        ("SIEM/SequentialPCA/VAR", "VAR does not go with SequentialPCA, which goes with MVG, IG, Kernel"),
        ("PWJ", "did you mean 'PWI'?"),
        ("", "expected Representation/DimensionReduction/Model"),
    ],
)
def test_a_wrong_name_is_told_with_the_nearest_right_one(name, words):
    (said,) = unknown_names([name])
    assert words in said and repr(name) in said


def test_all_wrong_names_are_told_each_once():
    assert len(unknown_names(["PWJ", "PWI", "nobody", "PWJ"])) == 2


@pytest.mark.parametrize("name", [*USUAL, COPIER, SHAKER])
def test_every_drawer_draws_sequences_on_the_clock_and_the_same_seed_gives_the_same(name):
    one = drawer(name, halves())
    drawn, again = (one.draw(7, np.random.default_rng(2)) for _ in range(2))
    assert drawn.shape == (7, *halves().a.shape[1:]) and np.array_equal(drawn, again)
    assert np.allclose(np.linalg.norm(drawn, axis=-1), 1)


def test_ours_has_an_emulator_and_a_scheme_a_likelihood():
    ours, paper = (drawer(name, halves()) for name in USUAL)
    assert ours.emulator is not None and ours.log_likelihood is None
    assert paper.emulator is None and paper.log_likelihood(halves().b).shape == (12,)
    for one in (ours, paper):
        assert reconstruction_error(halves().b, one.reconstruct(halves().b)) < 0.2


def test_a_scheme_is_that_of_the_fitted_half():
    expected = Scheme.fit(halves().a, "PWI/shared", seed=3).sample(4, np.random.default_rng(1))
    assert np.array_equal(drawer("PWI/shared", halves()).draw(4, np.random.default_rng(1)), expected)


def test_the_copier_copies_the_fitted_half():
    drawn = drawer(COPIER, halves()).draw(9, np.random.default_rng(0))
    assert np.array_equal(drawn, resampler(halves().a, 9, np.random.default_rng(0)))
