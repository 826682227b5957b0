import json
from itertools import pairwise

import numpy as np
import pytest

from emulator.geometry import elastic, sphere
from emulator.geometry import warps as warp
from emulator.geometry.alignment import align
from emulator.geometry.elastic import channels, warped, warped_numpy
from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.recordings import read_motions
from emulator.synthetic.choreography import TASKS
from emulator.synthetic.tasks import make
from tests.made import made_sequences, random_warp
from tests.naive import naive_edge, naive_elastic, naive_tsrvf
from tests.recordings import recording, reference


def fields(n_cells, dimension=6, seed=0):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(2, n_cells, dimension)).cumsum(axis=1) / np.sqrt(n_cells)


def test_the_optimum_is_that_of_fdasrsf():
    oracle = json.loads(reference("emulator_oracles.json").read_text())["elastic_dp_fdasrsf_DP2_T101_D6_slope7"]
    sequences, _, base = made_sequences(2, 101, n_bones=2, seed=11)
    q1, q2 = elastic.tsrvf(sequences, base)
    inner, _ = elastic.optimum(q1 @ q2.T)
    norms = (np.sum(q1**2) + np.sum(q2**2)) / 100
    assert inner == pytest.approx(oracle["inner"], rel=1e-12)
    assert norms - 2 * inner == pytest.approx(oracle["sq_distance"], rel=1e-10)
    assert np.allclose(elastic.pair_warp(q1, q2)[[25, 50, 75]], oracle["gamma_quartiles"], atol=1e-12)


def test_moves_are_the_35_coprime_slopes_and_the_straight_one_is_first():
    step = elastic.moves()
    assert len(step.rises) == 35 and (step.rises[0], step.runs[0]) == (1, 1)


@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 2))])
def test_the_optimum_is_the_naive_optimum(seed):
    q1, q2 = fields(16, seed=seed)
    inner, path = elastic.optimum(q1 @ q2.T)
    naive, naive_path = naive_elastic(q1, q2)
    assert inner == pytest.approx(naive, rel=1e-12)
    assert np.array_equal(path, naive_path)


def test_the_optimum_of_unequal_lengths_is_the_naive_optimum():
    q1, q2 = fields(18)
    assert elastic.optimum(q1[:9] @ q2.T)[0] == pytest.approx(naive_elastic(q1[:9], q2)[0], rel=1e-12)


@pytest.mark.parametrize("n_cells", [40, 101])
def test_the_compiled_rows_are_the_numpy_rows(n_cells):
    q1, q2 = fields(n_cells, seed=7)
    (fast, fast_path), (plain, plain_path) = elastic.optimum(q1 @ q2.T), elastic.optimum_numpy(q1 @ q2.T)
    assert fast == pytest.approx(plain, rel=1e-13)
    assert np.array_equal(fast_path, plain_path)


def energies(q1, q2):
    return elastic.energy(q1), elastic.energy(q2)


@pytest.mark.parametrize("n_cells", [20, 57, 100])
@pytest.mark.parametrize("likeness", [0.0, 0.7, 0.99])
def test_leaving_out_what_cannot_be_best_changes_nothing(n_cells, likeness):
    q1, noise = fields(n_cells, seed=n_cells)
    q2 = likeness * q1 + (1 - likeness) * noise
    whole, whole_path = elastic.optimum(q1 @ q2.T)
    pruned, path = elastic.optimum(q1 @ q2.T, energies(q1, q2))
    assert pruned == whole and np.array_equal(path, whole_path)


def test_what_cannot_be_best_is_left_out(monkeypatch):
    sequences, _, base = made_sequences(2, 101, seed=1)
    q1, q2 = elastic.tsrvf(sequences, base)
    filled, kept = elastic._filled, []

    def watched(*arguments):
        best, rows = filled(*arguments)
        kept.append(np.maximum(rows[2] - rows[1] + 1, 0).sum() / rows[0].size)
        return best, rows

    monkeypatch.setattr(elastic, "_filled", watched)
    elastic.optimum(q1 @ q2.T, energies(q1, q2))
    elastic.optimum(q1 @ q2.T)
    assert kept[1] < 0.4 and kept[2] == pytest.approx(0.75, abs=0.02)


