from dataclasses import asdict, replace

import numpy as np
import pytest

from emulator.judge.held_out import COPIER, RECORDED, SHAKER, USUAL
from emulator.judge.held_out_table import HONEST, Figures, Judged, judge_held_out
from emulator.synthetic.tasks import make
from tests.emulator.judge.halved import SMALL, judged, made


def of(*novelties):
    """What was found of a copier in some splits, beside recordings that are as they should be."""
    splits = [
        {RECORDED: Figures(novelty=1.0), COPIER: Figures(novelty=n), SHAKER: Figures(novelty=n)} for n in novelties
    ]
    return Judged("lift", tuple(splits), ())


def test_recordings_come_first_and_both_controls_last():
    assert list(judged().rows) == [RECORDED, *USUAL, COPIER, SHAKER]
    assert len(judged().splits) == 2 and judged().notes == ()


def test_both_controls_fail_novelty_and_the_recordings_do_not():
    assert judged().passing_controls == []
    assert max(judged().rows[name].novelty for name in (COPIER, SHAKER)) < HONEST
    assert judged().rows[RECORDED].novelty > HONEST


def test_a_control_that_is_not_seen_through_is_named():
    assert of(0.1, 0.3).passing_controls == []
    assert of(0.7, 1.0).passing_controls == [COPIER, SHAKER]
    assert of(np.nan).passing_controls == [COPIER, SHAKER]


def test_figures_are_means_over_splits_that_have_them_and_p_values_the_middle():
    splits = tuple({"x": Figures(energy=e, p=p)} for e, p in ((1.0, 0.1), (3.0, 0.2), (np.nan, 0.9)))
    found = Judged("lift", splits, ()).rows["x"]
    assert (found.energy, found.p) == (2.0, 0.2) and np.isnan(found.skate_cm)


def test_a_schemes_figures_do_not_depend_on_the_other_schemes_and_the_same_seed_gives_the_same():
    alone = judge_held_out(made(), [USUAL[1]], 1, **SMALL)
    one, other = (asdict(found) for found in (alone.rows[USUAL[1]], judged().splits[0][USUAL[1]]))
    assert np.array_equal(list(one.values()), list(other.values()), equal_nan=True)


def test_another_seed_has_other_halves():
    other = judge_held_out(made(), [], 1, seed=1, **SMALL)
    assert list(other.rows) == [RECORDED, COPIER, SHAKER]
    assert other.rows[RECORDED].p != judged().splits[0][RECORDED].p


def test_a_scheme_that_explodes_has_a_note_in_place_of_its_draws():
    """On 31 points, twelve of them lags, the rule that fits lifts best is one that grows."""
    name = "SIEM/SpatialPCA/VAR-pooled"
    found = judge_held_out(made(), [name, "PWI"], 1, **SMALL)
    (note,) = found.notes
    assert note.startswith(f"{name}: missing: VAR(12): its companion modulus is ") and "explode" in note
    assert np.isnan(found.rows[name].energy) and found.rows[name].error > 0
    assert not np.isnan(found.rows["PWI"].energy)


def test_notes_tell_in_how_many_splits(monkeypatch):
    from emulator.judge import held_out_table

    def refuses(name, halves):
        if halves.split == 1:
            raise ValueError("two bones are opposite")
        return real(name, halves)

    real = held_out_table.drawer
    monkeypatch.setattr(held_out_table, "drawer", refuses)
    found = judge_held_out(made(), ["PWI"], 2, **SMALL)
    assert found.notes[0] == "PWI: in 1 of 2 splits: two bones are opposite"
    assert not np.isnan(found.rows["PWI"].energy)


def test_progress_counts_to_its_total():
    heard = []
    judge_held_out(made(), [], 2, progress=lambda *said: heard.append(said), **SMALL)
    assert heard == [(n, 6, "lift") for n in range(1, 7)]


def test_all_that_is_wrong_is_said_before_anything_is_done():
    motions = make("reach", 12, 1)[0]
    broken = replace(motions.motions[3], root_m=motions.motions[3].root_m * np.nan)
    motions = replace(motions, motions=(*motions.motions[:3], broken, *motions.motions[4:]))
    with pytest.raises(ValueError) as refused:
        judge_held_out(motions, ["PWJ", "SIEM/JointPCA/MGV"])
    lines = str(refused.value).splitlines()
    assert len(lines) == 4 and "root_m is no number" in lines[-1] and "hold out 0" in lines[-2]
