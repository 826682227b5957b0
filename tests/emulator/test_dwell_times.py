import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ndtri
from scipy.stats import ks_2samp

from emulator.geometry.pauses import Hold, cut
from emulator.model.dwell_fit import _latent, _sites, fit_dwells, predictors, said
from emulator.model.dwell_times import NONE, Dwells
from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.model.joint_coordinates import Margin, fit_margin
from emulator.model.library import LibraryError, MotionLibrary
from emulator.synthetic.tasks import make
from tests.emulator.fitted import made
from tests.emulator.pausing import pause, paused_work
from tests.emulator.test_library import changed, npy, with_header


@pytest.fixture(scope="module")
def paused():
    """Carrying, with a pause of about 1.2 s at 0.4 of the common clock in 40 % of 48 repetitions, and its emulator."""
    work = paused_work("carry", 0.4, 8, 6, seed=3, spread=0.3)
    return work, MotionEmulator.fit(work.motions)


@pytest.fixture(scope="module")
def drawn(paused):
    return paused[1].sample(4000, np.random.default_rng(1))


def rng(seed=0):
    return np.random.default_rng(seed)


def test_a_set_without_pauses_has_no_block_of_dwells():
    emulator = made("lift")[1]
    assert len(emulator.dwells) == 0 and emulator.scale.sizes[-1] == 0
    assert "holds" not in emulator.report.methods
    assert emulator.dwell_s(emulator.sample(3, rng()).scores).shape == (3, 0)


def test_the_share_of_no_pause_and_the_dwells_are_recovered(paused, drawn):
    work, emulator = paused
    dwell_s = emulator.dwell_s(drawn.scores)
    assert dwell_s.shape == (4000, 1)
    assert np.mean(dwell_s == 0) == pytest.approx(np.mean(work.dwell_s == 0), abs=0.05)
    assert ks_2samp(dwell_s[dwell_s > 0], work.dwell_s[work.dwell_s > 0]).pvalue > 0.1
    assert ks_2samp(drawn.duration_s, work.motions.duration_s).pvalue > 0.1
    assert ks_2samp(drawn.mark_s[:, 0], work.motions.mark_s[:, 0]).pvalue > 0.1


def test_a_pause_does_not_make_the_movement_slower(paused, drawn):
    _, emulator = paused
    pauses = emulator.dwell_s(drawn.scores)[:, 0] > 0
    moving_s = emulator.moving_s(drawn.scores)
    assert moving_s[pauses].mean() == pytest.approx(moving_s[~pauses].mean(), rel=0.05)


def test_the_report_says_what_was_cut_out_and_keeps_whole_durations(paused):
    work, emulator = paused
    assert any("are cut out and modelled as dwell times" in note for note in emulator.report.notes)
    assert "moving time" in emulator.report.methods["holds"]
    assert np.isclose(emulator.report.duration_mean_s, work.motions.duration_s.mean())
    assert 0.5 < emulator.report.roughness_ratio < 1.5


def test_mean_and_spread_of_the_duration_are_those_of_many_draws(paused):
    _, emulator = paused
    for worker in (None, "w2", emulator.draw_worker(rng(5))):
        duration_s = emulator.sample(10_000, rng(3), worker=worker).duration_s
        assert abs(duration_s.mean() - emulator.mean_duration_s(worker)) < 4 * duration_s.std() / 100
        assert np.isclose(duration_s.std() / duration_s.mean(), emulator.duration_cv(worker), rtol=0.03)


def test_a_given_duration_is_kept_and_long_ones_pause_more_often(paused):
    _, emulator = paused
    share = []
    for duration_s in (3.6, 4.5, 6.0):
        given = emulator.sample(300, rng(2), condition={"duration_s": duration_s})
        assert np.allclose(given.duration_s, duration_s, rtol=1e-9)
        share.append(np.mean(emulator.dwell_s(given.scores) > 0))
    assert share[0] < 0.2 < share[1] < share[2] and share[2] > 0.9


def test_a_given_duration_pauses_as_often_and_as_long_as_free_draws_of_that_duration(paused, drawn):
    _, emulator = paused
    dwell_s = emulator.dwell_s(drawn.scores)
    for duration_s in np.quantile(drawn.duration_s, [0.3, 0.7]):
        free = dwell_s[np.abs(np.log(drawn.duration_s / duration_s)) < 0.03]
        given = emulator.dwell_s(emulator.sample(500, rng(2), condition={"duration_s": duration_s}).scores)
        assert np.mean(given > 0) == pytest.approx(np.mean(free > 0), abs=0.08)
        assert given.mean() == pytest.approx(free.mean(), abs=0.1)