def test_pruning_keeps_every_path_of_two_still_sequences_and_of_opposite_ones():
    still = np.zeros((40, 6))
    assert np.allclose(elastic.pair_warp(still, still), np.linspace(0, 1, 41))
    q, _ = fields(40)
    assert elastic.best_warp(q, -q)[1] == elastic.optimum(-q @ q.T)[0]


def test_sequences_of_unequal_length_are_pruned_alike():
    q1, q2 = fields(90, seed=4)
    for short in (14, 30, 60):
        whole, path = elastic.optimum(q1[:short] @ q2.T)
        assert elastic.optimum(q1[:short] @ q2.T, energies(q1[:short], q2))[0] == whole
        assert tuple(path[0]) == (0, 0) and tuple(path[-1]) == (short, 90)


def test_the_optimum_is_worth_its_own_path():
    q1, q2 = fields(60, seed=3)
    inner, path = elastic.optimum(q1 @ q2.T)
    along = sum(naive_edge(q1, q2, tuple(map(int, a)), tuple(map(int, b))) for a, b in pairwise(path))
    assert inner == pytest.approx(along / 60, rel=1e-12)


def test_tsrvf_is_the_naive_tsrvf():
    sequences, _, base = made_sequences(1, 25, n_bones=3, seed=2)
    assert np.allclose(elastic.tsrvf(sequences[0], base), naive_tsrvf(sequences[0], base), atol=1e-10)


@pytest.mark.parametrize("n_times", [12, 60])  # steps beyond the series, and within
def test_the_compiled_field_is_the_numpy_field(n_times):
    sequences, _, base = made_sequences(3, n_times, n_bones=5, seed=6)
    assert np.abs(elastic.tsrvf(sequences, base) - elastic.tsrvf_numpy(sequences, base)).max() < 1e-12
    assert np.array_equal(elastic.tsrvf(sequences[1], base), elastic.tsrvf(sequences, base)[1])


def test_a_posture_opposite_to_the_reference_is_refused():
    sequences, _, base = made_sequences(1, 30, n_bones=3)
    with pytest.raises(ValueError, match="opposite"):
        elastic.tsrvf(np.concatenate([-base[None], sequences[0]]), base)


def test_standing_still_gives_a_zero_field():
    sequences, _, base = made_sequences(1, 30, n_bones=3)
    paused = np.concatenate([sequences[0][:10], np.repeat(sequences[0][10:11], 8, axis=0), sequences[0][10:]])
    field = elastic.tsrvf(paused, base)
    assert np.all(np.isfinite(field)) and np.all(field[10:17] == 0)
    assert np.all(np.any(field[:9] != 0, axis=-1))


def test_two_still_sequences_are_joined_by_the_identity():
    still = np.repeat(sphere.normalise(np.ones((1, 4, 3))), 31, axis=0)
    field = elastic.tsrvf(still, still[0])
    assert np.allclose(elastic.pair_warp(field, field), np.linspace(0, 1, 31), atol=1e-15)


def test_a_sequence_is_joined_to_itself_by_the_identity():
    q, _ = fields(80)
    assert np.allclose(elastic.pair_warp(q, q), np.linspace(0, 1, 81), atol=1e-15)


def test_a_long_hold_drives_the_warp_only_to_its_slope_limit():
    sequences, _, base = made_sequences(1, 101, n_bones=3, seed=5)
    held = np.concatenate([sequences[0][:50], np.repeat(sequences[0][50:51], 60, axis=0), sequences[0][50:]])
    q, q_held = (
        elastic.tsrvf(sequences[0], base),
        elastic.tsrvf(held[np.linspace(0, 160, 101).round().astype(int)], base),
    )
    slope = np.diff(elastic.pair_warp(q, q_held)) * 100
    assert slope.min() > 1 / 7 - 1e-9 and slope.max() < 7 + 1e-9


