import numpy as np
import pytest

from emulator.judge import roughness, temporal_roughness


def swing(angles_rad):
    """One bone that swings in a plane: (1, T, 1, 3)."""
    return np.stack([np.sin(angles_rad), 0 * angles_rad, np.cos(angles_rad)], axis=-1)[None, :, None]


def test_even_turning_is_not_rough():
    assert roughness(swing(np.linspace(0, 3, 50))) < 1e-12


def test_roughness_is_the_second_difference_of_the_angle():
    angles = 0.01 * np.arange(20) ** 2 / 2
    assert np.isclose(roughness(swing(angles)), 0.01, rtol=0.02)


def test_bones_count_as_a_root_sum_of_squares():
    one = swing(0.001 * np.arange(9.0) ** 2)
    assert np.isclose(roughness(np.concatenate([one] * 4, axis=2)), 2 * roughness(one))


def test_turning_the_body_changes_nothing_and_shaking_does():
    rng = np.random.default_rng(0)
    smooth = np.concatenate([swing(a * np.sin(np.linspace(0, 3, 40))) for a in (0.5, 1.0)])
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    shaken = smooth + 0.01 * rng.normal(size=smooth.shape)
    shaken /= np.linalg.norm(shaken, axis=-1, keepdims=True)
    assert np.isclose(roughness(smooth @ turn), roughness(smooth))
    assert roughness(shaken) > 3 * roughness(smooth)


def test_two_postures_have_no_second_difference():
    with pytest.raises(ValueError, match="at least 3"):
        roughness(swing(np.zeros(2)))


def test_temporal_roughness_is_the_mean_way_between_successive_postures():
    turning = swing(0.02 * np.arange(30.0))
    assert np.isclose(temporal_roughness(turning), 0.02)
    assert np.isclose(temporal_roughness(np.concatenate([turning] * 3, axis=2)), 0.06)
