from itertools import pairwise

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.geometry import warps as warp
from emulator.geometry.alignment import align
from emulator.geometry.elastic import channels
from emulator.model.emulator import MotionEmulator
from emulator.recordings import read_motions
from emulator.synthetic.choreography import TASKS
from emulator.synthetic.tasks import make
from tests.made import made_sequences
from tests.recordings import recording

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


@pytest.mark.parametrize("task", ["lift", "inspect", "walk", "fasten"])
def test_labels_that_scatter_do_not_spoil_the_warps_of_clean_recordings(task):
    motions, truth = make(task, 5, 6, seed=1)
    own = motions.mark_s / motions.duration_s[:, None]
    directions = [motion.directions for motion in motions.motions]
    plain, marked = error_cells(align(directions), truth), error_cells(align(directions, marks=own), truth)
    assert marked < plain + 0.03


@pytest.mark.parametrize("task", ["reach", "pick", "place"])
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
    plain, marked = MotionEmulator.fit(motions), MotionEmulator.fit(motions, landmarks=0.05)
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
