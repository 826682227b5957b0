"""Every number of ``emulator_oracles.json`` is compared somewhere: here, or in the test that ``ELSEWHERE`` names."""

import json
from pathlib import Path

import numpy as np
import pytest

from emulator.geometry import elastic, sphere
from emulator.geometry.alignment import resample
from emulator.geometry.flattening import SIEM
from emulator.schemes.flattening import ISTVF, STVF
from emulator.skeleton import standard_skeleton
from tests.made import made_sequences, random_warp
from tests.recordings import reference

ELSEWHERE = {
    "sphere_log_geomstats": "test_sphere.py: test_log_agrees_with_geomstats",
    "sphere_exp_geomstats": "test_sphere.py: test_exp_agrees_with_geomstats",
    "sphere_transport_geomstats": "test_sphere.py: test_transport_agrees_with_geomstats",
    "karcher_mean_S2": "test_sphere.py: test_mean_is_the_frozen_karcher_mean",
    "elastic_dp_fdasrsf_DP2_T101_D6_slope7": "test_elastic.py: test_the_optimum_is_that_of_fdasrsf",
    "energy_dcor": "judge/test_posture_tests.py: test_energy_is_dcors",
    "var2_statsmodels": "schemes/test_models.py: test_a_var_is_that_of_statsmodels",
    "ltsa_sklearn_helix": "segmenting/test_ltsa.py: test_a_helix_is_as_near_its_length_as_the_frozen_embedding",
    "mpca_tensorly_partial_tucker": "schemes/test_schemes.py: test_mpca_captures_as_much_as_tensorly",
}
"""Of the last two the data were not kept: the peers were asked anew, on formulas."""
HERE = {
    "sphere_random_2000",
    "sphere_small_angle",
    "elastic_dp_geomstats_T25_D3_slope4",
    "roundtrip",
    "noise_growth_1e-3_per_step",
    "invariance_bone_scale_translation",
    "warp_isometry",
}
LATER = {"pls2_sklearn"}
"""Of parts that other issues build."""


@pytest.fixture(scope="module")
def oracles():
    return json.loads(reference("emulator_oracles.json").read_text())


def test_every_oracle_is_accounted_for(oracles):
    assert set(oracles) == set(ELSEWHERE) | HERE | LATER
    for place in ELSEWHERE.values():
        file, name = place.split(": ")
        assert f"def {name}(" in (Path(__file__).parent / file).read_text()


def test_2000_random_pairs_of_points_agree_with_long_doubles_as_closely_as_with_geomstats(oracles):
    """One pair is as nearly opposite as the oracle's nearest: there transport divides by 1 + cos = gap^2 / 2."""
    frozen = oracles["sphere_random_2000"]
    rng = np.random.default_rng(0)
    y, z, w = (sphere.normalise(rng.normal(size=(2000, 3))) for _ in range(3))
    gap = frozen["min_antipodal_gap"]
    z[0] = -np.cos(gap) * y[0] + np.sin(gap) * sphere.basis(y[0])[0]
    v = w - np.sum(w * y, axis=1, keepdims=True) * y
    long_y, long_z, long_v = (part.astype(np.longdouble) for part in (y, z, v))
    found = {
        "log": sphere.log(y, z) - _log(long_y, long_z),
        "exp": sphere.exp(y, v) - _exp(long_y, long_v),
        "transport": sphere.transport(y, z, v) - _transport(long_y, long_z, long_v),
    }
    for name, error in found.items():
        assert np.abs(error[1:]).max() < 10 * frozen[name], name
        assert np.abs(error[0]).max() < (np.finfo(float).eps / gap**2 if name == "transport" else 10 * frozen[name])


def _log(y, z):
    cosine = np.sum(y * z, axis=1, keepdims=True)
    across = z - cosine * y
    sine = np.sqrt(np.sum(across**2, axis=1, keepdims=True))
    return across / sine * np.arctan2(sine, cosine)


