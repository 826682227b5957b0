from dataclasses import replace

import numpy as np
import pytest

from opsim.ergonomics.angles import CANONICAL, COLUMNS
from opsim.ergonomics.measures import measures_of_joints
from opsim.ergonomics.options import USUAL
from opsim.ergonomics.scores.scoring import NOTHING_OPEN, bounds_of
from opsim.ergonomics.shift.movement import Movement, alike, scored_movements, worst_postures
from opsim.plan.tasks import Handling
from tests.opsim.ergonomics.bodies import bent, standing


def movement(*flexions_deg, seconds=0.5, name="made"):
    """A body bent forward by each of some angles, one after the other; nan is a posture that nobody knows."""
    bodies = np.array([standing() * np.nan if np.isnan(angle) else bent(angle) for angle in flexions_deg])
    measures = measures_of_joints(bodies, CANONICAL)
    return Movement(name, np.full(len(bodies), seconds), measures, bodies.__getitem__)


def test_who_bends_scores_more_than_who_stands():
    (one,) = scored_movements([movement(0.0, 70.0)], NOTHING_OPEN)
    assert one.scores.rula[0].tolist() == [2, 2] and one.scores.rula[1].min() > 2
    assert one.scores.owas[:, 0].tolist() == [1, 2]


def test_what_is_not_said_widens_scores_and_nothing_else():
    said, open_ = (scored_movements([movement(0, 30, 70)], bounds)[0].scores for bounds in (NOTHING_OPEN, bounds_of()))
    for name in ("rula", "reba", "owas"):
        low, high = getattr(open_, name).T
        assert (low <= getattr(said, name)[:, 0]).all() and (high >= getattr(said, name)[:, 1]).all()
    assert (open_.rula[:, 1] > open_.rula[:, 0]).all()


def test_a_posture_is_static_once_it_is_held_for_more_than_a_minute():
    short, long = scored_movements([movement(*[40.0] * 60, seconds=s) for s in (0.9, 1.1)], NOTHING_OPEN)
    assert not short.static.any() and long.static.all()
    assert (long.scores.rula >= short.scores.rula).all() and (long.scores.rula > short.scores.rula).any()


def test_what_is_repeated_never_scores_less():
    once, often = (scored_movements([movement(0, 45)], NOTHING_OPEN, repeated=r)[0].scores for r in (False, True))
    assert (often.rula >= once.rula).all() and (often.reba > once.reba).any()


def test_times_are_those_of_the_postures():
    made = movement(0.0, 20.0, 40.0, seconds=0.25)
    assert made.start_s.tolist() == [0.0, 0.25, 0.5] and made.duration_s == 0.75


def test_the_worst_postures_come_first_and_stand_apart():
    """Bent by 70, 69 and 75, half a second apart, and by 50: all within 20 degrees of 70; 40 and 0 are not."""
    one, other = movement(0, 70, 69, 75, 0, 0, 40), movement(0.0, 50.0, name="other")
    scored = scored_movements([one, other], bounds_of(Handling(load_kg=0.0)))
    found = list(worst_postures(scored, n=4))
    assert found[:2] == [(0, 1), (0, 6)] and (1, 1) not in found and (0, 2) not in found and (0, 3) not in found
    assert len(list(worst_postures(scored, n=1))) == 1


def test_a_posture_that_nobody_knows_is_never_among_the_worst():
    scored = scored_movements([movement(np.nan, 10.0, np.nan)], bounds_of())
    assert list(worst_postures(scored)) == [(0, 1)] and scored[0].movement.known.tolist() == [False, True, False]
    nothing = replace(movement(0.0), measures=np.full((1, len(COLUMNS)), np.nan))
    assert list(worst_postures(scored_movements([nothing], bounds_of(), USUAL))) == []


@pytest.mark.parametrize("seconds", [0.05, 0.1])
def test_the_time_between_the_worst_is_asked_for(seconds):
    """Four kinds, one after the other: all, or, if two steps must lie between, the worst and one more."""
    scored = scored_movements([movement(0.0, 30.0, 60.0, 90.0, seconds=seconds)], NOTHING_OPEN)
    assert len(list(worst_postures(scored, n=99, apart_s=seconds))) == 4
    assert len(list(worst_postures(scored, n=99, apart_s=1.5 * seconds))) == 2


def test_copies_of_one_posture_are_told_once_however_far_apart():
    scored = scored_movements([movement(*[60.0] * 9), movement(60.0, 45.0, 20.0)], NOTHING_OPEN)
    assert list(worst_postures(scored)) == [(0, 0), (1, 2)]
    assert [same.tolist() for same in alike(scored, 0, 0)] == [[True] * 9, [True, True, False]]


def test_hands_that_hold_nothing_are_no_posture_like_one_with_a_load():
    both = replace(movement(60.0, 60.0, seconds=2.0), carrying=np.array([False, True]))
    scored = scored_movements([both], bounds_of(Handling(load_kg=12.0)))
    assert list(worst_postures(scored)) == [(0, 1), (0, 0)]
    assert both.loaded_s == 2.0 and movement(0.0, 10.0).loaded_s == 1.0


def test_a_load_counts_only_while_it_is_in_the_hands():
    """12 kg, now and then: RULA's force of 10 kg or more is 2 at least; empty hands have 0, and score as without."""
    held = replace(movement(0.0, 0.0), carrying=np.array([False, True]))
    (one,) = scored_movements([held], bounds_of(Handling(load_kg=12.0)))
    (none,) = scored_movements([held], bounds_of(Handling(load_kg=0.0)))
    assert (one.scores.rula[0] == none.scores.rula[0]).all() and (one.scores.rula[1] > none.scores.rula[1]).all()
