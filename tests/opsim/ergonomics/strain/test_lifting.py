"""Lifting indices of a run.

The composite index over every order of its lifts.

How often and how long somebody lifts.

Lifts found in frames.
"""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.angles import AT
from opsim.ergonomics.strain.lifting import Lifted, Lifts, composite_of, indices, too_often
from opsim.ergonomics.strain.lifting_pattern import Kind, composite_range, duration_hours, least_multiplier, pattern
from opsim.ergonomics.strain.niosh import Lift, composite, composite_index, lifting_index
from opsim.subjects.exposure.plan import Handling
from opsim.subjects.shifts.plan import Duty
from tests.opsim.ergonomics.made_frames import hands, made_frames
from tests.opsim.ergonomics.made_work import BEND, COUNT, made_plan


def made_lifts(n=15, every_s=60.0, task=BEND, worker=0, taken=(0.3, 0.4, 0.0), let_go=(0.8, 0.4, 0.0), start_s=0.0):
    """n lifts at even times: height, level distance, asymmetry at both ends."""
    begins = start_s + np.arange(n) * every_s
    ends = (np.tile([one, other], (n, 1)) for one, other in zip(taken, let_go))
    ranks = (np.full(n, rank) for rank in (worker, task))
    return Lifts(*ranks, begins, begins + 3.0, *ends, np.zeros((n, 2)))


def on_shift(plan, *ends_s, horizon_s=None):
    """Everybody's shifts, one after the other from 0 on; the run ends with the last of them, or before."""
    spans = list(zip((0.0, *ends_s), ends_s))
    horizon_s = ends_s[-1] if horizon_s is None else horizon_s
    duties = tuple(
        Duty(low, min(high, horizon_s), 0, at, cut=high > horizon_s, whole_s=(low, high))
        for at, (low, high) in enumerate(spans)
    )
    workers = tuple(replace(one, duties=duties) for one in plan.workers)
    return replace(plan, workers=workers, horizon_s=horizon_s)


def both(one, other):
    return Lifts(*(np.concatenate([getattr(one, name), getattr(other, name)]) for name in Lifts.__slots__))


def test_an_index_is_that_of_the_equation_at_its_worker_s_frequency():
    """61 lifts, one a minute, 60 min and 3 s of lifting: 61 / 60.05 a minute, more than 1 h: the column of 2 h."""
    found = indices(made_lifts(61), on_shift(loaded_plan(), 3603.0))
    per_min = 61 / (3603 / 60)
    taken = lifting_index(Lift(10.0, 40.0, 30.0, 50.0, 0.0, per_min, 2, "good"))
    put = lifting_index(Lift(10.0, 40.0, 80.0, 50.0, 0.0, per_min, 2, "good"))
    assert found.index[0] == pytest.approx([taken, max(taken, put)])


def test_an_index_does_not_depend_on_how_much_of_a_shift_was_simulated():
    """A lift a minute, of 8 h 40, 100 and 200 min are seen: the column of 8 h each time."""
    found = [
        indices(made_lifts(n), on_shift(loaded_plan(), 28800.0, horizon_s=60.0 * n)).index[0] for n in (40, 100, 200)
    ]
    assert found[0] == pytest.approx(found[1], rel=0.01) and found[1] == pytest.approx(found[2], rel=0.01)
    taken = lifting_index(Lift(10.0, 40.0, 30.0, 50.0, 0.0, 200 / (199 + 0.05), 8, "good"))
    assert found[2][0] == pytest.approx(taken)


def test_who_has_no_shifts_lifts_at_most_all_day():
    found = indices(made_lifts(40), loaded_plan()).index[0]
    short, long = (
        indices(made_lifts(40), on_shift(loaded_plan(), at, horizon_s=2400.0)).index[0] for at in (2400.0, 28800.0)
    )
    assert found.tolist() == [short[0], long[1]] and found[0] < found[1]


def test_what_is_lifted_sitting_has_no_index_and_is_left_out_of_the_composite():
    plan = loaded_plan()
    sits = replace(plan.tasks[BEND], handling=replace(plan.tasks[BEND].handling, sitting=True))
    plan = replace(plan, tasks=(sits, *plan.tasks[1:]))
    seated = indices(made_lifts(), plan)
    assert np.isnan(seated.index).all() and seated.out_of_range.all()
    assert np.isnan(composite_of(made_lifts(), seated, plan)).all()
    tasks = list(plan.tasks)
    tasks[COUNT] = replace(tasks[COUNT], handling=loaded_plan().tasks[BEND].handling)
    plan = replace(plan, tasks=tuple(tasks))
    standing, lifts = made_lifts(task=COUNT), both(made_lifts(), made_lifts(task=COUNT))
    alone, among = (composite_of(one, indices(one, plan), plan) for one in (standing, lifts))
    assert among == alone and alone[0] > 0


