from dataclasses import replace

import numpy as np
import pytest
from plans import ran

from opsim.ergonomics.angles import AT, CANONICAL, COLUMNS
from opsim.ergonomics.measures import measures_of_joints
from opsim.ergonomics.options import USUAL
from opsim.ergonomics.scores.explain import explain
from opsim.ergonomics.scores.scoring import NOTHING_OPEN, Scores, bounds_of
from opsim.ergonomics.shift.day import fold, said_of
from opsim.ergonomics.shift.ledger import REGIONS, Regions, points
from opsim.ergonomics.shift.movement import (
    Movement,
    ScoredMovement,
    Told,
    alike,
    higher_arm_deg,
    movement_figures,
    scored_movements,
    unknown_share,
    worst_postures,
)
from opsim.subjects.exposure.figures import exposure
from opsim.subjects.exposure.plan import Handling
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


CELL = """
opsim: 1
name: cell
run: {start: Mon 06:30, horizon: 10 min, warm_up: 1 min, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
tasks:
  stoop: {emulator: bench/stoop, load: 12 kg, handling: {forearm: end, legs: unbalanced}}
  place: {emulator: bench/place}
  label: {fixed: 4 s}
stations: {low: {at: here, tasks: [stoop, place, label], servers: 2, buffer: 2}}
products: {p: {route: [low]}}
release: {kind: saturated}
workers: {ana: {skills: {low: 1.0}}, ben: {skills: {low: 0.8}}}
"""


class Kept:
    def __init__(self):
        self.seen = []

    def add(self, frames, scores):
        self.seen.append((frames, scores))


@pytest.fixture(scope="module")
def cell():
    log, plan = ran(CELL)
    kept, regions = Kept(), Regions(plan)
    fold(log, plan, [kept, regions])
    return log, plan, kept.seen, regions


def test_points_are_those_of_the_explanation_of_each_posture(cell):
    _, plan, seen, _ = cell
    frames, _ = seen[0]
    for task in np.unique(frames.task[frames.known]).tolist():
        rows = np.flatnonzero((frames.task == task) & frames.known)[:: max(1, (frames.task == task).sum() // 4)]
        some, said = frames.some(rows), said_of(task, plan)
        found = points(some, said, plan.ergonomics)
        for n in range(len(some)):
            flags = {name: bool(getattr(some, name)[n]) for name in ("repeated", "static", "carrying")}
            drives = explain(some.measures[n], said, plan.ergonomics, **flags)["rula"]["drives"]
            assert found[n] == pytest.approx([drives.get(region, 0.0) for region in REGIONS], abs=1e-9)


def test_all_regions_together_are_the_time_at_that_score(cell):
    _, plan, seen, regions = cell
    for column, level in enumerate((5, 7)):
        for rank in range(len(plan.workers)):
            own = [frames.seconds[scores.rula[:, 0] >= level].sum() for frames, scores in seen if frames.worker == rank]
            assert regions.seconds[rank, :, column].sum() == pytest.approx(sum(own), rel=1e-9)
    assert regions.seconds.sum() > 0 and (regions.seconds >= 0).all()


def test_figures_of_regions_sum_to_the_minutes_at_that_score(cell):
    log, plan, *_ = cell
    asked = ("exposure_by_region", "rula_from_5_min_per_h")
    found = {(f.kpi, f.subject, f.part): f.value for f in exposure(log, plan, asked)}
    dealt = sum(found["exposure_by_region", region, "rula_from_5"] for region in REGIONS)
    assert dealt == pytest.approx(found["rula_from_5_min_per_h", "", ""], rel=1e-9)


def test_a_load_brings_in_points_only_while_it_is_in_the_hands(cell):
    _, plan, seen, _ = cell
    frames, _ = seen[0]
    rows = np.flatnonzero((frames.task == 1) & frames.known)[:3]
    some = frames.some(rows)
    said = said_of(1, plan)
    empty = points(type(some)(some.worker, **{**columns(some), "carrying": np.zeros(3, bool)}), said, plan.ergonomics)
    full = points(some, said, plan.ergonomics)
    assert (empty[:, REGIONS.index("load")] == 0).all() and (full[:, REGIONS.index("load")] > 0).all()


def columns(frames):
    return {name: getattr(frames, name) for name in frames.__dataclass_fields__ if name != "worker"}
