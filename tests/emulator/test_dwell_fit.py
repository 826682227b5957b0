import numpy as np
import pytest

from emulator.geometry.pauses import Hold, cut
from emulator.model.dwell_fit import _latent, _sites, fit_dwells, predictors, said
from emulator.model.dwell_times import NONE
from emulator.model.joint_coordinates import fit_margin
from tests.emulator.pausing import paused_work

IDENTITY = np.tile(np.linspace(0, 1, 11), (4, 1))


def hold(share, dwell_s, mark_share=()):
    return Hold(0, 1, dwell_s, share, mark_share)


def test_pauses_at_nearly_one_place_are_one_site_and_others_their_own():
    assert _sites(np.array([0.50, 0.11, 0.56, 0.9, 0.48, 0.12]), np.arange(6)).tolist() == [1, 0, 1, 2, 1, 0]
    assert _sites(np.array([0.3]), np.arange(1)).tolist() == [0]


def test_two_pauses_of_one_repetition_are_two_sites_unless_they_are_very_near():
    assert _sites(np.array([0.50, 0.56, 0.49, 0.57]), np.array([0, 0, 1, 2])).tolist() == [0, 1, 0, 1]
    assert _sites(np.array([0.50, 0.52]), np.array([0, 0])).tolist() == [0, 0]


def test_there_are_never_more_than_eight_sites():
    site = _sites(np.linspace(0, 1, 15), np.zeros(15, int))
    assert site.max() == 7 and np.all(np.diff(site) >= 0)


def test_sites_dwells_and_marks_are_those_of_the_repetitions():
    holds = [(hold(0.3, 1.0, (0.0, 1.0)), hold(0.8, 2.0, (0.0, 0.5))), (hold(0.32, 1.5, (0.0, 1.0)),), (), ()]
    dwells, latent = fit_dwells(holds, IDENTITY, 2, np.zeros((4, 1)))
    assert np.allclose(dwells.clock, [0.31, 0.8]) and np.allclose(dwells.zero_share, [0.5, 0.75])
    assert np.allclose(dwells.mark_share, [[0, 0], [1, 0.5]])
    assert np.allclose(dwells.seconds(latent), [[1.0, 2.0], [1.5, 0], [0, 0], [0, 0]], atol=1e-6)


def test_two_pauses_of_a_repetition_at_one_site_add_up():
    holds = [(hold(0.3, 1.0), hold(0.31, 0.5)), (hold(0.3, 1.0),), (), ()]
    dwells, latent = fit_dwells(holds, IDENTITY, 0, np.zeros((4, 1)))
    assert np.allclose(dwells.seconds(latent)[:, 0], [1.5, 1.0, 0, 0])


def test_the_place_of_a_pause_is_read_off_the_warp():
    gamma = np.linspace(0, 1, 101) ** 2
    dwells, _ = fit_dwells([(hold(0.25, 1.0),)], gamma[None], 0, np.zeros((1, 1)))
    assert dwells.clock[0] == pytest.approx(0.5, abs=1e-3)


def test_latent_coordinates_are_normal_scores_and_keep_what_goes_with_pauses():
    rng = np.random.default_rng(0)
    known = rng.standard_normal(400)
    truth = 0.7 * known + np.sqrt(1 - 0.49) * rng.standard_normal(400)
    seconds = np.where(truth > 0.3, np.exp(0.2 * truth), 0.0)
    logs = np.log(seconds[seconds > 0])
    latent = _latent(seconds, float(np.mean(seconds == 0)), fit_margin(logs, logs, 12, 0.05), known[:, None])
    assert latent.mean() == pytest.approx(0, abs=0.05) and latent.std() == pytest.approx(1, abs=0.05)
    assert np.corrcoef(latent, known)[0, 1] == pytest.approx(0.7, abs=0.08)
    assert np.all(latent[seconds == 0] < latent[seconds > 0].min())


def test_workers_who_pause_more_often_have_a_higher_score():
    paused = paused_work("reach", 0.4, 3, 4, seed=2)
    holds = [(hold(0.4, 1.0),) if motion.worker == "w2" else () for motion in paused.motions.motions]
    often = predictors(holds, paused.motions, np.log(paused.motions.duration_s))[:, 1]
    assert np.all(often[4:8] > often[:4].max()) and np.all(np.isfinite(often))


def test_the_note_says_how_many_how_long_and_where():
    paused = paused_work("walk", 0.5, 3, 4)
    moving, holds = cut(paused.motions)
    (note,) = said(*[fit_dwells(holds, np.tile(np.linspace(0, 1, 101), (12, 1)), 1, np.zeros((12, 1)))[0], holds])
    assert f"in {np.sum(paused.dwell_s > 0)} of 12 repetitions" in note
    assert said(NONE, [()] * 12) == ()
    assert len(moving) == 12
