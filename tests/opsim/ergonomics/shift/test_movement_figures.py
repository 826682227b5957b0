import numpy as np
import pytest

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.scores.scoring import Scores
from opsim.ergonomics.shift.movement import (
    Movement,
    ScoredMovement,
    Told,
    higher_arm_deg,
    movement_figures,
    unknown_share,
)


def scored(rula, reba, owas, seconds, trunk=(), arms=()):
    """A movement of these scores, pairs (low, high); trunks and (left, right) arms in degrees."""
    n = len(rula)
    measures = np.full((n, len(COLUMNS)), np.nan)
    measures[:, AT["trunk_flexion"]] = trunk if len(trunk) else 0.0
    if len(arms):
        measures[:, [AT["left_arm_elevation"], AT["right_arm_elevation"]]] = arms
    pairs = (np.array(one, np.int8) for one in (rula, reba, owas))
    movement = Movement("made", np.array(seconds, float), measures, lambda _: np.zeros((1, 3)))
    return ScoredMovement(movement, Scores(*pairs, np.zeros(n, np.int8)), np.zeros(n, bool))


def figures(*movements):
    return {row.name: (row.low, row.high) for row in movement_figures(movements)}


def test_shares_and_means_go_by_seconds_at_least_and_at_most():
    """1 s at RULA 2, 2 s at 5 to 7, 1 s at 7: 3 of 4 s from 5, 1 to 3 of 4 s at 7; mean (2 + 2 x 5 + 7) / 4 = 4.75."""
    one = scored([(2, 2), (5, 7)], [(1, 1), (7, 9)], [(1, 1), (2, 3)], [1, 2])
    other = scored([(7, 7)], [(11, 11)], [(4, 4)], [1])
    found = figures(one, other)
    assert found["rula_from_5_share"] == (0.75, 0.75) and found["rula_from_7_share"] == (0.25, 0.75)
    assert found["reba_from_8_share"] == (0.25, 0.75) and found["owas_from_3_share"] == (0.25, 0.75)
    assert found["rula_mean"] == (4.75, 5.75) and found["reba_most"] == (11, 11)
    assert found["rula_p90"] == (7, 7)


def test_the_90_percent_quantile_is_the_score_that_nine_tenths_do_not_pass():
    """9 s at RULA 3 and 1 s at 7: nine tenths of the time are at 3 or below; with 1.1 s at 7 they are not."""
    for longer_s, expected in ((1.0, 3), (1.1, 7)):
        found = figures(scored([(7, 7), (3, 3)], [(1, 1)] * 2, [(1, 1)] * 2, [longer_s, 9.0]))
        assert found["rula_p90"] == (expected, expected)


def test_angles_count_from_the_very_degree_and_of_the_higher_arm():
    arms = [(10, 60), (90, 0), (59.9, 20), (np.nan, 95)]
    found = figures(scored([(1, 1)] * 4, [(1, 1)] * 4, [(1, 1)] * 4, [1] * 4, trunk=[20, 60, 19.9, -70], arms=arms))
    assert found["trunk_beyond_20_share"] == (0.5, 0.5) and found["trunk_beyond_60_share"] == (0.25, 0.25)
    assert found["arm_beyond_60_share"] == (0.75, 0.75) and found["arm_beyond_90_share"] == (0.5, 0.5)


def test_of_the_arm_that_is_known_where_only_one_is():
    measures = np.full((2, len(COLUMNS)), np.nan)
    measures[0, AT["right_arm_elevation"]] = 30.0
    assert np.array_equal(higher_arm_deg(measures), [30.0, np.nan], equal_nan=True)


def test_time_whose_posture_nobody_knows_is_in_no_share():
    one = scored([(7, 7), (1, 7)], [(1, 1)] * 2, [(1, 1)] * 2, [1, 3], trunk=[70, np.nan])
    assert figures(one)["rula_from_7_share"] == (1.0, 1.0) and figures(one)["rula_mean"] == (7, 7)
    assert unknown_share([one]) == pytest.approx(0.75)


def test_figures_are_told_as_people_read_them():
    assert Told("a", "RULA", "1", 4.754, 4.754).row == ("RULA", "4.75", "")
    assert Told("a", "RULA 7", "share", 0.0, 0.5).row == ("RULA 7", "0.0 %", "50.0 %")
    assert Told("a", "RULA", "1", 7.0, np.nan).row == ("RULA", "7", "not known")


def test_where_nothing_is_known_no_figure_is():
    found = figures(scored([(1, 7)], [(1, 15)], [(1, 4)], [1], trunk=[np.nan]))
    assert all(np.isnan(low) and np.isnan(high) for low, high in found.values())
