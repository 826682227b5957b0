"""What shifts cost in energy.

Metabolic energy by Garg, Chaffin & Herrin.

Rest allowances of Rohmert, Murrell and Price.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain import energy as garg
from opsim.ergonomics.strain.energy import (
    Spent,
    bending_kcal,
    energy,
    holding_time_min,
    lifting_kcal,
    moved_kcal,
    murrell_rest_share,
    of_whole,
    price_relaxation,
    rohmert_rest_share,
)
from opsim.subjects.exposure.plan import Handling
from opsim.subjects.people.plan import Body
from opsim.subjects.tools.plan import Moment
from tests.opsim.ergonomics.made_frames import hands, made_frames
from tests.opsim.ergonomics.made_work import BEND, COUNT
from tests.opsim.ergonomics.strain.test_lifting import loaded_plan, made_lifts

MAN = Body(mass_kg=70.0, sex="m")


def plan_of(body=MAN, **handling):
    plan = loaded_plan()
    tasks = list(plan.tasks)
    tasks[COUNT] = replace(tasks[COUNT], handling=Handling(**handling))
    return replace(plan, tasks=tuple(tasks), workers=tuple(replace(one, body=body) for one in plan.workers))


def energy_of(frames, plan, there_s=3600.0, break_s=0.0, walk_s=0.0):
    spent = Spent(plan)
    for one in frames:
        spent.add(one)
    return energy(spent, *(np.full(2, seconds) for seconds in (there_s, break_s, walk_s)), plan)


def test_who_only_stands_costs_what_standing_costs():
    """70 kg x 0.024 kcal/min/kg; 10 of the 60 min are a break, seated: 0.023."""
    found = energy_of([], plan_of(), break_s=600.0)
    assert found.work_kcal_per_min[0] == pytest.approx([1.68, 1.68])
    assert found.kcal_per_min[0] == pytest.approx([(50 * 1.68 + 10 * 1.61) / 60] * 2)


def test_bending_sitting_holding_and_walking_by_hand():
    """Of an hour: 6 min bent (0.028 x 70), 12 min seated (0.023), 3 min of 10 kg in the hands (0.62), 5 min walking at
    1 m/s (2.288 net), the rest standing. Arms without load at work for 12 min: at most 1.2 kcal/min more.
    """
    plan = replace(plan_of(sitting=True))
    plan = replace(plan, workers=tuple(replace(one, walk_m_per_s=1.0) for one in plan.workers))
    bent = made_frames(1, seconds=180.0, task=BEND, trunk_flexion=20.0, **hands(1.0))
    held = made_frames(1, seconds=180.0, task=BEND, carrying=True, trunk_flexion=90.0, **hands(1.0))
    seated = made_frames(1, seconds=720.0, task=COUNT, trunk_flexion=40.0)
    found = energy_of([bent, held, seated], plan, walk_s=300.0)
    least = 6 * 1.96 + 12 * 1.61 + 42 * 1.68 + 3 * 0.62 + 5 * 2.288
    assert found.work_kcal[0] == pytest.approx([least, least + 1.2 * (3 + 12)])
    assert found.work_kcal[1] == pytest.approx([60 * 1.68 + 5 * 2.288] * 2)


def test_walking_within_a_task_is_told_by_feet_and_costs_more_with_a_load():
    """70 kg at 1 m/s for 6 s: 2.288 kcal/min net without, 0.01 x (68 + 177.8 + 4.08 x 10 + 114) = 4.006 with 10 kg; no
    holding and no work of the arms besides.
    """
    plan = plan_of()
    plan = replace(plan, workers=tuple(replace(one, walk_m_per_s=1.0) for one in plan.workers))
    swing = 0.08 * np.sin(2 * np.pi * np.arange(60) / 11)
    feet = {"left_ankle_up_m": swing, "right_ankle_up_m": -swing}
    for carrying, net in ((False, 2.288), (True, 4.006)):
        found = energy_of([made_frames(60, seconds=0.1, task=BEND, carrying=carrying, **feet, **hands(1.0))], plan)
        assert found.work_kcal[0] == pytest.approx([60 * 1.68 + 0.1 * net] * 2)


def test_lifts_are_added_and_deep_knees_make_a_squat():
    """15 lifts of 10 kg from 0.3 to 0.8 m by a man of 70 kg."""
    plan = plan_of()
    stoop, squat = made_lifts(), made_lifts()
    squat.knee_deg[:, 0] = 60.0
    for lifts, bent in ((stoop, False), (squat, True)):
        assert lifting_kcal(lifts, plan)[0] == pytest.approx([15 * moved_kcal(70.0, 10.0, 0.3, 0.8, 1.0, bent)] * 2)
    assert lifting_kcal(squat, plan)[0, 0] > lifting_kcal(stoop, plan)[0, 0]


def test_whose_sex_is_not_said_is_between_both_and_an_unknown_mass_is_75_kg():
    lifts = made_lifts()
    man, woman = (lifting_kcal(lifts, plan_of(Body(mass_kg=75.0, sex=sex)))[0, 0] for sex in "mf")
    assert lifting_kcal(lifts, plan_of(Body()))[0] == pytest.approx(sorted([man, woman]))


def test_who_was_never_there_has_no_figure():
    found = energy_of([], plan_of(), there_s=0.0)
    assert np.isnan(found.kcal_per_min).all() and np.isnan(found.work_kcal_per_min).all()


def test_a_load_without_a_body_is_held_for_its_share_and_one_at_marks_from_never_to_always():
    """10 kg for the second half of 60 s without a posture: 0.62 kcal/min for half a minute; at marks none to a minute,
    and arms that are free for a minute at most.
    """
    half = Handling(load_kg=10.0, start=Moment(share=0.5))
    marked = Handling(load_kg=10.0, start=Moment(mark=0), end=Moment(mark=1))
    for handling, carrying, most in ((half, [False, True], 0.31 + 1.2 * 0.5), (marked, [True, True], 0.62 + 1.2)):
        plan = plan_of()
        tasks = list(plan.tasks)
        tasks[COUNT] = replace(tasks[COUNT], handling=handling)
        frames = made_frames(2, seconds=30.0, task=COUNT, carrying=carrying)
        frames.measures[:] = np.nan
        found = energy_of([frames], replace(plan, tasks=tuple(tasks)))
        least = 0.31 if handling is half else 0.0
        assert found.work_kcal[0] == pytest.approx([60 * 1.68 + least, 60 * 1.68 + most])


def test_a_bend_without_a_load_costs_the_body_s_way_down_and_up_at_most():
    """A man of 70 kg, hands from 1.0 to 0.31 m and back: down 0.01 x (0.268 x 70 + 5.22) x 0.5, up 0.01 x 0.325 x 70 x
    0.5; bent for 1 of 3 s; arms free for all.
    """
    up_m = np.array([1.0, 0.31, 1.0])
    bent = np.array([0.0, 60.0, 0.0])
    found = energy_of([made_frames(3, task=COUNT, trunk_flexion=bent, **hands(up_m))], plan_of())
    least = 60 * 1.68 + (1.96 - 1.68) / 60
    way = 0.01 * 0.5 * (0.268 * 70 + 5.22 + 0.325 * 70)
    assert found.work_kcal[0] == pytest.approx([least, least + way + 1.2 * 3 / 60])
    upright = energy_of([made_frames(3, task=COUNT, **hands(np.array([1.0, 0.75, 1.0])))], plan_of())
    assert upright.work_kcal[0, 1] == pytest.approx(60 * 1.68 + 1.2 * 3 / 60)


def test_going_down_for_a_load_counts_once_and_coming_up_with_it_is_the_lift():
    """Down with empty hands to 0.31 m, up with 10 kg to 0.81 m."""
    up_m, bent = np.array([1.0, 0.31, 0.31, 0.82]), np.array([0.0, 60.0, 60.0, 0.0])
    frames = made_frames(4, task=BEND, carrying=[False, False, True, True], trunk_flexion=bent, **hands(up_m))
    spent = Spent(plan_of())
    spent.add(frames)
    bends = spent.bends()
    assert bends.low_m.tolist() == [0.31] and bends.down.tolist() == [True] and bends.up.tolist() == [False]
    assert bending_kcal(bends, 0, 70.0, 1.0) == pytest.approx(0.01 * 0.5 * (0.268 * 70 + 5.22))


def test_walks_with_something_in_the_hands_cost_more():
    """70 kg at 1 m/s with 10 kg for 2 of 5 min: 4.006 against 2.288 kcal/min."""
    plan = replace(plan_of(), workers=tuple(replace(one, walk_m_per_s=1.0) for one in plan_of().workers))
    spent, times = Spent(plan), [np.full(2, seconds) for seconds in (3600.0, 0.0, 300.0)]
    found = energy(spent, *times, plan, [(0, 10.0, 120.0)]).work_kcal
    assert found[0, 0] - found[1, 0] == pytest.approx(2 * (4.006 - 2.288))


@pytest.mark.parametrize(
    ("found", "by_hand"),
    [
        # man of 70 kg, 10 kg from 0.31 m to 0.81 m
        (garg.stoop_lift_kcal(70, 10, 0.31, 0.81, 1), 0.01 * (11.375 + 10.85)),  # .325x70x.5; (1.41+.76)x10x.5
        (garg.squat_lift_kcal(70, 10, 0.31, 0.81, 1), 0.01 * (17.99 + 14.05)),  # .514x70x.5; (2.19+.62)x10x.5
        (garg.stoop_lower_kcal(70, 10, 0.31, 0.81, 1), 0.01 * (9.38 + 3.375 + 2.61)),  # .268x70x.5; .675x5; 5.22x.5
        (garg.squat_lower_kcal(70, 10, 0.31, 0.81, 1), 0.01 * (17.885 + 3.505)),  # .511x70x.5; .701x5
        # woman of 60 kg, 5 kg from 0.81 m to 1.31 m
        (garg.arm_lift_kcal(60, 5, 0.81, 1.31, 0), 0.01 * (1.86 + 7.975)),  # .062x60x.5; 3.19x5x.5
        (garg.arm_lower_kcal(60, 5, 0.81, 1.31, 0), 0.01 * (2.79 + 2.55)),  # .093x60x.5; 1.02x5x.5
        (garg.posture_kcal_per_min("standing", 70), 1.68),
        (garg.posture_kcal_per_min("bent", 70), 1.96),
        (garg.posture_kcal_per_min("sitting", 70), 1.61),
        (garg.walking_kcal_per_min(70, 1.0), 0.01 * (51 + 177.8)),
        (garg.walking_kcal_per_min(70, 1.0, 10), 0.01 * (68 + 177.8 + 40.8 + 114)),
        (garg.holding_kcal_per_min(10), 0.62),
    ],
)
def test_equations_by_hand(found, by_hand):
    assert found == pytest.approx(by_hand)


def test_a_lift_past_the_bench_is_cut_there():
    """60 kg woman, 5 kg from 0.31 to 1.31 m: with the back to 0.81, with the arms from there."""
    back, arms = garg.stoop_lift_kcal(60, 5, 0.31, 0.81, 0), garg.arm_lift_kcal(60, 5, 0.81, 1.31, 0)
    assert garg.moved_kcal(60, 5, 0.31, 1.31, 0) == pytest.approx(back + arms)
    down = garg.squat_lower_kcal(60, 5, 0.31, 0.81, 0) + garg.arm_lower_kcal(60, 5, 0.81, 1.31, 0)
    assert garg.moved_kcal(60, 5, 1.31, 0.31, 0, squat=True) == pytest.approx(down)


def test_what_stays_at_its_height_costs_nothing_to_move():
    assert garg.moved_kcal(70, 10, 0.5, 0.5, 1) == 0.0


heights, sexes = st.floats(0.05, 1.9), st.sampled_from([0.0, 0.5, 1.0])


@given(heights, heights, st.floats(0, 30), st.floats(0, 10), st.floats(40, 120), sexes, st.booleans())
def test_heavier_loads_and_bodies_never_cost_less(one, other, load, more, body, sex, squat):
    kcal = garg.moved_kcal(body, load, one, other, sex, squat)
    assert kcal >= 0
    assert garg.moved_kcal(body, load + more, one, other, sex, squat) >= kcal
    assert garg.moved_kcal(body + more, load, one, other, sex, squat) >= kcal


@given(st.floats(0.1, 0.8), st.floats(0, 0.6), st.floats(0, 30), sexes, st.booleans())
def test_going_deeper_never_costs_less(high, deeper, load, sex, squat):
    low = max(high - deeper, 0.05)
    for begin, end in ((low, 0.81), (0.81, low)):
        higher = (high, 0.81) if begin == low else (0.81, high)
        assert (
            garg.moved_kcal(70, load, begin, end, sex, squat) >= garg.moved_kcal(70, load, *higher, sex, squat) - 1e-12
        )


def test_many_at_once_are_each_alone():
    rng = np.random.default_rng(0)
    begin, end, load, squat = (
        rng.uniform(0, 1.8, 40),
        rng.uniform(0, 1.8, 40),
        rng.uniform(0, 20, 40),
        rng.random(40) < 0.5,
    )
    found = garg.moved_kcal(70.0, load, begin, end, 0.5, squat)
    alone = [float(garg.moved_kcal(70.0, *one[:1], *one[1:3], 0.5, one[3])) for one in zip(load, begin, end, squat)]
    assert found == pytest.approx(alone)


def test_rohmerts_holding_times_by_hand():
    """f = 0.5: -1.5 + 4.2 - 2.4 + 0.8 = 1.1 min; f = 1: -1.5 + 2.1 - 0.6 + 0.1 = 0.1 min;
    f = 0.2: -1.5 + 10.5 - 15 + 12.5 = 6.5 min; up to 0.15 for ever.
    """
    assert holding_time_min([0.5, 1.0, 0.2]) == pytest.approx([1.1, 0.1, 6.5])
    assert np.isinf(holding_time_min([0.15, 0.0])).all()


def test_rohmerts_rest_by_hand():
    """Half a strength for 0.55 of its 1.1 min: 18 x 0.5^1.4 x 0.35^0.5 = 18 x 0.378929 x 0.591608 = 4.0352."""
    assert rohmert_rest_share(0.55, 0.5) == pytest.approx(4.0352, abs=1e-4)
    assert rohmert_rest_share(60.0, 0.15) == 0.0
    assert rohmert_rest_share(99.0, 0.5) == pytest.approx(rohmert_rest_share(1.1, 0.5))


def test_murrells_rest_by_hand():
    """6 kcal/min against a standard of 4: 60 min x (6 - 4) / (6 - 1.5) = 26.7 min of an hour."""
    assert 60 * murrell_rest_share(6.0, 4.0) == pytest.approx(26.667, abs=1e-3)
    assert murrell_rest_share(6.0) == pytest.approx(1 / 4.5)
    assert murrell_rest_share(5.0) == 0.0 and murrell_rest_share(1.0) == 0.0


def test_prices_rest_by_hand():
    """7 kcal/min = 488.5 W: (488.46 - 300) / 195 = 0.96646 of the time worked, 49 % of all."""
    assert price_relaxation(7.0) == pytest.approx((7 * 69.78 - 300) / 195)
    assert of_whole(price_relaxation(7.0)) == pytest.approx(0.4915, abs=1e-4)
    assert price_relaxation(4.2) == 0.0


@given(st.floats(0, 1), st.floats(0, 1), st.floats(0, 30), st.floats(0, 30))
def test_more_force_and_longer_holds_never_ask_for_less_rest(one, other, brief, long):
    (weak, strong), (brief, long) = sorted((one, other)), sorted((brief, long))
    assert holding_time_min(strong) <= holding_time_min(weak)
    assert rohmert_rest_share(brief, weak) <= rohmert_rest_share(long, strong) + 1e-12


@given(st.floats(0, 20), st.floats(0, 20))
def test_more_energy_never_asks_for_less_rest(one, other):
    low, high = sorted((one, other))
    assert 0 <= murrell_rest_share(low) <= murrell_rest_share(high) < 1
    assert 0 <= of_whole(price_relaxation(low)) <= of_whole(price_relaxation(high)) < 1
