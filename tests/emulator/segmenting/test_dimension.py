"""Intrinsic dimension: shapes of known dimension, and people walking."""

import numpy as np
import pytest

from emulator.segmenting.ltsa import dimension
from tests.emulator.segmenting.made_movements import helix


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
