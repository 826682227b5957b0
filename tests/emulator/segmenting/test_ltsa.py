"""The embedding: known curves, scikit-learn's frozen numbers, the naive twin, laws, bad takes.

Intrinsic dimension: shapes of known dimension, and people walking.

New frames onto the manifold and back.
"""

import json

import numpy as np
import pytest

from emulator.segmenting import ltsa as bottom_module
from emulator.segmenting.ltsa import (
    alignment_banded,
    alignment_sparse,
    bottom_banded,
    bottom_sparse,
    dimension,
    spatial_neighbours,
    stltsa,
    tangents,
    temporal_neighbours,
)
from emulator.segmenting.synthesis import to_manifold, to_postures
from tests.emulator.segmenting.made_movements import helix
from tests.naive import naive_alignment
from tests.recordings import reference

SKLEARN_HELIX = [
    [-0.08633886, -0.06473633, -0.04310936, -0.02145498, 0.00021675, 0.02188829, 0.04354218, 0.06516859]
]  # fmt: skip
"""scikit-learn 1.9.1, LocallyLinearEmbedding(n_neighbors=10, n_components=1, method="ltsa", eigen_solver="dense") on
``helix()``, every fiftieth frame."""


@pytest.fixture(scope="module")
def cloud():
    """A slow wave in 7 numbers with noise, (260, 7)."""
    rng = np.random.default_rng(4)
    at = np.arange(260)[:, None] / 17
    waves = np.concatenate([np.cos(at), np.sin(at), np.cos(2 * at), at / 9], axis=1)
    return waves @ rng.normal(size=(4, 7)) + 0.02 * rng.normal(size=(260, 7))


def test_a_helix_is_its_length():
    points, at = helix()
    y = stltsa(points, 10, 1).coordinates[:, 0]
    assert abs(np.corrcoef(y, at)[0, 1]) > 1 - 1e-7
    assert np.all(np.diff(y * np.sign(y[-1] - y[0])) > 0)


def test_a_helix_is_as_near_its_length_as_the_frozen_embedding():
    """Of the frozen one neither frames nor k were kept; scikit-learn's own numbers are compared below."""
    from scipy.stats import spearmanr

    frozen = json.loads(reference("emulator_oracles.json").read_text())["ltsa_sklearn_helix"]
    points, at = helix()
    y = stltsa(points, 10, 1).coordinates[:, 0]
    assert abs(np.corrcoef(y, at)[0, 1]) >= frozen["abs_lin_corr"]
    assert abs(spearmanr(y, at).statistic) == pytest.approx(frozen["abs_rank_corr"], abs=1e-12)


@pytest.mark.parametrize("neighbourhood", ["time", "space"])
def test_a_helix_is_scikit_learns_where_neighbours_in_time_are_those_in_space(neighbourhood):
    points, at = helix()
    assert np.array_equal(temporal_neighbours(points, 10), spatial_neighbours(points, 10))
    y = stltsa(points, 10, 1, neighbourhood=neighbourhood).coordinates[:, 0]
    assert np.allclose((y * np.sign(y @ at))[::50], SKLEARN_HELIX, rtol=0, atol=1e-8)


@pytest.mark.parametrize("d", [1, 2, 3])
@pytest.mark.parametrize("in_time", [True, False])
def test_the_alignment_matrix_is_the_naive_one(cloud, d, in_time):
    points = cloud[:60]
    near = (temporal_neighbours if in_time else spatial_neighbours)(points, 9)
    naive = naive_alignment(points, 9, d, in_time)
    local = tangents(points, near, d)
    assert np.allclose(alignment_sparse(near, local).toarray(), naive, atol=1e-12)
    if in_time:
        bands = alignment_banded(near, local)
        assert np.allclose(bottom_module._full(bands), naive, atol=1e-12)
        assert len(bands) <= 2 * 9 + 1


@pytest.mark.parametrize("in_time", [True, False])
def test_eigenvectors_by_lanczos_are_those_of_the_whole_matrix(cloud, in_time):
    near = (temporal_neighbours if in_time else spatial_neighbours)(cloud, 12)
    local = tangents(cloud, near, 3)
    matrix = alignment_sparse(near, local)
    values, vectors = bottom_banded(alignment_banded(near, local), 4) if in_time else bottom_sparse(matrix, 4)
    whole = np.linalg.eigh(matrix.toarray())
    assert np.allclose(values, whole[0][1:5], rtol=1e-8, atol=1e-13)
    assert np.linalg.svd(vectors.T @ whole[1][:, 1:5])[1].min() > 1 - 1e-10


def test_beyond_2000_frames_no_eigenproblem_is_dense(monkeypatch):
    def dense(matrix, count):
        raise AssertionError(f"a dense eigenproblem of {len(matrix)} frames")

    monkeypatch.setattr(bottom_module, "_dense", dense)
    points, at = helix(2300, turns=8)
    for neighbourhood in ("time", "space"):
        y = stltsa(points, 8, 1, neighbourhood=neighbourhood).coordinates[:, 0]
        assert abs(np.corrcoef(y, at)[0, 1]) > 0.9999


def test_coordinates_are_centred_of_length_one_and_uncorrelated(cloud):
    y = stltsa(cloud, 14, 3).coordinates
    assert np.allclose(y.sum(axis=0), 0, atol=1e-10)
    assert np.allclose(y.T @ y, np.eye(3), atol=1e-10)


def test_turning_shifting_and_scaling_the_points_leaves_the_embedding(cloud):
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(7, 7)))[0]
    one, other = stltsa(cloud, 14, 3), stltsa(4.2 * cloud @ turn + 11.0, 14, 3)
    assert np.allclose(one.coordinates, other.coordinates, atol=1e-7)
    assert np.allclose(one.eigenvalues, other.eigenvalues, rtol=1e-7)


