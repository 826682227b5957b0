import json

import numpy as np
import pytest

from emulator.geometry import flattening as geodesic
from emulator.geometry import sphere
from tests.made import made_sequences
from tests.recordings import reference

RNG = np.random.default_rng(0)
P, Q, R = (sphere.normalise(RNG.normal(size=(500, 4, 3))) for _ in range(3))


@pytest.fixture(scope="module")
def oracles():
    return json.loads(reference("emulator_oracles.json").read_text())


def test_log_agrees_with_geomstats(oracles):
    case, value = oracles["sphere_log_geomstats"]["case"], oracles["sphere_log_geomstats"]["value"]
    assert np.allclose(sphere.log(np.array(case["y"]), np.array(case["z"])), value, atol=1e-14)


def test_exp_agrees_with_geomstats(oracles):
    case, value = oracles["sphere_exp_geomstats"]["case"], oracles["sphere_exp_geomstats"]["value"]
    assert np.allclose(sphere.exp(np.array(case["y"]), np.array(case["v"])), value, atol=1e-14)


def test_transport_agrees_with_geomstats(oracles):
    case, value = oracles["sphere_transport_geomstats"]["case"], oracles["sphere_transport_geomstats"]["value"]
    got = sphere.transport(np.array(case["y"]), np.array(case["z"]), np.array(case["v"]))
    assert np.allclose(got, value, atol=1e-14)


def test_mean_is_the_frozen_karcher_mean(oracles):
    oracle = oracles["karcher_mean_S2"]
    assert np.allclose(sphere.mean(np.array(oracle["points"])), oracle["value"], atol=1e-12)


@pytest.mark.parametrize("small", [1e-3, 1e-6, 1e-8, 1e-10])
def test_angle_keeps_its_digits_near_zero(small):
    p = np.array([0, 0, 1.0])
    q = np.array([np.sin(small), 0, np.cos(small)])
    assert sphere.angle(p, q) == pytest.approx(small, rel=1e-12)
    assert np.linalg.norm(sphere.log(p, q)) == pytest.approx(small, rel=1e-12)


def test_angle_keeps_its_digits_near_pi():
    gap = 1e-9
    assert np.pi - sphere.angle(np.array([0, 0, 1.0]), np.array([np.sin(gap), 0, -np.cos(gap)])) == pytest.approx(
        gap, rel=1e-6
    )


def test_distance_is_the_sum_of_arcs_and_a_metric():
    right = np.array([[0, 0, 1.0], [1.0, 0, 0]])
    assert sphere.distance(right, np.roll(right, 1, axis=-1)) == pytest.approx(np.pi)
    assert np.allclose(sphere.distance(P, Q), sphere.distance(Q, P))
    assert np.all(sphere.distance(P, R) <= sphere.distance(P, Q) + sphere.distance(Q, R) + 1e-12)


def test_exp_after_log_returns():
    assert np.abs(sphere.exp(P, sphere.log(P, Q)) - Q).max() < 1e-13


def test_log_is_tangent_and_as_long_as_the_angle():
    v = sphere.log(P, Q)
    assert np.abs(np.sum(v * P, -1)).max() < 1e-13
    assert np.allclose(np.linalg.norm(v, axis=-1), sphere.angle(P, Q), atol=1e-13)


def test_log_coordinates_are_those_of_the_log():
    want = np.einsum("...c,...kc->...k", sphere.log(P, Q), sphere.basis(P))
    assert np.abs(sphere.log_coordinates(P, Q) - want).max() < 1e-13
    assert np.abs(sphere.log_coordinates(P, P)).max() < 1e-15
    with pytest.raises(ValueError, match=r"log.*opposite at index \(1, 0\)"):
        sphere.log_coordinates(P[:3], np.stack([P[0], -P[1], P[2]]))


def test_transport_keeps_inner_products_and_returns():
    u, v = sphere.log(P, Q), sphere.log(P, R)
    moved_u, moved_v = sphere.transport(P, Q, u), sphere.transport(P, Q, v)
    assert np.allclose(np.sum(moved_u * moved_v, -1), np.sum(u * v, -1), atol=1e-10)
    assert np.abs(np.sum(moved_u * Q, -1)).max() < 1e-11
    assert np.abs(sphere.transport(Q, P, moved_v) - v).max() < 1e-10


def test_mean_is_where_the_logs_cancel():
    points = sphere.exp(P[:1], 0.7 * sphere.log(P[:1], Q))
    assert np.abs(sphere.log(sphere.mean(points), points).mean(0)).max() < 1e-11


def test_mean_of_points_all_over_a_half_sphere_is_where_the_logs_cancel():
    points = P[P[..., 2] > -0.2].reshape(-1, 1, 3)
    centre = sphere.mean(points)
    assert np.abs(sphere.log(centre, points).mean(0)).max() < 1e-11


