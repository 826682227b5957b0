"""``tests/motion_evidence``: that its verdicts see what does not hold, and a small run of it with wide bounds.

``motion_evidence.real_time``: that its bounds see what does not hold, and that its tables show what was measured.
"""

import functools
from dataclasses import replace

import numpy as np
import pytest
from motion_evidence import real_time
from motion_evidence.drawers import COPIER, OURS, PAPER, REAL, SHAKER
from motion_evidence.halves import N_KNOTS, N_TIMES, halves, path_of
from motion_evidence.judged import Split, judge_split
from motion_evidence.real_time_bounds import failures as real_time_failures
from motion_evidence.real_time_bounds import share_needed
from motion_evidence.real_time_rows import held_out, in_sample, people_of
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
    assert "49 numbers lose 1.000" in failures([replace(a_split(), n_components=49)])[0]
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
        assert split.n_components <= 48 and split.error < split.paper_error


@pytest.mark.slow
def test_durations_and_marks_of_unseen_squats_are_as_good_as_resampled_ones():
    for split in judged():
        for emulated, resampled in zip(split.emulated_times, split.resampled_times):
            assert emulated.p > 0.01
            assert emulated.distance < resampled.distance + 0.1


FOUND = {
    **dict.fromkeys(("too_fast_known", "too_fast_new"), 0.0),
    **dict.fromkeys(("jerk_ratio_known", "jerk_ratio_new", "speed_ratio_known", "decoded_jerk"), 1.0),
    **{f"{part}_{who}": 1.0 for part in ("wander_cm", "slide_cm", "sunk_mm") for who in ("recorded", "known", "new")},
    **{f"unsupported_{who}": 0.1 for who in ("recorded", "known", "new")},
    **{"decoded_mm": 5.0, "decoded_auc": 0.5, "auc_drawn": 0.7},
    **{f"{name}_{kind}": 9.0 for name in ("places", "speeds") for kind in ("drawn", "halves")},
    **{"people_left_out": 6, "duration_50": 0.5, "duration_90": 0.9, "posture_50": 0.5, "posture_90": 0.9},
    **{"novelty_drawn": 1.0, "p_drawn": 0.5},
}


def failing(before=None, refused=None, **changed):
    return real_time_failures({"squat": FOUND | changed}, refused or {}, {"squat": before or {}})


def test_what_holds_is_not_complained_of_in_real_time():
    assert failing(before=FOUND) == [] and real_time_failures({"squat": {}}, {}, {}) == []


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"too_fast_known": 0.03}, "too fast: holds in 0 of 1 classes, not in squat (known 0.030)"),
        ({"too_fast_new": 0.06}, "new 0.060"),
        ({"jerk_ratio_known": 1.4}, "peak jerk of known people 1.40 x"),
        ({"jerk_ratio_new": 1.6}, "peak jerk of new people 1.60 x"),
        ({"speed_ratio_known": 0.85}, "median peak speed 0.85 x"),
        ({"decoded_jerk": 1.2}, "jerk of encode -> decode 1.20 x"),
        ({"decoded_mm": 11.0}, "11 mm off"),
        ({"places_drawn": 10.0}, "energies: holds in 0 of 1 classes, not in squat (places 1.11)"),
        ({"decoded_auc": 0.7}, "classifier: holds in 0 of 1"),
        ({"auc_drawn": 0.8}, "drawn 0.80"),
        ({"wander_cm_known": 1.3}, "wander of known people's feet 1.3 cm"),
        ({"slide_cm_new": 0.7}, "slide of new people's feet 0.7 cm"),
        ({"sunk_mm_known": 7.0}, "known people 7 mm in the floor"),
        ({"unsupported_new": 0.2}, "new off their feet 0.20"),
        ({"posture_90": 0.8}, "posture 90 %: holds 0.80"),
        ({"novelty_drawn": 0.6}, "novelty 0.60, before 1.00"),
        ({"p_drawn": 0.01}, "p 0.01, before 0.50"),
    ],
)
def test_what_does_not_hold_is_named(changed, words):
    found = failing(before=FOUND, **changed)
    assert len(found) == 1 and words in found[0]


def test_a_refused_fit_is_named():
    assert failing(refused={"squat, people s03": "opposite"}) == ["squat, people s03: refused: opposite"]


def test_of_fifteen_classes_as_many_are_asked_for_as_the_issue_says():
    assert [share_needed(kind, 15) for kind in ("too fast", "energies", "classifier")] == [13, 13, 10]


def test_tables_show_the_means_over_splits_and_leave_out_what_is_not_known():
    jobs = {("halves", "squat", k, 1): {"places_drawn": 3.0 + k, "places_halves": 2.0} for k in (0, 2)}
    table = real_time.figures(jobs, ["squat"])
    assert table["squat"] == {"places_drawn": 4.0, "places_halves": 2.0, "splits": 2, "places_ratio": 2.0}
    shown = "\n".join(real_time.lines(table, ["halves"]))
    assert "4.0" in shown and "2.00" in shown and " - " in shown


def test_an_unknown_class_is_refused_with_the_known_ones(capsys):
    with pytest.raises(SystemExit):
        real_time.main(["squats"])
    assert "no class 'squats'; known: hdm05_deposit_floor" in capsys.readouterr().err


@pytest.mark.slow
def test_a_small_class_is_measured():
    recording("hdm05_throw_ball")
    row = in_sample("hdm05_throw_ball", 9) | held_out("hdm05_throw_ball", 0, 2)
    assert {"too_fast_new", "jerk_ratio_known", "decoded_mm", "decoded_auc", "slide_cm_recorded", "auc_drawn"} <= set(
        row
    )
    assert row["places_drawn"] > 0 and len(people_of("hdm05_throw_ball")) == 3