def test_what_nobody_said_of_the_grip_is_between_good_and_poor():
    lifts = made_lifts()
    good, poor, unsaid = (indices(lifts, loaded_plan(grip=grip)).index[0] for grip in ("good", "poor", None))
    assert unsaid.tolist() == [good[0], poor[1]] and good[0] < poor[0]


def test_where_it_is_put_down_counts_only_at_most():
    lifts = made_lifts(let_go=(1.5, 0.6, 60.0))
    near = made_lifts(let_go=(1.5, 0.4, 0.0))
    found, other = (indices(one, loaded_plan()).index[0] for one in (lifts, near))
    assert found[0] == other[0] and found[1] > other[1] > other[0]


def test_beyond_the_range_the_edge_stands_and_it_is_told():
    plan = loaded_plan()
    far, edge = (indices(made_lifts(taken=(0.3, h, 0.0)), plan) for h in (0.7, 0.63))
    assert far.out_of_range.all() and not edge.out_of_range.any()
    assert far.index.tolist() == edge.index.tolist()
    often = indices(made_lifts(400, every_s=3.0), plan)
    assert often.out_of_range.all() and np.isfinite(often.index).all()


def test_a_composite_is_that_of_the_equation_over_kinds_of_lifts():
    """Two tasks at a lift a minute each for 59 min; within an hour."""
    plan = loaded_plan()
    tasks = list(plan.tasks)
    tasks[COUNT] = replace(tasks[COUNT], handling=replace(tasks[BEND].handling, load_kg=15.0))
    plan = replace(plan, tasks=tuple(tasks))
    lifts = both(made_lifts(60), made_lifts(60, task=COUNT, start_s=5.0, taken=(0.8, 0.5, 0.0), let_go=(1.1, 0.5, 0.0)))
    per_min = 60 / ((59 * 60 + 8) / 60)
    kinds = [Lift(10.0, 40.0, 30.0, 50.0, 0.0, per_min, 1), Lift(15.0, 50.0, 80.0, 30.0, 0.0, per_min, 1)]
    assert composite_of(lifts, indices(lifts, plan), plan)[0] == pytest.approx(composite(kinds).index)


def test_nobody_who_lifts_nothing_has_an_index():
    none = made_lifts(0)
    assert composite_of(none, indices(none, loaded_plan()), loaded_plan()) == (0.0, 0.0)
    assert not too_often(none, loaded_plan())


def test_lifts_at_least_are_never_more_than_at_most_and_more_often_is_worse():
    rng, plan = np.random.default_rng(3), loaded_plan(grip=None)
    seldom, often = (made_lifts(40, every_s=every) for every in (120.0, 20.0))
    for lifts in (seldom, often):
        lifts.height_m[:] = rng.uniform(0, 1.9, (40, 2))
        lifts.horizontal_m[:] = rng.uniform(0.2, 0.8, (40, 2))
    found = indices(seldom, plan).index
    assert (found[:, 0] <= found[:, 1]).all()
    same = replace(often, height_m=seldom.height_m, horizontal_m=seldom.horizontal_m)
    assert (indices(same, plan).index >= found - 1e-12).all()


def kind(low, high, per_min, cm=80.0):
    return Kind((low, high), per_min, (cm,), (cm,))


def test_a_job_of_which_all_is_known_has_one_index():
    """1.5 / FM(1), FM(1) = 0.94; and 0.5 x (1 / FM(3) - 1 / FM(1)), FM(3) = 0.88; as they are given is no matter."""
    found = composite_range([kind(0.5, 0.5, 2.0), kind(1.5, 1.5, 1.0)], [1])
    assert found == pytest.approx([1.5 / 0.94 + 0.5 * (1 / 0.88 - 1 / 0.94)] * 2)


def test_the_most_is_more_than_that_of_the_order_of_all_mosts():
    """Two lifts of index 1 to 1.1: the seldom one first adds the frequent one at its steep place, and is worse."""
    kinds = [kind(1.0, 1.1, 9.0), kind(1.0, 1.05, 2.0)]
    low, high = composite_range(kinds, [8])
    by_mosts = composite_index([1.1, 1.05], [9.0, 2.0], [80.0, 80.0], 8, least=least_multiplier(8))
    assert low < by_mosts < high


kinds = st.lists(
    st.tuples(st.floats(0.1, 2), st.floats(0, 1), st.floats(0.1, 6), st.sampled_from([30.0, 90.0])),
    min_size=1, max_size=4,
)  # fmt: skip


