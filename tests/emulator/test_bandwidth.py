import numpy as np
import pytest

from emulator.model.joint_coordinates import within_worker
from emulator.model.smoothed import Bands, Curves, less_told, smoothed, told_by_curves
from emulator.people.kinds import Kinds
from emulator.people.population import Population

OWNERS = 5


def made(n_each=8, kinds=0.0, k=6, seed=0, bend=None):
    """Smoothed scores of made people, their posture scores being all of z but the last coordinate (a duration)."""
    rng = np.random.default_rng(seed)
    owner = np.repeat(np.arange(OWNERS), n_each)
    size = np.array([3.0, 2.0, 1.5, 1.0, 0.5, 0.25])[:k]
    raw = (rng.normal(size=(OWNERS, k))[owner] + 0.7 * rng.normal(size=(len(owner), k))) * size
    raw[::2, 0] += kinds
    size = raw.std(0, ddof=1)
    z = np.column_stack([(raw - raw.mean(0)) / size, raw[:, 0] / 3 + 0.3 * rng.normal(size=len(raw))])
    means = np.stack([z[owner == w].mean(0) for w in range(OWNERS)])[owner]
    spread = np.sqrt(np.sum((z - means) ** 2, axis=0) / (len(z) - OWNERS))
    centred = raw - raw.mean(0)
    bend = np.zeros((k, k)) if bend is None else bend
    return smoothed(z, owner, spread, Curves(slice(0, k), size, bend), (), centred @ centred.T, 16.0), centred, size


def alone(blurred):
    """(N, C) deviations of the recordings' curves themselves, drawn in, before any two are mixed."""
    return blurred.left[:, : len(blurred.tells)]


def covariance(blurred):
    """(K, K) that somebody's draws have: of deviations and of the noise."""
    deviation = blurred.deviations
    noise = np.mean(blurred.reach**2) * blurred.factor.T @ blurred.factor
    return deviation.T @ deviation / len(deviation) + noise


def nearest(draws, recorded):
    return np.sqrt(((draws[:, None] - recorded[None]) ** 2).sum(-1)).min(1)


def drawn_alike(blurred, size, n=4000):
    rng = np.random.default_rng(5)
    at = rng.integers(len(blurred.scores), size=n)
    centre = blurred.means[blurred.owner][:, : len(size)] + alone(blurred)
    z = centre[at] + (blurred.reach[at, None] * blurred.noise.sample(n, rng))[:, : len(size)]
    return z * size


@pytest.mark.parametrize("kinds", [0.0, 8.0])
def test_draws_are_nearly_as_far_from_recordings_as_a_left_out_recording_is(kinds):
    blurred, recorded, size = made(n_each=20, kinds=kinds)
    among = np.sqrt(((recorded[:, None] - recorded[None]) ** 2).sum(-1)) + np.diag(np.full(len(recorded), np.inf))
    quartiles = (0.25, 0.5, 0.75)
    ratio = np.quantile(nearest(drawn_alike(blurred, size), recorded), quartiles) / np.quantile(among.min(1), quartiles)
    assert (0.9 if kinds == 0 else 0.8) < np.exp(np.log(ratio).mean()) < 1.08
    assert ratio.max() < 1.2


def test_twins_get_no_noise_along_the_posture():
    blurred, _, _ = made()
    z = np.repeat(blurred.scores, 2, axis=0)
    raw = z[:, :6]
    posture = Curves(slice(0, 6), np.ones(6), np.zeros((6, 6)))
    twins = smoothed(z, np.repeat(blurred.owner, 2), blurred.spread, posture, (), raw @ raw.T, 16.0)
    assert np.abs(twins.factor[:, :6]).max(initial=0.0) < 1e-2


def test_noise_bends_less_than_the_recordings():
    bend = np.diag([0.01, 0.01, 0.01, 1.0, 50.0, 200.0])
    stiff, _, _ = made(bend=bend)
    free, _, _ = made()
    share = [np.linalg.norm(b.factor[:, 4:6]) / np.linalg.norm(b.factor[:, :3]) for b in (stiff, free)]
    assert share[0] < 0.2 * share[1]


def test_noise_and_what_is_left_of_recordings_add_up_in_each_band_and_fine_detail_stays_whole():
    rng = np.random.default_rng(1)
    bend, size, z = np.diag([0.01, 0.1, 1.0, 1e6]), np.array([2.0, 1.0, 1.0, 0.5]), rng.normal(size=(30, 4))
    bands = Bands.of(z, Curves(slice(0, 4), size, bend), 4.0)
    noise = bands.noise(40.0, 0.5)
    assert bands.share @ noise == pytest.approx(0.5, abs=1e-3) and noise[0] >= noise[1] > noise[2] and noise[3] < 1e-6
    left, blur = (bands.times(z, np.sqrt(share)) for share in (1.0 - noise, noise))
    assert np.allclose(np.sum(left**2 + blur**2, axis=0), np.sum(z**2, axis=0))
    assert np.allclose(left[:, 3], z[:, 3]) and np.allclose(blur[:, 3], 0.0, atol=1e-3)
    assert bands.noise(1e-3, 0.5).max() < 1e-5


