import numpy as np
import pytest

from emulator.judge.held_out import held_out_rows, holm, resampled_rows, split_within_workers, table_text
from tests.emulator.fitted import motions_of, recorded

CLASSES = ("deep_squat", "sit_to_stand", "side_lunge", "shoulder_abduction", "shoulder_scaption")


def test_holm_multiplies_the_smallest_most():
    assert np.allclose(holm([0.01, 0.04, 0.03, 0.005]), [0.03, 0.06, 0.06, 0.02])


def test_holm_never_passes_one():
    assert holm([0.9, 0.8]).tolist() == [1.0, 1.0]


def test_each_worker_is_split_in_halves():
    first, second = split_within_workers(motions_of("lift"), 3)
    for half in (first, second):
        assert np.bincount(half.worker_index).tolist() == [4] * 5
    assert not {m.name for m in first.motions} & {m.name for m in second.motions}


def test_resampled_durations_are_those_of_the_same_workers():
    """Fitted on itself the control has the law of what it is compared with."""
    motions = motions_of("lift")
    rows = resampled_rows(motions, motions, np.random.default_rng(0))
    assert [row.quantity for row in rows] == ["duration", "grasp", "set_down"]
    assert max(row.distance for row in rows) < 0.03
    assert np.abs([row.quantile_error_percent for row in rows]).max() < 5


def test_a_wrong_model_would_be_seen():
    """The test has power: durations stretched by half are refused."""
    from dataclasses import replace

    motions = motions_of("lift")
    _, held = split_within_workers(motions, 0)
    slow = {m.name for m in held.motions}
    stretched = tuple(
        replace(m, time_s=1.5 * m.time_s, mark_s=1.5 * m.mark_s) if m.name in slow else m for m in motions.motions
    )
    rows = held_out_rows(replace(motions, motions=stretched), seed=0)
    assert max(holm([row.p for row in rows])) < 0.05


@pytest.mark.slow
def test_durations_and_marks_of_the_same_people_pass_on_five_recorded_classes():
    rows = [row for name in CLASSES for row in held_out_rows(recorded(name), seed=0)]
    print("\n" + table_text(rows))
    assert len(rows) == 10
    assert holm([row.p for row in rows]).min() > 0.05
    assert np.median(np.abs([row.quantile_error_percent for row in rows])) < 8