@given(kinds, st.floats(0, 1), st.sampled_from([1, 2, 8]))
def test_no_index_of_a_job_within_the_intervals_is_outside(drawn, share, hours):
    """Twin: the index of a job with indices somewhere between, in its own order."""
    made = [kind(low, low + more, often, cm) for low, more, often, cm in drawn]
    least, most = composite_range(made, [1, 2, 8])
    inside = [(low + share * more, often, cm) for low, more, often, cm in drawn]
    least_fm = least_multiplier(hours)
    alone = [composite_index([f], [often], [cm], hours, least=least_fm) for f, often, cm in inside]
    order = sorted(range(len(made)), key=lambda at: -alone[at])
    found = composite_index(*_columns(inside, order), hours, least=least_fm)
    assert least - 1e-9 <= found <= most + 1e-9


def _columns(inside, order):
    return tuple([inside[at][column] for at in order] for column in range(3))


@given(kinds)
def test_the_search_finds_what_all_permutations_find_where_any_order_may_be(drawn):
    """Twin over all permutations; intervals so wide that none is ruled out."""
    made = [kind(0.0, low + 10.0, often, cm) for low, _, often, cm in drawn]
    every = [
        composite_index(*_columns([(k.fili[1], k.per_min, k.any_cm[0]) for k in made], order), 8, least=0.13)
        for order in permutations(range(len(made)))
    ]
    assert composite_range(made, [8]) == (0.0, pytest.approx(max(every)))


HOUR_S = 3600.0


@pytest.mark.parametrize(
    ("lifting_min", "recovery_min", "hours"),
    [
        ([60], [np.inf], 1),
        ([61], [np.inf], 2),
        ([120], [np.inf], 2),
        ([121], [np.inf], 8),
        # the manual's own: 45 min of lifting need 54 min of recovery to be of short duration
        ([45, 45], [54, np.inf], 1),
        ([45, 45], [53, np.inf], 2),  # 90 min together; 53 are more than 0.3 x 45
        ([90, 90], [27, np.inf], 2),  # 0.3 x 90 = 27
        ([90, 90], [26, np.inf], 8),  # 180 min together
        ([], [], 1),
    ],
)
def test_durations_by_hand(lifting_min, recovery_min, hours):
    assert duration_hours(np.array(lifting_min) * 60.0, np.array(recovery_min) * 60.0) == hours


def test_lifts_are_counted_over_the_time_of_lifting():
    """A lift of 5 s every 30 s from 0 to 1795 s: 60 lifts in 29.9 min; a pause of over 10 min is none of it."""
    start_s = np.arange(60) * 30.0
    found = pattern(start_s, start_s + 5.0)
    assert (found.minutes, found.hours) == (pytest.approx(1775 / 60), 1)
    both = pattern(np.r_[start_s, 10_000 + start_s], np.r_[start_s + 5, 10_005 + start_s])
    assert both.minutes == pytest.approx(2 * found.minutes)


def test_a_single_lift_is_counted_over_a_quarter_of_an_hour():
    assert pattern(np.array([100.0]), np.array([103.0])).minutes == 15.0


def test_one_lift_every_nine_minutes_is_one_long_period_and_every_eleven_is_many_short_ones():
    for gap_s, hours in ((540.0, 8), (660.0, 1)):
        start_s = np.arange(0.0, 8 * HOUR_S, gap_s)
        assert pattern(start_s, start_s + 5.0).hours == hours


def test_nobody_who_lifts_nothing_lifts_long():
    assert pattern(np.empty(0), np.empty(0)).hours == 1


minutes = st.lists(st.tuples(st.floats(0, 200), st.floats(0, 200)), max_size=6)


@given(minutes, st.floats(1, 3))
def test_more_recovery_never_lengthens_and_more_lifting_never_shortens(periods, times):
    lifting_s, recovery_s = (np.array([60 * p[i] for p in periods]) for i in (0, 1))
    found = duration_hours(lifting_s, recovery_s)
    assert duration_hours(lifting_s, recovery_s * times) <= found <= duration_hours(lifting_s * times, recovery_s)


def lifting(until_min, begin_min=0, every_min=1):
    start_s = np.arange(begin_min, until_min, every_min) * 60.0
    return start_s, start_s + 5.0


@pytest.mark.parametrize("seen_min", [(0, 40), (0, 100), (0, 200), (60, 100)])
def test_the_duration_is_that_of_the_shift_whatever_part_of_it_is_seen(seen_min):
    seen_s = 60.0 * seen_min[0], 60.0 * seen_min[1]
    found = [
        pattern(*lifting(seen_min[1], seen_min[0]), [(0.0, shift_s)], seen_s)
        for shift_s in (HOUR_S * 0.9, 2 * HOUR_S, 8 * HOUR_S)
        if shift_s >= seen_s[1]
    ]
    assert [one.hours for one in found] == [1, 2, 8][3 - len(found) :]
    assert all(one.most_hours == one.hours for one in found)