def test_the_distance_does_not_change_when_both_are_warped_alike():
    sequences, _, base = made_sequences(2, 2001, n_bones=3, seed=8)
    clock = np.linspace(0, 1, 2001)
    gamma = 0.5 * clock + 0.5 * clock**2
    place = np.clip((gamma * 2000).astype(int), 0, 1999)
    warped = sphere.between(sequences[:, place], sequences[:, place + 1], (gamma * 2000 - place)[None, :, None])
    plain, both = (np.sum(np.diff(elastic.tsrvf(s, base), axis=0) ** 2) / 2000 for s in (sequences, warped))
    assert both == pytest.approx(plain, rel=1e-2)


def test_what_cannot_be_joined_is_refused():
    with pytest.raises(ValueError, match="3 cells against 40"):
        elastic.optimum(np.ones((3, 40)))
    with pytest.raises(ValueError, match="not finite"):
        elastic.optimum(np.full((5, 5), np.nan))


RNG = np.random.default_rng(9)
FIELDS = RNG.normal(size=(4, 50, 7))
WARPS = np.array([random_warp(RNG, 51) for _ in range(4)])


def test_the_identity_changes_nothing():
    assert np.allclose(warped(FIELDS, np.tile(np.linspace(0, 1, 51), (4, 1))), FIELDS, atol=1e-13)