def _exp(y, v):
    length = np.sqrt(np.sum(v**2, axis=1, keepdims=True))
    return np.cos(length) * y + np.sin(length) / length * v


def _transport(y, z, v):
    return v - np.sum(z * v, axis=1, keepdims=True) / (1 + np.sum(y * z, axis=1, keepdims=True)) * (y + z)


def test_small_angles_are_the_frozen_ones_where_the_arccos_has_lost_them(oracles):
    frozen = oracles["sphere_small_angle"]
    small = np.array(frozen["angles"])
    p = np.array([0.0, 0.0, 1.0])
    q = np.stack([np.sin(small), 0 * small, np.cos(small)], axis=1)
    assert np.allclose(sphere.angle(p, q), frozen["own_atan2"], rtol=1e-15, atol=0)
    assert np.abs(np.arccos(np.clip(q @ p, -1, 1)) / small - 1)[2:].min() == 1.0 and frozen["arccos"][2:] == [0, 0]


def test_the_frozen_karcher_mean_is_where_the_gradient_vanishes(oracles):
    points = np.array(oracles["karcher_mean_S2"]["points"])
    gradient = np.linalg.norm(sphere.log(sphere.mean(points), points).mean(axis=0))
    assert gradient < max(10 * oracles["karcher_mean_S2"]["grad_norm"], 1e-14)


def two_curves():
    t = np.linspace(0, 1, 25)
    s = t + 0.1 * np.sin(2 * np.pi * t)
    one = np.stack([np.sin(3 * t), np.cos(2 * t) - 1, t**2], axis=1)
    return one, np.stack([np.sin(3 * s) + 0.2 * s, np.cos(2.2 * s) - 1, s**2], axis=1)


def square_root_velocity(curve):
    velocity = np.diff(curve, axis=0) * (len(curve) - 1)
    return velocity / np.sqrt(np.linalg.norm(velocity, axis=1, keepdims=True))


@pytest.mark.parametrize(("steepest", "geomstats"), [(4, 0.031267491380623014), (7, 0.028531418527825814)])
def test_the_elastic_distance_of_two_curves_is_that_of_geomstats(oracles, steepest, geomstats):
    """T = 25, D = 3 as in the oracle, whose curves were not kept: geomstats 2.8.0 on the curves above."""
    q1, q2 = map(square_root_velocity, two_curves())
    no_bound = np.zeros(25), np.zeros(25)
    inner = elastic._filled(np.ascontiguousarray(q1 @ q2.T), steepest, no_bound, -np.inf)[0] / 24
    distance = (np.sum(q1**2) + np.sum(q2**2)) / 24 - 2 * inner
    assert abs(distance - geomstats) < max(oracles["elastic_dp_geomstats_T25_D3_slope4"]["diff"], 3e-15)
    if steepest == elastic.STEEPEST:
        assert elastic.optimum(q1 @ q2.T)[0] == pytest.approx(inner, rel=1e-15)


def made_postures():
    """Twenty spheres over 301 frames."""
    return made_sequences(4, 301, seed=3)[0]


def test_postures_come_back_from_siem_as_closely_as_frozen(oracles):
    """Summed over 20 spheres, the largest of 301 frames."""
    y = made_postures()
    siem = SIEM.fit(y)
    back = siem.inverse(siem.forward(y))
    frozen = oracles["roundtrip"]
    assert np.linalg.norm(back - y, axis=-1).sum(axis=-1).max() < 3 * frozen["SIEM_chord"]
    assert np.abs(np.linalg.norm(back, axis=-1) - 1).max() < frozen["norm_drift"]


@pytest.mark.parametrize(("kind", "name"), [(STVF, "STVF_chord"), (ISTVF, "ISTVF_chord")])
def test_postures_come_back_from_velocity_fields_as_closely_as_frozen(oracles, kind, name):
    y = made_postures()
    field = kind.fit(y)
    error = np.linalg.norm(field.inverse(*field.forward(y)) - y, axis=-1).sum(axis=-1).max()
    assert error < 3 * oracles["roundtrip"][name]