def test_recovery_that_is_seen_is_in_the_rest_of_the_shift_too():
    """30 min of lifting, 60 of recovery, of which 1.2 x 30 = 36 are enough; 30 of recovery are not (0.3 x 30 are)."""
    for whole_min, hours in ((90, 1), (60, 2)):
        shown = lifting(30)
        assert pattern(*shown, [(0.0, 8 * HOUR_S)], (0.0, 60.0 * whole_min)).hours == hours


def test_who_has_no_shifts_may_go_on_as_long_as_the_table_knows():
    found = pattern(*lifting(40))
    assert (found.hours, found.most_hours, found.columns) == (1, 8, (1, 2, 8))


def test_a_shift_that_is_seen_to_its_end_is_as_it_is_and_so_is_one_in_which_nothing_is_lifted():
    whole = pattern(*lifting(50), [(0.0, HOUR_S)], (0.0, HOUR_S))
    other = pattern(*lifting(50), [(0.0, HOUR_S), (HOUR_S, 9 * HOUR_S)], (0.0, 1.5 * HOUR_S))
    assert whole == other and whole.hours == 1


def loaded_plan(load_kg=10.0, grip="good", task=BEND):
    plan = made_plan()
    tasks = list(plan.tasks)
    tasks[task] = replace(tasks[task], handling=Handling(load_kg=load_kg, grip=grip))
    return replace(plan, tasks=tuple(tasks))


def lifts_of(*stretches, plan=None):
    fold = Lifted(loaded_plan() if plan is None else plan)
    for frames in stretches:
        fold.add(frames)
    return fold.lifts()


def test_a_lift_goes_from_the_first_to_the_last_posture_with_the_load():
    """Empty hands at 0.9 m; taken at 0.2 m with bent knees, let go at 1.0 m to the side; empty again."""
    up = [0.9, 0.2, 0.6, 1.0, 0.9]
    measures = hands(np.array(up), [0.3, 0.3, 0.3, 0.4, 0.3], [0.0, 0.0, 0.0, 0.3, 0.0], [0, 80, 40, 10, 0])
    found = lifts_of(made_frames(5, seconds=0.5, task=BEND, carrying=[False, True, True, True, False], **measures))
    assert found.worker.tolist() == [0] and found.task.tolist() == [BEND]
    assert (found.start_s[0], found.end_s[0]) == (0.5, 2.0)
    assert found.height_m.tolist() == [[0.2, 1.0]]
    assert found.travel_m == pytest.approx([0.8])
    assert found.horizontal_m[0] == pytest.approx([0.3, 0.5])
    assert found.asymmetry_deg[0] == pytest.approx([0.0, np.rad2deg(np.arctan2(0.3, 0.4))])
    assert found.knee_deg.tolist() == [[80.0, 10.0]]


def test_what_stays_within_ten_centimetres_is_carried_and_not_lifted():
    for top, n in ((1.09, 0), (1.11, 1)):
        frames = made_frames(2, task=BEND, carrying=True, **hands(np.array([1.0, top])))
        assert lifts_of(frames).worker.size == n


def test_each_performance_is_a_lift_of_its_own_and_a_load_that_nobody_told_is_none():
    frames = made_frames(
        4, task=[BEND, BEND, COUNT, COUNT], k=[0, 0, 0, 0], carrying=True, **hands(np.r_[0.2, 1, 0.2, 1])
    )
    again = made_frames(2, task=BEND, k=1, start_s=10.0, carrying=True, **hands(np.r_[1.0, 0.2]))
    found = lifts_of(frames, again)
    assert found.start_s.tolist() == [0.0, 10.0] and found.height_m[:, 0].tolist() == [0.2, 1.0]


def test_a_performance_over_the_edge_of_a_stretch_is_one_lift():
    whole = made_frames(4, task=BEND, k=3, carrying=True, **hands(np.array([0.2, 0.4, 0.8, 1.2])))
    halves = lifts_of(whole.some(slice(0, 2)), whole.some(slice(2, 4)))
    assert halves.height_m.tolist() == lifts_of(whole).height_m.tolist() == [[0.2, 1.2]]


def test_postures_without_hands_are_passed_over_and_one_hand_will_do():
    frames = made_frames(3, task=BEND, carrying=True, **hands(np.array([0.1, 0.3, 1.0])))
    frames.measures[0] = np.nan
    frames.measures[:, AT["left_hand_up_m"]] = np.nan
    assert lifts_of(frames).height_m.tolist() == [[0.3, 1.0]]
    frames.measures[:] = np.nan
    assert lifts_of(frames).worker.size == 0


def test_nobody_who_walks_or_waits_lifts():
    assert lifts_of(made_frames(2, task=[-1, -2], carrying=True, **hands(np.array([0.2, 1.0])))).worker.size == 0
