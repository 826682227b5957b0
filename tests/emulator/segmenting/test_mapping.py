"""New frames onto the manifold and back."""

import numpy as np
import pytest

from emulator.segmenting.ltsa import stltsa
from emulator.segmenting.synthesis import to_manifold, to_postures
from tests.emulator.segmenting.made_movements import helix


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