def test_mean_is_the_least_of_the_squared_arcs_around():
    points = sphere.exp(P[:1], 0.9 * sphere.log(P[:1], Q))
    centre = sphere.mean(points)
    spread = np.mean(sphere.angle(centre, points) ** 2, axis=0)
    for axis in np.moveaxis(sphere.basis(centre), -2, 0):
        for step in (-1e-3, 1e-3):
            assert np.all(np.mean(sphere.angle(sphere.exp(centre, step * axis), points) ** 2, axis=0) > spread)


def test_mean_turns_with_the_points():
    turn, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    points = sphere.exp(P[:1], 0.5 * sphere.log(P[:1], Q))
    assert np.allclose(sphere.mean(points @ turn.T), sphere.mean(points) @ turn.T, atol=1e-10)


def test_basis_is_orthonormal_and_tangent():
    frame = np.concatenate([sphere.basis(P), P[..., None, :]], axis=-2)
    assert np.allclose(frame @ np.swapaxes(frame, -1, -2), np.eye(3), atol=1e-14)


def test_between_divides_the_arc():
    assert np.allclose(sphere.angle(P, sphere.between(P, Q, np.full(P.shape[:-1], 0.3))), 0.3 * sphere.angle(P, Q))


def test_opposite_points_are_refused_with_their_place():
    opposite = P[:5].copy()
    opposite[3, 2] = -opposite[3, 2]
    with pytest.raises(ValueError, match=r"log.*opposite at index \(3, 2\)"):
        sphere.log(P[:5], opposite)
    with pytest.raises(ValueError, match=r"transport.*opposite at index \(3, 2\)"):
        sphere.transport(P[:5], opposite, np.zeros_like(opposite))


def test_mean_of_cancelling_points_is_refused():
    with pytest.raises(ValueError, match="cancel out"):
        sphere.mean(np.array([[0, 0, 1.0], [0, 0, -1.0]]))


DRAWS = np.random.default_rng(2)


@pytest.mark.parametrize("n_times", [8, 60, 301])  # steps beyond the series, and within
def test_the_series_are_the_geodesics(n_times):
    sequence = made_sequences(1, n_times, n_bones=6, seed=4)[0][0]
    place = np.concatenate([DRAWS.uniform(0, n_times - 1, 80), [0.0, n_times - 1.0, 3.0]])
    assert np.abs(geodesic.along(sequence, place) - geodesic.along_numpy(sequence, place)).max() < 1e-12


def test_half_way_is_the_middle_of_the_arc():
    p, q = np.array([0, 0, 1.0]), np.array([np.sin(0.2), 0, np.cos(0.2)])
    middle = geodesic.along(np.stack([p, q])[:, None], np.array([0.5]))[0, 0]
    assert np.allclose(middle, [np.sin(0.1), 0, np.cos(0.1)], atol=1e-15)


def test_at_the_largest_step_the_digits_hold():
    p = sphere.normalise(DRAWS.normal(size=(1, 20, 3)))
    angle = geodesic.LARGEST_STEP_RAD - 1e-9
    q = sphere.exp(p, angle * sphere.basis(p)[..., 0, :])
    sequence, place = np.concatenate([p, q]), np.linspace(0, 1, 30)
    assert np.abs(geodesic.along(sequence, place) - geodesic.along_numpy(sequence, place)).max() < 1e-13


def test_opposite_neighbours_are_refused_only_where_they_are_used():
    p = np.array([[0, 0, 1.0]])
    sequence = np.stack([p, p, -p])
    assert np.allclose(geodesic.along(sequence, np.array([0.5])), p)
    with pytest.raises(ValueError, match="opposite"):
        geodesic.along(sequence, np.array([1.5]))


def test_turning_by_nothing_gives_the_same_bits():
    vectors = np.random.default_rng(0).normal(size=(5, 3))
    assert np.array_equal(sphere.turned(vectors, np.zeros((5, 3))), vectors)


def test_turning_is_a_rotation():
    rng = np.random.default_rng(1)
    vectors, by = rng.normal(size=(2, 50, 3))
    turned = sphere.turned(vectors, by)
    assert np.allclose(np.linalg.norm(turned, axis=-1), np.linalg.norm(vectors, axis=-1), atol=1e-12)
    assert np.allclose(sphere.turned(turned, -by), vectors, atol=1e-12)


def test_the_matrices_of_turns_are_scipy_s():
    from scipy.spatial.transform import Rotation

    by = np.random.default_rng(2).normal(size=(4, 3, 3))
    assert np.allclose(sphere.matrices(by).reshape(-1, 3, 3), Rotation.from_rotvec(by.reshape(-1, 3)).as_matrix())
