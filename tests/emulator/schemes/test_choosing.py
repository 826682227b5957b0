import numpy as np
import pytest

from emulator.schemes import choose_scheme

INDEX = np.repeat(np.arange(4), 8)


def sequences(rng, kinds):
    """32 sequences (32, 11, 2, 3) that swing to one side, or to the other where ``kinds`` is 2."""
    angle = 0.5 * np.sin(np.linspace(0, np.pi, 11))
    side = np.where(rng.random(32) < 0.5, -1.0, 1.0) if kinds == 2 else np.ones(32)
    size = side * (1 + 0.1 * rng.standard_normal(32))
    at = size[:, None] * angle
    one = np.stack([np.cos(at), np.sin(at), np.zeros_like(at)], axis=-1)
    two = np.stack([np.zeros_like(at), np.sin(at / 2), np.cos(at / 2)], axis=-1)
    return np.stack([one, two], axis=2)


NAMES = ("SIEM/JointPCA/MVG", "SIEM/JointPCA/Kernel")


def test_two_kinds_of_movement_are_told_by_a_kernel_and_not_by_one_gaussian():
    found = choose_scheme(sequences(np.random.default_rng(0), 2), INDEX, NAMES)
    assert found.scheme == "SIEM/JointPCA/Kernel"
    gaussian, kernel = (found.scores[name]["workers"] for name in NAMES)
    assert kernel < 0.9 * gaussian


def test_the_order_of_the_names_decides_nothing():
    given = sequences(np.random.default_rng(1), 2)
    assert choose_scheme(given, INDEX, NAMES).scores == choose_scheme(given, INDEX, NAMES[::-1]).scores


def test_an_unknown_scheme_is_named_before_anything_is_fitted():
    with pytest.raises(ValueError, match="did you mean 'JointPCA'"):
        choose_scheme(np.zeros((0, 1, 1, 3)), INDEX, ("SIEM/JoinPCA/MVG",))


def test_too_few_sequences_are_refused():
    with pytest.raises(ValueError, match="nothing to choose by"):
        choose_scheme(np.ones((3, 2, 1, 3)), np.arange(3), NAMES)


def test_all_mistakes_are_named_at_once():
    given = np.zeros((5, 2, 1, 3))
    with pytest.raises(ValueError, match=r"(?s)no 'SIEMM'.*no 'MVGG'.*worker_index: found float64 of shape .4,."):
        choose_scheme(given, np.zeros(4), ("SIEMM/JointPCA/MVG", "SIEM/JointPCA/MVGG"))
    with pytest.raises(ValueError, match="expected a list of names"):
        choose_scheme(given, np.zeros(5, int), "SIEM/JointPCA/MVG")