def test_no_draw_of_a_given_duration_is_another_ones_copy(paused):
    scores = paused[1].sample(64, rng(3), condition={"duration_s": 4.0}).scores
    assert len(np.unique(np.round(scores[:, 0], 9))) == 64


def test_a_shift_of_log_duration_is_exact_and_nothing_at_zero(paused):
    _, emulator = paused
    plain = emulator.sample(200, rng(4), worker="w1")
    shifted = emulator.sample(200, rng(4), worker="w1", condition={"log_duration_shift": 0.1})
    assert np.allclose(shifted.duration_s / plain.duration_s, np.exp(0.1))
    same = emulator.sample(200, rng(4), worker="w1", condition={"log_duration_shift": 0.0})
    assert np.allclose(same.scores, plain.scores, atol=1e-12)


def test_a_duration_that_is_none_is_refused(paused):
    with pytest.raises(ValueError, match="positive seconds"):
        paused[1].sample(3, rng(), condition={"duration_s": -1.0})


def test_a_drawn_performance_really_stands_still_for_its_dwell(paused, drawn):
    _, emulator = paused
    dwell_s = emulator.dwell_s(drawn.scores)[:, 0]
    one = drawn[int(np.flatnonzero(dwell_s > 1)[0])]
    mine_s = emulator.dwell_s(one.scores)[0, 0]
    times_s = np.arange(0, one.duration_s[0], 0.01)
    still = np.abs(np.diff(one.positions_m(times_s)[0], axis=0)).max(axis=(1, 2)) < 1e-12
    assert 0.01 * still.sum() == pytest.approx(mine_s, abs=0.03)
    edges = np.flatnonzero(np.diff(still.astype(int)))
    assert len(edges) == 2  # in one piece


def test_a_performance_that_does_not_pause_moves_as_one_of_an_emulator_without_pauses(paused, drawn):
    _, emulator = paused
    one = drawn[int(np.flatnonzero(emulator.dwell_s(drawn.scores)[:, 0] == 0)[0])]
    bare = replace(emulator, dwells=made("lift")[1].dwells).performances(one.scores, turns=one.turns)
    assert np.allclose(one.duration_s, bare.duration_s) and np.allclose(one.mark_s, bare.mark_s)
    assert np.allclose(one.positions_m(), bare.positions_m(), atol=1e-12)


def test_marks_are_in_order_inside_the_duration_and_later_by_the_pause(paused, drawn):
    _, emulator = paused
    edges = np.column_stack([np.zeros(len(drawn)), drawn.mark_s, drawn.duration_s])
    assert np.all(np.diff(edges, axis=1) > 0)
    pauses = emulator.dwell_s(drawn.scores)[:, 0] > 0
    late = drawn.mark_s[pauses, 0].mean() - drawn.mark_s[~pauses, 0].mean()
    assert late == pytest.approx(emulator.dwell_s(drawn.scores)[pauses].mean(), rel=0.15)


def test_one_performance_is_the_blocks(paused, drawn):
    block = drawn[:20].positions_m(n_times=33)
    assert np.abs(drawn[7].positions_m(n_times=33)[0] - block[7]).max() < 1e-10


def test_who_always_paused_pauses_and_who_never_did_hardly_does():
    original = make("lift", 6, 5, seed=5)[0]
    rng_s = np.random.default_rng(0)
    motions = [
        pause(m, 0.4, round(40 + 40 * rng_s.uniform()))[0] if m.worker in "w1 w2" else m for m in original.motions
    ]
    emulator = MotionEmulator.fit(replace(original, motions=tuple(motions)), scheme=SCHEMES[-1])

    def pauses(drawn):
        return np.mean(emulator.dwell_s(drawn.scores).any(axis=1))

    assert len(emulator.dwells) == 1
    share = {w: pauses(emulator.sample(2000, rng(), worker=w)) for w in emulator.workers}
    assert min(share["w1"], share["w2"]) > 0.7
    assert max(share[w] for w in ("w3", "w4", "w5", "w6")) < 0.2


@pytest.mark.slow
@pytest.mark.parametrize("task", ["reach", "lift", "inspect", "walk", "place"])
@pytest.mark.parametrize("noise_rad", [0.0, 0.003])
def test_dwells_of_any_made_work_are_recovered_through_tracking_noise(task, noise_rad):
    work = paused_work(task, 0.4, 10, 10, seed=7, spread=0.35, noise_rad=noise_rad)
    emulator = MotionEmulator.fit(work.motions)
    drawn = emulator.sample(5000, rng())
    dwell_s = emulator.dwell_s(drawn.scores).sum(axis=1)
    assert np.mean(dwell_s == 0) == pytest.approx(np.mean(work.dwell_s == 0), abs=0.06)
    assert np.mean(dwell_s) == pytest.approx(np.mean(work.dwell_s), rel=0.15)  # slow frames count as still
    assert ks_2samp(dwell_s[dwell_s > 0], work.dwell_s[work.dwell_s > 0]).pvalue > 0.005  # for the same reason
    assert ks_2samp(drawn.duration_s, work.motions.duration_s).pvalue > 0.01