def test_noise_in_a_velocity_field_adds_up_to_the_frozen_size(oracles):
    frozen = oracles["noise_growth_1e-3_per_step"]
    y = made_postures()[0]
    field, rng = STVF.fit(y[None]), np.random.default_rng(5)
    flat, start = (np.repeat(part[None], 60, axis=0) for part in field.forward(y))
    found = sphere.distance(field.inverse(flat + 1e-3 * rng.normal(size=flat.shape), start), y)
    at = np.minimum(frozen["frames"], len(y) - 1)
    mean, spread = found[:, at].mean(axis=0), found[:, at].std(axis=0)
    assert np.all(np.abs(mean - frozen["STVF"]) < 3 * spread)
    assert np.all(np.diff(mean) > 0)


def test_noise_in_siem_coordinates_does_not_grow_along_the_sequence(oracles):
    """1e-3 in every coordinate of every frame: 20 arcs of 1.25e-3 on average, 0.65e-3 about it, early and late alike.

    The frozen numbers are one such draw each; curvature takes a few per cent off where directions lie far from the
    reference.
    """
    frozen = oracles["noise_growth_1e-3_per_step"]
    y = made_postures()[0]
    siem, rng = SIEM.fit(y), np.random.default_rng(5)
    flat = siem.forward(y)
    found = np.array([sphere.distance(siem.inverse(flat + 1e-3 * rng.normal(size=flat.shape)), y) for _ in range(200)])
    at = np.minimum(frozen["frames"], len(y) - 1)
    mean, spread = found[:, at].mean(axis=0), found[:, at].std(axis=0)
    assert np.all(np.abs(mean - frozen["SIEM"]) < 3 * spread)
    assert mean.max() < 1.1 * mean.min()
    assert mean.max() < 0.4 * min(frozen["STVF"])


def test_bone_lengths_size_and_place_leave_directions_as_they_are_to_the_frozen_digits(oracles):
    """1.3 times as large, each bone by its own factor, 3 m away."""
    skeleton, rng = standard_skeleton(), np.random.default_rng(2)
    y = sphere.normalise(rng.normal(size=(50, skeleton.n_bones, 3)))
    length_m = 0.3 * 1.3 * rng.uniform(0.7, 1.4, skeleton.n_bones)
    positions = skeleton.positions(y, length_m, rng.normal([3.0, -1.0, 0.5], 1.0, (50, 3)))
    frozen = oracles["invariance_bone_scale_translation"]["max_abs"]
    assert np.abs(skeleton.directions(positions) - y).max() < 2 * frozen


@pytest.mark.parametrize("n_times", [151, 301, 601, 1201])
def test_warping_both_sequences_alike_keeps_their_distance_to_the_frozen_error(oracles, n_times):
    frozen = oracles["warp_isometry"][f"T{n_times}_rel_err"]
    assert _isometry_error(n_times) == pytest.approx(frozen, rel=1e-6)


def test_the_error_of_the_isometry_is_of_second_order():
    errors = [_isometry_error(n) for n in (151, 301, 601, 1201)]
    order = -np.polyfit(np.log([150, 300, 600, 1200]), np.log(errors), 1)[0]
    assert 1.7 < order < 2.3


def _isometry_error(n_times):
    """How much one common warp changes the squared distance of two fields, relative."""
    sequences, _, base = made_sequences(2, n_times, seed=31)
    gamma = random_warp(np.random.default_rng(1), n_times)
    warped = np.stack([resample(sequence, gamma) for sequence in sequences])
    plain, both = (np.sum(np.diff(elastic.tsrvf(s, base), axis=0) ** 2) for s in (sequences, warped))
    return abs(both - plain) / plain
