"""``tests/motion_evidence``: that its verdicts see what does not hold, and a small run of it with wide bounds."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from motion_evidence.drawers import COPIER, OURS, PAPER, REAL, SHAKER
from motion_evidence.halves import N_KNOTS, N_TIMES, halves, path_of
from motion_evidence.judged import Split, judge_split
from motion_evidence.table import lines
from motion_evidence.verdicts import failures, figures

from emulator.fitting.registration import registered
from emulator.fitting.settings import FitSettings
from emulator.judge import Comparison
from emulator.judge.held_out import HeldOutRow
from emulator.model.emulator import SCHEME
from tests.recordings import recording

GOOD = Comparison(energy=0.01, energy_stratified=0.02, p=0.5, novelty=1.0, temporal_roughness=1.0, roughness=1.0)
TIMES = (HeldOutRow("squat", "duration", 10, 10, 0.1, 0.5, (0.0,) * 5),)


def a_split(number=0, **ours):
    compared = {
        OURS: replace(GOOD, **ours),
        PAPER: replace(GOOD, energy=0.1, energy_stratified=0.1, novelty=2.0),
        COPIER: replace(GOOD, novelty=0.0),
        SHAKER: replace(GOOD, novelty=0.5),
        REAL: GOOD,
    }
    return Split("squat", number, compared, 1.0, 30, 1.0, 1.2, TIMES, TIMES)


def test_what_holds_is_not_complained_of():
    assert failures([a_split(), a_split(1)]) == []


@pytest.mark.parametrize(
    ("ours", "words"),
    [
        ({"energy": 0.03}, "energy 0.30 of the paper's"),
        ({"novelty": 0.7}, "novelty 0.70"),
        ({"novelty": 1.3}, "novelty 1.30"),
        ({"temporal_roughness": 0.89}, "temporal roughness 0.89"),
        ({"roughness": 1.21}, "second differences 1.21"),
        ({"p": 0.04}, "DISCO p above 0.05 in 0 of 2"),
    ],
)
def test_each_bound_is_seen_to_fail(ours, words):
    assert words in failures([a_split(0, **ours), a_split(1, **ours)])[0]


def test_a_control_that_passes_is_a_failure_of_the_judges():
    split = a_split()
    blind = replace(split, compared=split.compared | {COPIER: GOOD})
    assert failures([blind]) == ["squat: the resampler passes"]


def test_too_many_numbers_or_too_large_an_error_are_seen():
    assert "41 numbers lose 1.000" in failures([replace(a_split(), n_components=41)])[0]
    assert "lose 1.300, the paper's 300 lose 1.200" in failures([replace(a_split(), error=1.3)])[0]


def test_figures_are_medians_over_the_splits():
    found = figures([a_split(i, energy=e) for i, e in enumerate((0.0, 0.02, 0.09))], "squat", OURS)
    assert (found.energy, found.n_splits) == (0.02, 3)
    assert np.isclose(found.ratio, 0.2) and np.isclose(found.ratio_of_medians, 0.2)


def test_the_table_has_a_line_for_every_drawer_and_quantity():
    text = list(lines([a_split()]))
    assert [sum(name in line for line in text) for name in (PAPER, COPIER, SHAKER, REAL)] == [1] * 4
    assert sum("duration" in line for line in text) == 2


@functools.cache
def judged():
    recording("uiprmd_deep_squat")
    return [judge_split("deep_squat", split, 300) for split in range(2)]


def test_halves_share_the_people_and_no_repetition():
    recording("uiprmd_deep_squat")
    made = halves("deep_squat", 0)
    assert made.fitted.workers == made.held.workers
    first, second = ({(m.name, m.covariates["cov_correct"]) for m in half.motions} for half in (made.fitted, made.held))
    assert not first & second
    assert len(made.a) + len(made.b) == 82 and made.a.shape[1:] == made.b.shape[1:] == (301, 20, 3)
    assert path_of("deep_squat").exists()


def test_the_fitted_half_is_aligned_as_the_emulator_aligns_it():
    """Else drawn and unseen postures would stand on two clocks."""
    recording("uiprmd_deep_squat")
    made = halves("deep_squat", 0)
    settings = FitSettings(SCHEME, None, N_TIMES, N_KNOTS, landmarks=0.0, seed=0, command="")
    assert np.abs(made.a - registered(made.fitted, settings, None).directions).max() < 1e-9


@pytest.mark.slow
def test_the_emulator_stands_on_unseen_squats():
    ours = figures(judged(), "deep_squat", OURS)
    assert ours.n_passed == 2
    assert ours.ratio_of_medians < 0.4
    assert 0.6 < ours.novelty < 1.4
    assert 0.8 < ours.roughness < 1.2


@pytest.mark.slow
@pytest.mark.parametrize("control", [COPIER, SHAKER])
def test_a_copier_is_seen_through_by_its_novelty(control):
    found = figures(judged(), "deep_squat", control)
    assert found.n_passed == 2 and found.novelty < 0.7


@pytest.mark.slow
def test_fewer_numbers_than_the_papers_lose_less_of_unseen_squats():
    for split in judged():
        assert split.n_components <= 40 and split.error < split.paper_error


@pytest.mark.slow
def test_durations_and_marks_of_unseen_squats_are_as_good_as_resampled_ones():
    for split in judged():
        for emulated, resampled in zip(split.emulated_times, split.resampled_times):
            assert emulated.p > 0.01
            assert emulated.distance < resampled.distance + 0.1