@pytest.fixture
def saved(paused, tmp_path):
    MotionLibrary.of(paused[1], made("lift")[1]).save(tmp_path / "moves.npz")
    return tmp_path / "moves.npz"


def test_a_saved_model_pauses_as_before(paused, saved):
    again = MotionLibrary.load(saved)["carry"]
    one, two = (model.sample(50, rng(7)) for model in (paused[1], again))
    assert one.duration_s.tobytes() == two.duration_s.tobytes() and one.mark_s.tobytes() == two.mark_s.tobytes()
    assert one.directions(n_times=5).tobytes() == two.directions(n_times=5).tobytes()
    again.save(saved.with_name("again.npz"))
    paused[1].save(saved.with_name("once.npz"))
    assert saved.with_name("again.npz").read_bytes() == saved.with_name("once.npz").read_bytes()


@pytest.mark.parametrize(
    ("name", "value", "word"),
    [
        ("dwell_clock", [1.7], "dwell_clock: found a value outside 0 to 1"),
        ("dwell_zero_share", [1.0], "sites of pauses make no sense"),
        ("dwell_zero_share", [-0.2], "dwell_zero_share: found a value outside"),
        ("dwell_mark_share", [[2.0]], "dwell_mark_share: found a value outside"),
        ("dwell_clock", [0.2, 0.4], "dwell_clock: found"),
    ],
)
def test_sites_that_make_no_sense_are_refused(saved, name, value, word):
    bad = npy(np.array(value))
    with pytest.raises(LibraryError, match=word):
        MotionLibrary.load(changed(saved, lambda member, data: bad if member == f"carry/{name}.npy" else data))


def test_a_hostile_header_of_dwells_is_refused(saved):
    def shrunk(header):
        header["tasks"]["carry"]["dwell_slopes"] = [-1.0]
        return json.loads(json.dumps(header))

    with pytest.raises(LibraryError, match="dwell 0 does not increase"):
        MotionLibrary.load(with_header(saved, shrunk))


def test_a_missing_array_of_dwells_is_named(saved):
    with pytest.raises(LibraryError, match="carry/dwell0_value"):
        MotionLibrary.load(changed(saved, lambda member, data: None if "dwell0_value" in member else data))


NORMAL = Margin(np.zeros(1), np.array([0.3]), 0.25)
TWO = Dwells(np.array([0.2, 0.7]), np.array([0.6, 0.0]), (NORMAL, NORMAL), np.zeros((0, 2)))


def test_below_the_threshold_there_is_no_pause():
    at = ndtri(0.6)
    assert TWO.seconds(np.array([[at - 1e-9, 0.0], [at + 1e-3, 0.0]]))[:, 0].tolist()[0] == 0.0
    assert TWO.seconds(np.array([[at + 1e-3, 0.0]]))[0, 0] > 0


def test_a_site_where_all_pause_has_no_threshold():
    assert TWO.seconds(np.array([[0.0, 1.5]]))[0, 1] == pytest.approx(np.exp(0.3 + 0.25 * 1.5))


def test_dwells_rise_with_their_coordinate():
    seconds = TWO.seconds(np.linspace(-6, 6, 400)[:, None] * np.ones(2))
    assert np.all(np.diff(seconds, axis=0) >= 0)


def test_normal_coordinates_give_the_share_of_no_pause_and_the_law_of_the_others():
    drawn = TWO.seconds(np.random.default_rng(0).standard_normal((200_000, 2)))[:, 0]
    assert np.mean(drawn == 0) == pytest.approx(0.6, abs=0.005)
    logs = np.log(drawn[drawn > 0])
    assert (logs.mean(), logs.std()) == (pytest.approx(0.3, abs=0.005), pytest.approx(0.25, abs=0.005))


def test_the_mean_is_that_of_many_draws():
    mean, spread = np.array([0.2, -0.1]), np.array([0.8, 1.1])
    drawn = TWO.seconds(mean + spread * np.random.default_rng(0).standard_normal((400_000, 2)))
    assert np.allclose(TWO.mean_s(mean, spread), drawn.mean(0), atol=4 * drawn.std(0).max() / np.sqrt(400_000))


def test_without_sites_nothing_pauses():
    assert len(NONE) == 0 and NONE.seconds(np.zeros((3, 0))).shape == (3, 0)


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