def test_a_warp_at_half_speed_keeps_the_norm():
    step = np.repeat(FIELDS[:1, :25], 2, axis=1)
    half = np.concatenate([np.linspace(0, 0.25, 26), np.linspace(0.25, 1, 26)[1:]])[None]
    norms = [np.sum(field**2) for field in (warped(step, half), step)]
    assert norms[0] <= norms[1] + 1e-12
    assert np.allclose(warped(step, half)[0, :25], np.sqrt(0.5) * step[0, np.arange(25) // 2], atol=1e-12)


@pytest.mark.parametrize("n_times", [51, 31, 90])
def test_the_compiled_fields_are_the_numpy_fields(n_times):
    warps = np.array([random_warp(RNG, n_times) for _ in range(4)])
    assert np.abs(warped(FIELDS, warps) - warped_numpy(FIELDS, warps)).max() < 1e-11


def test_warping_by_a_path_of_the_grid_keeps_the_inner_product():
    from emulator.geometry import elastic

    q1, q2 = FIELDS[0], FIELDS[1]
    gamma, inner = elastic.best_warp(q1, q2)
    assert np.sum(q1 * warped(q2[None], gamma[None])[0]) / 50 == pytest.approx(inner, rel=1e-12)


CLOCK = np.linspace(0, 1, 201)


def on_the_common_clock(own, warps):
    """Marks (N, E) in own unit time -> (N, E) on the common clock."""
    clock = np.linspace(0, 1, warps.shape[1])
    return np.stack([np.interp(at, gamma, clock) for at, gamma in zip(own, warps)])


def exact_marks(task, truth):
    """(N, E) own unit times at which the key postures of made work really come."""
    return np.stack([np.interp(TASKS[task].mark_clock, CLOCK, gamma) for gamma in truth.warps])


def error_cells(alignment, truth, near=None):
    """Mean error of the warps in hundredths of the clock, or only within 0.08 of the common clock's times ``near``."""
    right = warp.centre(truth.warps)
    error = np.abs(warp.evaluate(alignment.warps, CLOCK) - right) * 100
    if near is None:
        return error.mean()
    at = np.interp(CLOCK, warp.mean(truth.warps), CLOCK)
    return error[:, np.abs(at[:, None] - np.array(near)).min(1) < 0.08].mean()


def test_the_product_of_two_channels_is_a_ridge_where_the_marks_meet():
    one, two = channels(np.array([[0.3], [0.6]]), 100, 2.0, 0.01, 0.05)[..., 0]
    ridge = np.outer(one, two)
    row, column = np.unravel_index(ridge.argmax(), ridge.shape)
    assert (row, column) in [(r, c) for r in (29, 30) for c in (59, 60)]
    along = np.sum(one * channels(np.array([[0.3]]), 100, 2.0, 0.01, 0.05)[0, :, 0]) / 100
    assert along == pytest.approx(0.01 * 2.0, rel=1e-3)  # what marks that meet gain


@pytest.mark.parametrize("marks", [None, np.full((6, 1), 0.4)])
def test_without_strength_marks_change_nothing(marks):
    sequences, _, _ = made_sequences(6, 61, seed=1)
    plain, marked = align(list(sequences)), align(list(sequences), marks=marks, mark_strength=0.0)
    assert np.array_equal(plain.warps, marked.warps) and np.array_equal(plain.template, marked.template)


def test_marks_come_together_and_the_objective_still_never_rises():
    motions, _ = make("inspect", 4, 5, seed=1)
    own = motions.mark_s / motions.duration_s[:, None]
    directions = [motion.directions for motion in motions.motions]
    spreads = []
    for strength in (0.0, 0.01, 0.05):
        alignment = align(directions, marks=own, mark_strength=strength, tolerance=-1.0, max_iterations=6)
        assert all(later <= earlier * (1 + 1e-12) for earlier, later in pairwise(alignment.history))
        assert alignment.template.shape[1] == directions[0].shape[1] * 3
        spreads.append(on_the_common_clock(own, alignment.warps).std(0))
    assert np.all(spreads[1] < spreads[0]) and np.all(spreads[2] < spreads[1])


@pytest.mark.parametrize(
    "task", ["lift", *(pytest.param(t, marks=pytest.mark.slow) for t in ("inspect", "walk", "fasten"))]
)
def test_labels_that_scatter_do_not_spoil_the_warps_of_clean_recordings(task):
    motions, truth = make(task, 5, 6, seed=1)
    own = motions.mark_s / motions.duration_s[:, None]
    directions = [motion.directions for motion in motions.motions]
    plain, marked = error_cells(align(directions), truth), error_cells(align(directions, marks=own), truth)
    assert marked < plain + 0.03


@pytest.mark.parametrize("task", ["reach", *(pytest.param(t, marks=pytest.mark.slow) for t in ("pick", "place"))])
def test_under_tracking_noise_exact_marks_take_a_fifth_of_the_error_beside_them_away(task):
    motions, truth = make(task, 5, 6, seed=1)
    rng = np.random.default_rng(0)
    noisy = [sphere.normalise(m.directions + 0.01 * rng.normal(size=m.directions.shape)) for m in motions.motions]
    near = TASKS[task].mark_clock
    plain = error_cells(align(noisy), truth, near)
    assert error_cells(align(noisy, marks=exact_marks(task, truth)), truth, near) < 0.8 * plain


def test_the_turns_of_a_recorded_squat_come_nearer_to_one_moment():
    motions = read_motions(recording("uiprmd_deep_squat"), where="cov_correct==1")
    own = motions.mark_s / motions.duration_s[:, None]
    directions = [motion.directions for motion in motions.motions]
    plain, marked = (
        on_the_common_clock(own, align(directions, marks=own, mark_strength=strength).warps).std()
        for strength in (0.0, 0.05)
    )
    assert marked < 0.8 * plain


def test_a_fit_asks_for_landmarks_by_name():
    motions = make("lift", 3, 4, seed=2)[0]
    plain, marked = (MotionEmulator.fit(motions, scheme=SCHEMES[-1], landmarks=strength) for strength in (0.0, 0.05))
    assert "landmarks" not in plain.report.methods and "0.05" in marked.report.methods["landmarks"]
    at = marked.scale.block("marks")
    assert np.all(marked.workforce.within.spread[at] > 0)
    assert plain.sample(5, np.random.default_rng(0)).mark_s.shape == (5, 2)


@pytest.mark.parametrize(
    ("marks", "settings", "word"),
    [
        ([[1.2]], (0.01, 0.04), r"must lie in \[0, 1\]"),
        ([[np.nan]], (0.01, 0.04), r"must lie in \[0, 1\]"),
        ([[0.2]], (-1.0, 0.04), "strength -1.0 must be 0 or more"),
        ([[0.2]], (0.01, 0.0), "width 0.0 above 0"),
    ],
)
def test_marks_that_make_no_sense_are_refused(marks, settings, word):
    with pytest.raises(ValueError, match=word):
        channels(np.array(marks), 50, 1.0, *settings)
