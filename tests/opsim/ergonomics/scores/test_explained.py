"""Which part of the body a score is from, and every sub-score beside it."""

import numpy as np
import pytest
from hypothesis import given, settings

from opsim.ergonomics.scores.explain import explain
from opsim.ergonomics.scores.scoring import NOTHING_OPEN, Bounds, bounds_of, score
from tests.opsim.ergonomics.made_measures import frames, said, upright

STOOP = upright(trunk_flexion=70.0, neck_flexion=-10.0, left_arm_flexion=70.0, right_arm_flexion=70.0)


def test_a_stoop_is_told_part_by_part():
    found = explain(STOOP, NOTHING_OPEN)
    # RULA: upper arm 3, elbow straight 2: A 3; neck 4, trunk 4: B 7; C (3, 7) 6
    assert found["rula"]["score"] == (6, 6) and found["rula"]["level"] == (3, 3)
    assert found["rula"]["text"] == "investigation and changes required soon"
    parts = found["rula"]["parts"]
    assert [parts[name] for name in ("upper_arm", "lower_arm", "wrist", "neck", "trunk", "legs")] == [
        *[(3, 3), (2, 2), (1, 1)],
        *[(4, 4), (4, 4), (1, 1)],
    ]
    assert found["owas"]["parts"] == {"back": (2,), "arms": (1,), "legs": (2,), "load": (1,)}


def test_what_drives_a_score_sums_to_what_is_above_the_least():
    # Shapley by hand, OWAS 2121: only the back differs from 1121: 2 - 1.
    found = explain(STOOP, NOTHING_OPEN)
    assert found["owas"]["drives"] == {"back": 1.0}
    assert sum(found["rula"]["drives"].values()) == pytest.approx(6 - 1)
    assert sum(found["reba"]["drives"].values()) == pytest.approx(5 - 1)
    assert next(iter(found["reba"]["drives"])) == "trunk"


def test_two_parts_share_what_only_both_bring():
    # RULA: neck 4 with trunk 1: B 5, C (1, 5) 4; trunk 4 with neck 1: B 5, 4; both: B 7, C (1, 7) 5; none: 1.
    # Each first: 3, each second: 1: (3 + 1) / 2. (Elbows at 80 degrees, so that arms bring nothing.)
    both = upright(neck_flexion=-10.0, trunk_flexion=70.0, left_elbow=80.0, right_elbow=80.0)
    assert explain(both, NOTHING_OPEN)["rula"]["drives"] == pytest.approx({"neck": 2.0, "trunk": 2.0})


def test_time_and_load_drive_too():
    found = explain(upright(), Bounds(reba_load=(3, 3)), repeated=True, static=True)
    # REBA: A 1 + 3 = 4: C (4, 1) 3, + 2. RULA: C (2 + 1, 1 + 1) 3 against C (1, 1) 1: arms and time
    assert found["reba"]["score"] == (5, 5) and found["reba"]["drives"] == {"load": 2.0, "time": 2.0}
    assert found["reba"]["parts"]["time"] == (2, 2) and found["rula"]["parts"]["time"] == (1, 1)
    assert set(found["rula"]["drives"]) == {"arms", "time"}
    unloaded = explain(upright(), Bounds(reba_load=(3, 3)), carrying=False)
    assert unloaded["reba"]["score"] == (1, 1) and unloaded["reba"]["drives"] == {}


def test_the_worse_arm_is_the_one_that_is_told():
    found = explain(upright(right_arm_flexion=100.0), NOTHING_OPEN)
    assert found["rula"]["side"] == "right" and found["rula"]["parts"]["upper_arm"] == (4, 4)


def test_what_is_open_is_told_as_such():
    found = explain(upright(left_knee=40.0), bounds_of())
    assert found["owas"]["parts"] == {"back": (1,), "arms": (1,), "legs": (1, 2, 3, 4, 5), "load": (1, 2, 3)}
    assert found["reba"]["parts"]["legs"] == (1, 3)


def test_what_is_no_posture_is_refused():
    with pytest.raises(ValueError, match=r"measures must be \(N, 30\), found \(1, 3\)"):
        explain(np.zeros(3), NOTHING_OPEN)


@settings(max_examples=25)
@given(frames(), said())
def test_scores_are_those_of_the_kernel_and_drives_sum_to_their_middle(row, bounds):
    found, scored = explain(row, bounds), score(row[None], bounds)
    least = explain(upright(left_elbow=80.0, right_elbow=80.0), NOTHING_OPEN)
    for name in ("rula", "reba", "owas"):
        assert found[name]["score"] == tuple(getattr(scored, name)[0].tolist())
        if name != "owas" or not bounds.walking:
            middle = np.mean(found[name]["score"]) - least[name]["score"][0]
            assert sum(found[name]["drives"].values()) == pytest.approx(middle)
