"""A seam: both sides have the value half-way and the mean of both rates, and the ease reaches no further than asked."""

import numpy as np
import pytest

from emulator.composite import transitions as seams
from emulator.composite.transitions import End
from emulator.geometry import sphere


def ends(rng, n=3, n_bones=4):
    value = sphere.normalise(rng.normal(size=(n, n_bones, 3)))
    rate = rng.normal(size=(n, n_bones, 3))
    rate -= np.sum(rate * value, axis=-1, keepdims=True) * value
    return End(value, rate, np.zeros((n, n_bones)))


def test_the_ease_is_0_and_1_with_no_slope_at_its_ends():
    at = np.array([-0.5, 0.0, 1e-5, 0.5, 1.0 - 1e-5, 1.0])
    assert seams.ease(at) == pytest.approx([0, 0, 0, 0.5, 1, 1], abs=1e-9)
    assert np.max(np.diff(seams.ease(np.linspace(0, 1, 1001))) * 1000) == pytest.approx(seams.PEAK, rel=1e-5)


def test_the_ease_of_the_rate_changes_a_slope_by_1_and_no_value():
    step = 1e-6
    assert seams.ease_rate(np.array([0.0, 1.0])) == pytest.approx([0, 0])
    assert (0 - seams.ease_rate(1 - step)) / step == pytest.approx(1.0, rel=1e-4)


def test_turning_by_nothing_gives_the_same_bits():
    vectors = np.random.default_rng(0).normal(size=(5, 3))
    assert np.array_equal(seams.turned(vectors, np.zeros((5, 3))), vectors)


def test_turning_is_a_rotation():
    rng = np.random.default_rng(1)
    vectors, by = rng.normal(size=(2, 50, 3))
    turned = seams.turned(vectors, by)
    assert np.allclose(np.linalg.norm(turned, axis=-1), np.linalg.norm(vectors, axis=-1), atol=1e-12)
    assert np.allclose(seams.turned(turned, -by), vectors, atol=1e-12)


def test_both_sides_of_a_seam_meet_half_way_at_the_mean_of_both_rates():
    rng = np.random.default_rng(2)
    before, after = ends(rng), ends(rng)
    window_s, step = np.full(3, 0.3), 1e-6
    to_seam_s = np.tile([step, 0.0], (3, 1))
    first, second = seams.turns(before, after)
    a = seams.eased_turn(_moving(before, -to_seam_s), first, to_seam_s, window_s)
    b = seams.eased_turn(_moving(after, to_seam_s), second, -to_seam_s, window_s)
    assert np.allclose(a[:, 1], b[:, 1], atol=1e-12)
    assert np.allclose(sphere.angle(a[:, 1], before.value), sphere.angle(before.value, after.value) / 2, atol=1e-12)
    assert np.allclose((a[:, 1] - a[:, 0]) / step, (b[:, 0] - b[:, 1]) / step, atol=1e-4)


def test_opposite_bones_meet_half_way_too():
    up, down = (End(np.array([[[0, 0, z]]]), np.zeros((1, 1, 3)), np.zeros((1, 1))) for z in (1.0, -1.0))
    first, second = seams.turns(up, down)
    met = seams.turned(up.value, first.shift), seams.turned(down.value, second.shift)
    assert np.allclose(met[0], met[1], atol=1e-12) and abs(met[0][0, 0, 2]) < 1e-12


def test_plain_channels_meet_half_way_at_the_mean_of_both_rates():
    before, after = (End(np.array([[v]]), np.array([[r]]), np.zeros((1, 1))) for v, r in ((1.0, 0.5), (2.0, -0.5)))
    first, second = seams.shifts(before, after)
    window_s, times = np.array([0.4]), np.linspace(0, 0.4, 4001)
    a = seams.eased_shift((1.0 + 0.5 * (times - 0.4))[None, :, None], first, (0.4 - times)[None], window_s)[0, :, 0]
    b = seams.eased_shift((2.0 - 0.5 * times)[None, :, None], second, -times[None], window_s)[0, :, 0]
    assert a[-1] == pytest.approx(1.5) and b[0] == pytest.approx(1.5)
    assert (a[-1] - a[-2]) / 1e-4 == pytest.approx(0.0, abs=1e-2) and (b[1] - b[0]) / 1e-4 == pytest.approx(0, abs=1e-2)
    assert a[0] == 1.0 - 0.2 and b[-1] == 2.0 - 0.2


def test_a_jump_of_speed_no_larger_than_those_beside_it_is_left():
    times = np.arange(20)[None] * 0.02
    rough = np.cumsum(np.where(np.arange(20) % 2, 0.1, 0.0))[None, :, None]
    one, two = seams.end_of(rough, times, last=True), seams.end_of(rough, times, last=False)
    assert seams.shifts(one, two)[0].rate == 0.0


def _moving(end, seconds):
    """Directions (n, T, B, 3) that pass the end's value at 0 s with its rate."""
    return sphere.exp(end.value[:, None] + 0 * seconds[..., None, None], seconds[..., None, None] * end.rate[:, None])