def test_people_keep_their_fine_detail_and_all_their_variance():
    rng = np.random.default_rng(2)
    curve, between = Curves(slice(0, 3), np.ones(3), np.diag([0.01, 1.0, 1e6])), rng.normal(size=(4, 5))
    one = Kinds.one(*between.shape)
    law = Population.fit(between, [(curve.at, Bands.of(between[:, :3], curve, 4.0))], slice(4, 5), one)
    alike = law.drawn_in * between + law.fine
    assert np.allclose(np.sum(alike**2 + law.rows**2, axis=0), np.sum(between**2, axis=0))
    assert np.allclose(alike[:, 2], between[:, 2]) and np.abs(alike[:, 0]).max() < 0.9 * np.abs(between[:, 0]).max()


def test_a_strange_repetition_does_not_set_the_noise():
    def noise(strange):
        blurred, _, size = made(n_each=8)
        z = blurred.scores.copy()
        z[3, :6] += strange * np.array([0, 0, 0, 0, 0, 8.0])
        raw = (z[:, :6]) * size
        owner = blurred.owner
        posture = Curves(slice(0, 6), size, np.zeros((6, 6)))
        return smoothed(z, owner, blurred.spread, posture, (), raw @ raw.T, 16.0).factor

    plain, shaken = (np.linalg.norm(noise(s)[:, 5]) / np.linalg.norm(noise(s)[:, 0]) for s in (0, 20))
    assert shaken < 10 * plain


def test_the_same_recordings_give_the_same_bytes():
    assert made()[0].factor.tobytes() == made()[0].factor.tobytes()


def test_what_curves_do_not_tell_takes_noise_by_the_rule():
    """Silverman's h for 8 repetitions a worker is (4 / 24)^(1/5) = 0.70: a third of the variance is noise."""
    blurred, _, _ = made(n_each=8)
    rest = less_told(within_worker(blurred.scores, blurred.owner), blurred.tells)[:, -1]
    noise = np.sum(less_told(blurred.factor, blurred.tells)[:, -1] ** 2) * np.mean(blurred.reach**2)
    share = noise / (np.sum(rest**2) / (len(rest) - OWNERS))
    by_rule = 0.70**2 / (1 + 0.70**2)
    assert by_rule - 0.005 < share < 0.55  # beside it, what a recording tells and its smooth part does not


@pytest.mark.parametrize("each, off", [(2, 0.01), (3, 1e-9), (8, 1e-9), (30, 1e-9)])
def test_the_variance_beside_curves_is_whole_however_few_repetitions_a_worker_has(each, off):
    """Of two repetitions half is noise, and beside what curves tell there may be nothing left to draw in."""
    blurred, _, _ = made(n_each=each)
    assert covariance(blurred)[-1, -1] == pytest.approx(blurred.spread[-1] ** 2, rel=off)


@pytest.mark.parametrize("kinds", [0.0, 8.0])
def test_duration_goes_with_the_posture_as_it_does_in_the_recordings(kinds):
    """Where what varies most bends most, it takes little noise, and a duration that was all noise kept 0.08 to 0.66 of
    the covariance."""
    blurred, _, size = made(n_each=12, kinds=kinds, bend=np.diag([5.0, 1.0, 0.1, 0.1, 0.1, 0.1]))
    deviation = blurred.scores - blurred.means[blurred.owner]
    recorded = (deviation.T @ deviation / (len(deviation) - OWNERS))[:6, -1] * size
    kept = (covariance(blurred)[:6, -1] * size) @ recorded / (recorded @ recorded)
    assert 0.75 < kept < 1.1


def test_curves_tell_what_they_foretell_and_nothing_else():
    """Of a duration that the first score sets to 0.8 of its variance, and of one that has nothing to do with it."""
    rng = np.random.default_rng(3)
    owner, size = np.repeat(np.arange(OWNERS), 20), np.array([3.0, 2.0, 1.0, 0.5])
    z = rng.normal(size=(len(owner), 6))
    z[:, 4] = 0.8**0.5 * z[:, 0] + 0.2**0.5 * z[:, 4]
    own = within_worker(z, owner)
    tells = told_by_curves(own, (Curves(slice(0, 4), size, np.zeros((4, 4))),), len(z) - OWNERS)
    left = np.mean(less_told(own, tells)[:, 4:] ** 2, axis=0) / np.mean(own[:, 4:] ** 2, axis=0)
    assert tells.shape == (4, 2) and left[0] == pytest.approx(0.2, abs=0.06) and left[1] > 0.9
