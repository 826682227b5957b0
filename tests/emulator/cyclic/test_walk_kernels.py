"""The compiled parts of drawing a walk against their naive twins."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import gaussian_filter1d

from emulator.cyclic.contacts import path_from_contacts, shares, stand_on, wanting_m
from emulator.cyclic.law import SMOOTH_FRAMES
from emulator.cyclic.units import FEWEST_FRAMES
from emulator.kernels.planting import settle
from emulator.kernels.switching import beat, fading, made_whole, squared
from emulator.kernels.warping import monotone
from emulator.model.library import MotionLibrary
from emulator.motion import stretches
from tests.naive.walk import (
    naive_beat,
    naive_gaps,
    naive_hung,
    naive_shares,
    naive_stand_on,
    naive_targets,
    naive_wanting,
    naive_way,
)

SHIPPED = Path(__file__).parents[3] / "scenarios" / "libraries" / "walking.npz"


@lru_cache
def walk():
    return MotionLibrary.load(SHIPPED)["walk"]


@lru_cache
def track(seed=0):
    return walk().sample(1, np.random.default_rng(seed), condition={"distance_m": 4.0}).tracks[0]


def postures(one, n=200):
    """Times (T,), joints (T, J, 3), and of each leg ankle, foot and hip (T, 3)."""
    time_s = np.linspace(0.0, one.node_s[-1], n)
    values = one._spline(time_s)
    joints = one._standing(walk().latent.flat(values[:, :-3]), values[:, -3:])
    return time_s, joints, [sides(joints, leg) for leg in walk().legs.joints]


def sides(joints, leg):
    foot = joints[:, leg[3]] - joints[:, leg[2]]
    return joints[:, leg[2]], foot / np.linalg.norm(foot, axis=-1, keepdims=True), joints[:, leg[0]]


def test_exponentials_are_those_of_numpy():
    squares = np.concatenate([[0.0], np.geomspace(1e-12, 1300, 2000)])
    found = squares.copy()
    fading(found)
    assert np.abs(found / np.exp(-0.5 * squares) - 1).max() < 1e-15
    assert squared_is_numpys(1) and all(squared_is_numpys(m) for m in (3, 4, 5, 8, 23))


def squared_is_numpys(m):
    k, half = np.random.default_rng(m).normal(size=m), np.random.default_rng(m + 1).normal(size=(m, m))
    matrix = half + half.T
    return np.isclose(squared(k, matrix, np.empty(m)), k @ matrix @ k, rtol=1e-12, atol=1e-12)


def test_a_beat_is_the_naive_one_as_far_as_it_is_drawn():
    model, rng, n, ends = walk(), np.random.default_rng(0), 32, []
    for entry in model.entries[:6]:
        noise = model.temper * rng.standard_normal((n - 1, 4, model.dynamics.n_latents))
        bears, known = model.manner.bears[:, 1 - entry.foot].copy(), np.full(model.dynamics.n_controls, entry.control)
        z, state = np.empty((n, model.dynamics.n_latents)), np.empty(n, dtype=np.int64)
        z[0] = entry.z[0, : model.n_moved]
        end, drawn = beat(model.dynamics.kernel_tables, known, noise, bears, 8, 5, FEWEST_FRAMES, z, state)
        twin = model.dynamics.tables, np.tile(known, (n, 1)), noise, z[0], bears, 8, FEWEST_FRAMES
        naive_z, naive_state, naive_end = naive_beat(*twin)
        assert end == naive_end and drawn == (min(end + 6, n) if end >= 0 else n)
        assert np.abs(z[:drawn] - naive_z[:drawn]).max() < 1e-8 and np.array_equal(state[:drawn], naive_state[:drawn])
        ends.append(end)
    assert max(ends) > 8


def test_what_a_beat_is_made_whole_of_does_not_depend_on_what_is_not_drawn():
    model, moved = walk(), np.random.default_rng(0).normal(size=(30, walk().n_moved))
    whole = np.empty((15, model.latent.n_components))
    made_whole(moved[:20], model.manner, np.array([0.2]), whole)
    expected = model.whole(gaussian_filter1d(moved, SMOOTH_FRAMES, axis=0, mode="nearest"), 0.2)[:15]
    assert np.abs(whole - expected).max() < 1e-9


def test_joints_are_the_naive_ones():
    one, model = track(), walk()
    flat = model.latent.flat(one.line.z)
    path = np.random.default_rng(0).normal(size=(len(flat), 3))
    found = one._standing(flat, path)
    directions = flat[:, :-4].reshape(len(flat), -1, 3)
    root = np.column_stack([path[:, 1:], model.latent.inverse(one.line.z).height * one.leg_m])
    expected = naive_hung(model.skeleton, directions, path[:, 0], one.bone_length_m, root)
    assert np.abs(found - expected).max() < 1e-12
    legs = sorted({joint for leg in model.legs.joints for joint in leg})
    assert np.array_equal(one._standing(flat, path, legs_only=True)[:, legs], found[:, legs])


def test_ways_and_shares_of_any_contact_are_the_naive_ones():
    one = track()
    for seed in range(20):
        rng = np.random.default_rng(seed)
        contact = np.repeat(rng.random((60, 2)) < 0.7, 4, axis=0)[: len(one.node_s)]
        hanging = one._hanging[: len(contact)]
        assert np.abs(shares(contact) - naive_shares(contact)).max() < 1e-15
        expected = naive_way(hanging, contact, walk().skeleton)
        assert np.abs(path_from_contacts(hanging, contact, walk().skeleton) - expected).max() < 1e-12


def test_feet_belong_where_the_naive_ones_do():
    for seed in range(3):
        one = track(seed)
        time_s, joints, of_legs = postures(one)
        ankles, feet = one._targets(time_s, joints)
        for side, (own, raw) in enumerate(zip(one._feet, of_legs)):
            ankle, foot = naive_targets(own, time_s, *raw)
            assert np.abs(ankles[:, side] - ankle).max() < 1e-12 and np.abs(feet[:, side] - foot).max() < 1e-12
            near = replace(own, leg_m=0.9 * own.leg_m)
            found = np.empty((2, len(time_s), 3))
            near.targets(time_s, joints, walk().legs.tables[0][side], *found)
            assert np.abs(found - naive_targets(near, time_s, *raw)).max() < 1e-11


def test_what_is_missing_at_the_ends_of_stances_is_the_naive():
    one = track()
    raw = one._hanging + np.column_stack([one._level, np.full(len(one.node_s), one.leg_m)])[:, None]
    for side, own in enumerate(one._feet):
        runs = stretches(one.line.contact[:, side])
        n = len(runs)
        found = np.empty(n), np.empty(n), np.empty((n, 2, 5)), np.empty((n, 2, 5))
        leg = walk().legs.tables[0][side]
        known = own.ankle_m, own.foot_m, own.leg_m, own.flat
        settle(one.node_s, np.array(runs), raw, leg, *known, *found)
        for mine, twin in zip(found, naive_gaps(one.node_s, runs, *sides(raw, leg), *known)):
            assert np.array_equal(np.isinf(mine), np.isinf(twin)) and np.allclose(mine, twin, atol=1e-9)


def test_legs_stand_as_the_naive_ones_do():
    one, model = track(), walk()
    time_s, joints, _ = postures(one)
    ankles, feet = one._targets(time_s, joints)
    for lower in (0.0, 0.1, -0.3):
        moved = joints - np.array([0.0, 0.0, lower])
        given = moved, ankles, feet, model.legs, one._bone_m
        assert np.abs(stand_on(*given) - naive_stand_on(*given)).max() < 1e-12
        assert np.abs(wanting_m(moved, ankles, *given[3:]) - naive_wanting(moved, ankles, *given[3:])).max() < 1e-14


def test_between_values_it_is_scipys():
    rng = np.random.default_rng(0)
    for n in (2, 3, 4, 9):
        for _ in range(50):
            x, y = np.cumsum(rng.uniform(0.1, 2, n)), np.stack([rng.normal(size=n), rng.integers(-1, 2, n)])
            at = np.sort(np.append(rng.uniform(x[0], x[-1], 40), x))
            found = np.empty((len(at), 2))
            monotone(x, y, at, found)
            assert np.abs(found - PchipInterpolator(x, y.T)(at)).max() < 1e-12
