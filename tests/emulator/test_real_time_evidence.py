"""``motion_evidence.real_time``: that its bounds see what does not hold, and that its tables show what was measured."""

import pytest
from motion_evidence import real_time
from motion_evidence.real_time_bounds import failures, share_needed
from motion_evidence.real_time_rows import held_out, in_sample, people_of

from tests.recordings import recording

GOOD = {
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
    return failures({"squat": GOOD | changed}, refused or {}, {"squat": before or {}})


def test_what_holds_is_not_complained_of():
    assert failing(before=GOOD) == [] and failures({"squat": {}}, {}, {}) == []


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
    found = failing(before=GOOD, **changed)
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


def test_a_small_class_is_measured():
    recording("hdm05_throw_ball")
    row = in_sample("hdm05_throw_ball", 9) | held_out("hdm05_throw_ball", 0, 2)
    assert {"too_fast_new", "jerk_ratio_known", "decoded_mm", "decoded_auc", "slide_cm_recorded", "auc_drawn"} <= set(
        row
    )
    assert row["places_drawn"] > 0 and len(people_of("hdm05_throw_ball")) == 3