def test_time_backwards_is_the_embedding_backwards(cloud):
    one, back = stltsa(cloud, 14, 3).coordinates, stltsa(cloud[::-1], 14, 3).coordinates[::-1]
    assert np.allclose(np.abs(np.sum(one * back, axis=0)), 1, atol=1e-9)


def test_the_same_take_has_the_same_sign_to_the_bit(cloud):
    assert np.array_equal(stltsa(cloud, 14, 3).coordinates, stltsa(cloud.copy(), 14, 3).coordinates)
    noisy = stltsa(cloud + 1e-9 * np.random.default_rng(1).normal(size=cloud.shape), 14, 3).coordinates
    assert np.all(np.sum(noisy * stltsa(cloud, 14, 3).coordinates, axis=0) > 0.999)


def test_neighbours_of_each_frame_are_k_near_in_time_and_never_itself(cloud):
    near = temporal_neighbours(cloud, 9)
    away = near - np.arange(len(cloud))[:, None]
    assert near.shape == (260, 9) and np.abs(away).max() == 9 and not np.any(away == 0)
    assert np.all(np.diff(near, axis=1) > 0) and near.min() == 0 and near.max() == 259


def test_points_that_coincide_have_neighbours_too():
    assert np.all(spatial_neighbours(np.zeros((9, 2)), 3) != np.arange(9)[:, None])


@pytest.mark.parametrize(
    ("points", "k", "d", "said"),
    [
        (np.eye(5), 9, 1, "k = 9 neighbours, expected 2 to 4"),
        (np.eye(9), 2, 2, "k = 2 neighbours, expected 3 to 8"),
        (np.ones((1, 3)), 2, 1, "found 1 frames, expected 4 or more"),
        (np.ones((30, 3)), 5, 1, "nothing moves"),
        (np.full((30, 3), np.nan), 5, 1, "frame 0 has a gap: clean the recording first"),
    ],
)
def test_what_cannot_be_embedded_is_said(points, k, d, said):
    with pytest.raises(ValueError, match=said):
        stltsa(points, k, d)


def test_an_unknown_neighbourhood_is_said():
    with pytest.raises(ValueError, match="found 'sapce', expected time or space"):
        stltsa(np.eye(9), 3, 1, neighbourhood="sapce")


@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_a_helix_has_one_dimension_with_and_without_noise(noise):
    points = helix()[0]
    points = points + noise * np.random.default_rng(0).normal(size=points.shape)
    assert dimension(points, 12)[0] == 1


def test_a_bent_sheet_has_two():
    across, along = np.random.default_rng(0).random((2, 900))
    sheet = np.stack([3 * across, along, np.sin(2 * across)], axis=1)
    assert dimension(sheet, 14, neighbourhood="space")[0] == 2


def test_a_solid_in_four_numbers_has_three():
    inside = np.random.default_rng(1).random((1000, 3))
    solid = np.hstack([inside, 0.2 * np.sin(inside[:, :1] + inside[:, 1:2])])
    assert dimension(solid, 20, neighbourhood="space")[0] == 3


def test_a_lower_threshold_never_gives_a_higher_dimension_where_a_gap_passes():
    points = helix()[0] + 0.01 * np.random.default_rng(2).normal(size=(400, 3))
    found, gaps = dimension(points, 12, 0.5)
    assert gaps[found - 1] > 0.5 and np.all(gaps[: found - 1] <= 0.5)


def test_without_a_gap_above_the_threshold_the_widest_decides():
    points = helix()[0]
    found, gaps = dimension(points, 12, 2.0)
    assert found == gaps.argmax() + 1


def test_gaps_do_not_know_the_unit():
    points = helix()[0] + 0.01 * np.random.default_rng(2).normal(size=(400, 3))
    assert np.allclose(dimension(points, 12)[1], dimension(1000 * points, 12)[1], rtol=1e-6)


@pytest.fixture(scope="module")
def embedding():
    return stltsa(helix()[0], 10, 1)


def test_its_own_frames_map_onto_themselves_both_ways(embedding):
    assert np.allclose(to_manifold(embedding, embedding.points), embedding.coordinates, atol=1e-12)
    assert np.allclose(to_postures(embedding, embedding.coordinates), embedding.points, atol=1e-12)


def test_a_frame_between_two_maps_between_them(embedding):
    points, at = helix(799)
    new = to_manifold(embedding, points)
    assert abs(np.corrcoef(new[:, 0], at)[0, 1]) > 1 - 1e-7


def test_there_and_back_is_where_one_started(embedding):
    points, _ = helix(799)
    back = to_postures(embedding, to_manifold(embedding, points))
    assert np.abs(back - points).max() < 2e-3


def test_time_tells_which_of_two_neighbourhoods_in_the_same_place_is_meant():
    """A circle gone round twice, once 1 % larger: in space the two rounds are neighbours, in time they are not."""
    at = np.linspace(0, 4 * np.pi, 400)
    points = np.stack([np.cos(at), np.sin(at)], axis=1) * np.where(at < 2 * np.pi, 1.0, 1.01)[:, None]
    embedding = stltsa(points, 10, 1)
    mapped = to_manifold(embedding, points[::7], np.arange(400)[::7])
    assert np.allclose(mapped, embedding.coordinates[::7], atol=1e-9)


def test_points_on_one_spot_map_to_its_coordinates_and_do_not_blow_up():
    points = np.concatenate([helix(60)[0], np.repeat(helix(60)[0][-1:], 12, axis=0) + 1e-15])
    embedding = stltsa(points, 8, 1)
    assert np.all(np.isfinite(to_postures(embedding, embedding.coordinates)))
