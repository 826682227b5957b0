from dataclasses import replace

import numpy as np
import pytest

from emulator.judge import paper as flattening
from emulator.judge.paper import (
    dimensions,
    errors_by_size,
    fields,
    first_coefficients,
    first_score,
    round_trip_errors,
    spatial_shares,
)
from emulator.schemes.flattening import ISTVF, STVF
from tests.emulator.judge.paper.classes import short, shuffled, still


def one_bone_turning(n=6, n_times=20):
    """(n, T, 2, 3): one bone swings in a plane, each time its own way, the other stands."""
    angle = np.linspace(0.5, 1, n)[:, None] * np.sin(np.linspace(0, 3, n_times))
    x = np.zeros((n, n_times, 2, 3))
    x[..., 0, 0], x[..., 0, 2] = np.sin(angle), np.cos(angle)
    x[..., 1, 2] = 1.0
    return x


def turning():
    return replace(short(), aligned=one_bone_turning())


def test_fields_are_those_of_the_three_liveliest_channels():
    found = fields(short())
    for name, kind in (("S-TVF", STVF), ("IS-TVF", ISTVF)):
        flat, _ = kind.fit(short().aligned).forward(short().aligned[:2])
        spread = np.sort(flat.std(axis=(0, 1)))[::-1]
        assert found[name].shape == (2, flat.shape[1], 3)
        assert np.allclose(found[name].std(axis=(0, 1)), spread[:3])


def test_who_stands_still_has_no_velocity():
    assert all(np.abs(field).max() < 1e-12 for field in fields(replace(short(), aligned=still(short()))).values())


def test_flattening_comes_back_and_many_hops_do_not_come_back_in_one():
    errors = round_trip_errors(short())
    for name in ("IS-TVF", "SIEM", "M-TVF"):
        assert errors[name].shape == (31,) and errors[name].max() < 1e-11
    drift = errors["M-TVF, back in one hop"]
    assert drift[0] < 1e-12 and drift[-1] > 1e-3


def test_shares_of_space_fall_and_add_to_one():
    for share in spatial_shares(short()).values():
        assert np.isclose(share.sum(), 1) and np.all(np.diff(share) <= 1e-15) and len(share) > 2


def test_a_bone_that_swings_in_a_plane_has_one_direction():
    assert all(share[0] > 1 - 1e-9 for share in spatial_shares(turning()).values())


def test_functions_of_the_first_score_are_orthonormal_and_tell_it():
    scores, functions, share = first_score(short())
    assert scores.shape == (15, 31) and np.allclose(functions @ functions.T, np.eye(3))
    assert np.isclose(share.sum(), 1) and np.all(np.diff(share) <= 0)
    centred = scores - scores.mean(axis=0)
    told = centred @ functions.T @ functions
    assert np.isclose(np.sum(told**2) / np.sum(centred**2), share[:3].sum())


def test_the_order_of_the_repetitions_is_that_of_the_first_scores():
    scores, other = first_score(short())[0], first_score(shuffled(short()))[0]
    order = np.random.default_rng(5).permutation(15)
    sign = np.sign(np.sum(scores[order] * other))
    assert np.allclose(scores[order], sign * other, atol=1e-9)


@pytest.fixture(scope="module")
def by_size():
    return errors_by_size(short())


def test_more_numbers_lose_less(by_size):
    sizes, errors = by_size["JointPCA"]
    assert sizes == [4, 8, 12] and np.all(np.diff(errors) < 0)
    for name in ("SequentialPCA", "MPCA"):
        sizes, errors = by_size[name]
        assert sizes == [8, 16, 20, 50, 80, 100, 140]  # more functions of time than 14 are not to be had
        assert np.all(np.diff(errors)[1:] < 0)


def test_space_and_time_in_one_lose_least_for_as_many_numbers(by_size):
    eight = {name: errors[sizes.index(8)] for name, (sizes, errors) in by_size.items()}
    assert eight["JointPCA"] < eight["MPCA"] < eight["SequentialPCA"]


def test_coefficients_are_centred_and_their_spread_falls():
    found = first_coefficients(short())
    assert found.shape == (15, 2, 4) and np.abs(found.mean(axis=0)).max() < 1e-9
    assert np.all(np.diff(found.std(axis=0), axis=1) <= 1e-12)


def test_errors_fall_with_both_dimensions_and_few_are_not_told_from_the_originals():
    widths, errors, p = dimensions(short())
    assert widths == [2, 4, 7, 10]
    for of_one in errors.values():
        assert np.all(np.diff(of_one) < 0)
    assert np.all(np.array(errors[10]) < errors[5]) and min(p) > 0.5


def test_the_seed_decides_the_p_values_and_not_the_errors(monkeypatch):
    monkeypatch.setattr(flattening, "WIDTHS", (1,))
    rough = replace(short(), aligned=short().aligned[:, ::6])
    one, again, other = (dimensions(replace(rough, seed=seed)) for seed in (0, 0, 1))
    assert one == again and one[1] == other[1]
