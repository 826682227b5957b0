"""Holds, movements and repetition as figures."""

import numpy as np
import pytest

from opsim.kpi.catalogue import HELD
from opsim.kpi.strain import hold_sentences as sentences
from opsim.log import OFF
from tests.opsim.ergonomics.made_work import BEND, Bending, Bends, made_plan
from tests.opsim.kpi.made_logs import row, work
from tests.opsim.kpi.test_energy import Stooping, values


def of(rows, plan):
    return values(rows, plan, HELD)


def in_turn(n, lasting=9.0, worker=0, task=BEND, every=9.0):
    return [work(every * k, every * k + lasting, 0, worker=worker, task=task, k=k) for k in range(n)]


def test_a_stoop_held_over_many_performances_is_one_hold():
    """20 performances of 9 s at 60 degrees, without a pause: 180 s = 3 min of the hour, and 1 min is allowed."""
    found = of(in_turn(20), made_plan(Bending(kind=Stooping)))
    assert found["longest_hold_s", "ana", "trunk"] == pytest.approx(180.0)
    assert found["static_hold_min_per_h", "ana", "trunk"] == pytest.approx(3.0)
    assert found["iso_11226_min_per_h", "ana", "trunk"] == pytest.approx(3.0)
    assert found["static_hold_min_per_h", "ben", "trunk"] == 0.0
    assert found["static_hold_min_per_h", "", "trunk"] == pytest.approx(1.5)


class Deep(Bends):
    """Bent by 25 degrees, and by 70 from a third to a half of the time."""

    course = staticmethod(lambda share: np.where((share > 1 / 3) & (share < 1 / 2), 70.0, 25.0))


def test_holds_at_two_angles_are_judged_each_at_its_own():
    """60 s of 25 degrees may be held for 217 s; 70 degrees not at all: of 48 s, 8 are beyond ISO 11226."""
    plan = made_plan(Bending(kind=Deep))
    found = of([work(0, 48, 0, worker=0, task=BEND, k=0)], plan)
    assert found["longest_hold_s", "ana", "trunk"] == pytest.approx(24.0, abs=1.0)
    assert found["static_hold_min_per_h", "ana", "trunk"] == pytest.approx(48 / 60)
    assert found["iso_11226_min_per_h", "ana", "trunk"] == pytest.approx(8 / 60, abs=1 / 60)


def test_short_holds_with_pauses_are_within_iso_11226():
    """60 degrees may be held for a minute, and each is held for 9 s."""
    found = of(in_turn(20, every=30.0), made_plan(Bending(kind=Stooping)))
    assert found["longest_hold_s", "ana", "trunk"] == pytest.approx(9.0)
    assert found["static_hold_min_per_h", "ana", "trunk"] == pytest.approx(3.0)
    assert found["iso_11226_min_per_h", "ana", "trunk"] == 0.0


def test_going_up_and_down_holds_nothing_and_moves_once_a_performance():
    """0 to 90 to 0 degrees in 9 s, beyond 20 for 7 of them: 6.67 bends a minute are too often for EN 1005-4."""
    found = of(in_turn(20), made_plan())
    assert found["longest_hold_s", "ana", "trunk"] == 0.0
    assert found["movements_per_min", "ana", "trunk"] == pytest.approx(60 / 9, rel=1e-3)
    assert found["en_1005_4_min_per_h", "ana", "trunk"] == pytest.approx(3.0 * 7 / 9, rel=0.05)


def test_a_bend_a_minute_is_never_too_often():
    """Once a minute is seldom: bending is then conditional at most, for however deep."""
    found = of(in_turn(20, every=60.0), made_plan())
    assert found["en_1005_4_min_per_h", "ana", "trunk"] == 0.0


def test_repetitions_by_hand():
    """12 bends of 9 s, one every 12 s, and 3 counts: 15 beginnings in 12 x 9 + 3 x 5 = 123 s of work."""
    rows = in_turn(12, every=12.0) + [work(1000 + 10 * k, 1005 + 10 * k, 0, worker=0, task=2, k=k) for k in range(3)]
    found = of(rows, made_plan())
    assert found["repetitions_per_min", "ana", ""] == pytest.approx(15 / (123 / 60))
    assert found["repetitions_per_min", "ana", "most"] == pytest.approx(12 / (123 / 60))
    assert np.isnan(found["repetitions_per_min", "ben", ""])


def test_who_is_away_has_no_hour():
    found = of([row(OFF, 0, 3600, worker=1), *in_turn(3)], made_plan())
    assert np.isnan(found["static_hold_min_per_h", "ben", "trunk"])
    assert found["static_hold_min_per_h", "", "trunk"] == found["static_hold_min_per_h", "ana", "trunk"]


def test_sentences_say_who_and_what_part():
    found = {
        ("iso_11226_min_per_h", "ana", "left_arm"): 3.04,
        ("iso_11226_min_per_h", "", "left_arm"): 1.5,
        ("en_1005_4_min_per_h", "ben", "trunk"): 0.01,
        ("en_1005_4_min_per_h", "ben", "neck"): 7.0,
    }
    assert list(sentences(found)) == [
        "ana: 3.0 min/h beyond ISO 11226 (left arm).",
        "ben: 7.0 min/h beyond EN 1005-4 (neck).",
    ]
