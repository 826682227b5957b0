import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.geometry.flattening import SIEM
from emulator.judge import (
    compare,
    disco,
    distances,
    energy_u,
    jittered_resampler,
    joint_reconstruction,
    novelty,
    pooled,
    reconstruction_error,
    resampler,
    roughness,
    temporal_roughness,
)
from emulator.model.reduction import JointPCA
from tests.emulator.judge.made import sequences

ALL = sequences(420, 9, 3, 0.2)
TRAINING, UNSEEN, FEW, DRAWN = ALL[:40], ALL[40:80], ALL[80:120], ALL[120:]


def judged(drawn, few, **more):
    return compare(drawn, few, TRAINING, UNSEEN, np.random.default_rng(0), **more)


def test_sequences_of_the_same_law_pass_every_judge():
    found = judged(DRAWN, FEW)
    assert abs(found.energy) < 0.03 * distances(UNSEEN).mean()
    assert found.p > 0.05 and 0.85 < found.novelty < 1.15 and 0.9 < found.roughness < 1.1
    assert np.isnan(found.energy_stratified)


def test_a_copier_passes_energy_and_disco_and_fails_novelty():
    rng = np.random.default_rng(1)
    found = judged(resampler(TRAINING, 300, rng), resampler(TRAINING, 40, rng))
    assert found.p > 0.05 and found.novelty == 0
    shaken = judged(jittered_resampler(TRAINING, 300, rng), jittered_resampler(TRAINING, 40, rng))
    assert shaken.novelty < 0.8


def test_another_law_fails_energy_and_disco():
    other = sequences(420, 9, 3, 0.35)
    found = judged(other[120:], other[80:120])
    assert found.energy > 0.05 * distances(UNSEEN).mean() and found.p < 0.05 and found.novelty > 1.25


def test_comparing_is_asking_each_judge():
    found = judged(DRAWN, FEW, strata=np.zeros(40, int))
    tested = pooled(distances(FEW, UNSEEN), distances(FEW), distances(UNSEEN))
    assert found.energy == energy_u(distances(DRAWN, UNSEEN), distances(DRAWN), distances(UNSEEN))
    assert np.isclose(found.energy_stratified, found.energy)
    assert found.p == disco(tested, 40, np.random.default_rng(0)).p
    assert found.novelty == novelty(distances(DRAWN, TRAINING), distances(UNSEEN, TRAINING))
    assert found.roughness == roughness(DRAWN) / roughness(UNSEEN)


def drawn_by(drawer, training, n=40):
    return drawer(training, n, np.random.default_rng(0))


def test_the_resampler_gives_nothing_but_training_sequences():
    training = sequences(12)
    drawn = drawn_by(resampler, training)
    assert drawn.shape == (40, 11, 4, 3)
    assert np.all(distances(drawn, training).min(axis=1) == 0)


def test_the_jittered_resampler_stays_near_and_on_the_spheres():
    training, unseen = np.split(sequences(24), 2)
    drawn = drawn_by(jittered_resampler, training)
    assert np.allclose(np.linalg.norm(drawn, axis=-1), 1)
    ratio = novelty(distances(drawn, training), distances(unseen, training))
    assert 0.05 < ratio < 0.6


def test_no_jitter_gives_training_sequences_back():
    training = sequences(6)
    drawn = jittered_resampler(training, 9, np.random.default_rng(0), jitter=0.0)
    assert distances(drawn, training).min(axis=1).max() < 1e-5


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
