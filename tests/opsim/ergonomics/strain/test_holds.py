"""Postures that are held, across stretches of frames.

Shares of strength that leaning asks.

Marks of held frames made into runs.

The fold that counts what is held, and what moves.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.ergonomics.angles import AT
from opsim.ergonomics.strain.posture_limits import ZONED, Still
from opsim.ergonomics.strain.static_holds import (
    CHANNELS,
    REGIONS,
    STATIC,
    STATIC_WORK,
    Holding,
    RunsOf,
    StaticMarker,
    hold_share,
    marked,
)
from opsim.subjects.people.plan import Body
from tests.opsim.ergonomics.holding import Stretch, frames, naive_held, naive_parts
from tests.opsim.ergonomics.made_frames import made_frames

TRUNK = list(CHANNELS).index("trunk")


def marks_of(stretches, holding=STATIC, region=TRUNK):
    return [marks[:, region].tolist() for _, marks in marked(stretches, holding)]


def test_more_than_a_minute_is_static_and_a_minute_is_not():
    assert marks_of([frames([30.0] * 61)]) == [[True] * 61]
    assert marks_of([frames([30.0] * 60)]) == [[False] * 60]


def test_nobody_holds_what_is_neutral():
    assert not np.any(marks_of([frames([20.0] * 100)]))
    assert not np.any(marks_of([frames([np.nan] * 100)]))


def test_ten_degrees_are_within_the_band_and_eleven_are_not():
    assert np.all(marks_of([frames([30.0, 40.0] * 40)]))
    assert not np.any(marks_of([frames([30.0, 41.0] * 40)]))


def test_a_hold_goes_on_from_one_performance_and_one_stretch_to_the_next():
    """40 s and 40 s of the same angle: neither is long enough, both together are."""
    one, other = frames([30.0] * 40), frames([32.0] * 40, start_s=40.0)
    assert not np.any(marks_of([one]))
    assert np.all(marks_of([one, other]))


def test_what_lies_between_ends_a_hold():
    one, late = frames([30.0] * 40), frames([32.0] * 40, start_s=41.0)
    assert not np.any(marks_of([one, late]))
    assert not np.any(marks_of([one, frames([32.0] * 40, start_s=40.0, worker=1)]))


def test_only_the_held_part_is_marked():
    found = marks_of([frames([30.0] * 61 + [0.0] + [30.0] * 30)])[0]
    assert found == [True] * 61 + [False] * 31


def test_an_arm_is_held_whatever_the_trunk_does():
    stretch = frames([90.0] * 70, column="left_arm_elevation")
    found = next(marks for _, marks in marked([stretch]))
    assert {region for place, region in enumerate(CHANNELS) if found[:, place].all()} == {"left_arm"}
    assert found.sum() == 70


def test_backward_is_out_of_neutral_from_5_degrees_for_static_work_and_from_20_for_scores():
    for angle_deg, held in ((-4.0, False), (-5.0, False), (-6.0, True), (-19.0, True), (6.0, False)):
        assert np.all(marks_of([frames([angle_deg] * 70)], STATIC_WORK)) == held
        assert not np.any(marks_of([frames([angle_deg] * 70)]))
    assert np.all(marks_of([frames([-21.0] * 70)]))


def test_an_arm_behind_the_trunk_is_held_and_one_before_it_as_low_is_not():
    for flexion_deg, held in ((-10.0, True), (10.0, False)):
        stretch = frames([10.0] * 70, column="left_arm_elevation")
        stretch.measures[:, AT["left_arm_flexion"]] = flexion_deg
        assert np.all(marks_of([stretch], STATIC_WORK, list(CHANNELS).index("left_arm"))) == held
        assert not np.any(marks_of([stretch], STATIC, list(CHANNELS).index("left_arm")))


def test_every_stretch_comes_back_once_and_in_order():
    stretches = [frames([30.0] * n, start_s=100.0 * i, worker=i // 3) for i, n in enumerate((5, 0, 90, 1, 70, 0, 2))]
    back = list(marked(stretches))
    assert [id(stretch) for stretch, _ in back] == [id(stretch) for stretch in stretches]
    assert [len(marks) for _, marks in back] == [5, 0, 90, 1, 70, 0, 2]


def test_what_is_kept_is_a_minute_however_long_the_day():
    marker = StaticMarker()
    for hour in range(3):
        marker.push(0, *frames([30.0] * 3600, start_s=3600.0 * hour)[1:])
        assert marker._start_s.size <= 62


angles = st.lists(st.sampled_from([0.0, 21.0, 25.0, 30.0, 33.0, -6.0, -30.0, np.nan]), max_size=60)
cuts = st.lists(st.integers(0, 60), max_size=4)


@settings(deadline=None)
@given(
    *(angles, cuts, st.sampled_from([1.0, 2.5, 4.0, 9.0]), st.sampled_from([0.0, 0.3, 3.0]), st.integers(0, 99)),
    st.sampled_from([None, 5.0]),
)
def test_any_cut_into_stretches_marks_as_the_naive_way(value_deg, edges, least_s, pause_s, seed, backward_deg):
    """Frames of 0.1 to 1.5 s, every seventh after a pause."""
    whole = frames(value_deg, seconds=np.random.default_rng(seed).uniform(0.1, 1.5, len(value_deg)))
    start_s = whole.start_s + pause_s * (np.arange(len(value_deg)) // 7)
    holding = Holding(least_s, backward_deg=backward_deg)
    parts = np.split(np.arange(len(value_deg)), sorted(min(edge, len(value_deg)) for edge in edges))
    stretches = [Stretch(0, start_s[at], whole.seconds[at], whole.measures[at]) for at in parts]
    found = np.concatenate([marks[:, TRUNK] for _, marks in marked(stretches, holding)])
    bounds = (*holding.neutral_deg("trunk"), holding.band_deg, least_s, holding.gap_s)
    assert np.array_equal(found, naive_held(np.array(value_deg), start_s, start_s + whole.seconds, *bounds))


@pytest.mark.parametrize(("holding", "band_deg"), [(STATIC, 4.0), (STATIC_WORK, 0.5)])
def test_a_wider_band_never_marks_less(holding, band_deg):
    value_deg = 40.0 + 15.0 * np.sin(np.arange(400) / 30.0)
    narrow, wide = (
        np.array(marks_of([frames(value_deg)], Holding(holding.least_s, band_deg=band))[0]) for band in (band_deg, 12.0)
    )
    assert (wide >= narrow).all() and wide.sum() > narrow.sum()


BODIES = [None, Body(), Body(mass_kg=60.0, height_m=1.65, sex="f"), Body(mass_kg=95.0, height_m=1.9, sex="m")]


def test_an_upright_body_holds_nothing_and_a_level_one_most():
    for region in ("trunk", "left_arm", "right_arm"):
        assert hold_share(region, 0.0) == 0.0
        assert 0 < hold_share(region, 45.0) < hold_share(region, 90.0) <= 1.0


def test_a_level_arm_by_hand():
    """75 kg, 1.75 m, man (age 40): shoulder strength -30.8 - 0.24 x 40 + 36 x 1.75 + 0.49 x 75 = 59.35 Nm; arm:
    0.0271 x 0.5772 x 0.186 + (0.0162 + 0.0061) x 0.186 + (0.0162 x 0.4574 + 0.0061) x 0.146 = 0.0090297 of m g h.
    9.80665 x 75 x 1.75 x 0.0090297 = 11.622 Nm, 19.58 %.
    """
    assert hold_share("left_arm", 90.0, Body(mass_kg=75.0, height_m=1.75, sex="m")) == pytest.approx(0.1958, abs=1e-4)


def test_a_level_trunk_by_hand():
    """Same man: 0.30 x (0.3229 x 0.6153 + 2 x 0.0494) + 0.36 x 0.0694 = 0.114228; x 9.80665 x 75 x 1.75 = 147.02 Nm,
    of 234 Nm: 62.8 %.
    """
    assert hold_share("trunk", 90.0, Body(mass_kg=75.0, height_m=1.75, sex="m")) == pytest.approx(0.6283, abs=1e-4)


@given(st.sampled_from(["trunk", "left_arm"]), st.floats(0, 90), st.floats(0, 90), st.sampled_from(BODIES))
def test_leaning_farther_never_asks_for_less(region, one, other, body):
    low, high = sorted((one, other))
    assert 0 <= hold_share(region, low, body) <= hold_share(region, high, body) <= 1
    assert np.isclose(hold_share(region, -low, body), hold_share(region, low, body))


@given(st.lists(st.booleans(), max_size=30), st.integers(0, 30))
def test_runs_do_not_depend_on_where_stretches_are_cut(held, cut):
    held = np.array(held, bool)
    angle, start_s, seconds = np.arange(held.size) * 1.0, np.arange(held.size) * 0.5, np.full(held.size, 0.5)
    found = []
    for edges in ([], [min(cut, held.size)]):
        runs = RunsOf(100.0, 0.1)
        for part in np.split(np.arange(held.size), edges):
            runs.add(0, start_s[part], seconds[part], angle[part], held[part])
        found.append(runs.runs())
    for name in ("start_s", "seconds", "angle_deg"):
        assert getattr(found[0], name) == pytest.approx(getattr(found[1], name))
    assert found[0].seconds.sum() == pytest.approx(0.5 * held.sum())


def runs_of(angle_deg, seconds=1.0, held=True, cuts=()):
    angle, n = np.asarray(angle_deg, float), len(angle_deg)
    lasting, marks = np.full(n, seconds) if np.isscalar(seconds) else np.asarray(seconds), np.full(n, held)
    start_s, runs = np.r_[0.0, np.cumsum(lasting)[:-1]][:n], RunsOf(10.0, 0.5)
    for part in np.split(np.arange(n), sorted(min(cut, n) for cut in cuts)):
        runs.add(0, start_s[part], lasting[part], angle[part], marks[part])
    return runs.runs()


def test_three_holds_one_after_the_other_are_three():
    """25 degrees for 20 s, 70 for 8 s, 25 for 20 s: no hold is at (40 x 25 + 8 x 70) / 48 = 32.5 degrees."""
    found = runs_of([25.0] * 20 + [70.0] * 8 + [25.0] * 20)
    assert found.seconds.tolist() == [20.0, 8.0, 20.0] and found.angle_deg.tolist() == [25.0, 70.0, 25.0]
    assert found.start_s.tolist() == [0.0, 20.0, 28.0]


def test_the_longest_part_within_the_band_is_a_hold_and_not_the_first():
    """3 s at 25, 10 s at 34, 10 s at 40: from the left 13 s and 10 s; the longest is the 20 s from 34 to 40."""
    found = runs_of([25.0] * 3 + [34.0] * 10 + [40.0] * 10)
    assert found.seconds.tolist() == [3.0, 20.0] and found.angle_deg.tolist() == [25.0, 37.0]


def test_a_short_frame_that_is_not_held_is_between_two_holds():
    found = runs_of([30.0] * 60, seconds=0.1, held=np.arange(60) != 30)
    assert found.seconds == pytest.approx([3.0, 2.9])


@given(st.lists(st.sampled_from([25.0, 30.0, 34.0, 36.0, 41.0, 70.0]), max_size=24), st.integers(0, 99), st.data())
def test_holds_are_the_naive_parts_wherever_a_day_is_cut(angle, seed, data):
    lasting = np.random.default_rng(seed).integers(1, 4, len(angle)) * 0.125
    found = runs_of(angle, lasting, cuts=data.draw(st.lists(st.integers(0, 24), max_size=3)))
    spans = naive_parts(angle, list(lasting), 10.0)
    assert found.seconds == pytest.approx([lasting[first:last].sum() for first, last in spans])
    assert found.angle_deg == pytest.approx(
        [np.average(angle[first:last], weights=lasting[first:last]) for first, last in spans]
    )


STILL_TRUNK = list(REGIONS).index("trunk")


def told(*stretches, n_workers=1):
    fold = Still(n_workers)
    for some in stretches:
        fold.add(some)
    return fold, fold.close()


def test_a_hold_over_two_stretches_is_one_with_its_mean_angle():
    """6 s at 30 degrees and 2 s at 38: (6 x 30 + 2 x 38) / 8 = 32 degrees."""
    first, second = made_frames(6, trunk_flexion=30.0), made_frames(2, start_s=6.0, trunk_flexion=38.0)
    fold, runs = told(first, second)
    trunk = runs["trunk"]
    assert (trunk.start_s.tolist(), trunk.seconds.tolist(), trunk.angle_deg.tolist()) == ([0.0], [8.0], [32.0])
    assert fold.held_s[0, STILL_TRUNK] == 8.0


def test_four_seconds_are_not_yet_held_and_another_worker_starts_anew():
    assert told(made_frames(4, trunk_flexion=30.0))[1]["trunk"].seconds.size == 0
    two = made_frames(3, worker=0, trunk_flexion=30.0), made_frames(3, worker=1, start_s=3.0, trunk_flexion=30.0)
    assert told(*two, n_workers=2)[1]["trunk"].seconds.size == 0


def test_the_head_is_trunk_and_neck_together():
    """15 + 15 degrees: neither trunk nor neck is out of neutral, the head is."""
    fold, runs = told(made_frames(10, trunk_flexion=15.0, neck_flexion=15.0))
    assert fold.held_s[0].tolist() == [0.0, 0.0, 0.0, 0.0, 10.0]
    assert runs["head"].angle_deg.tolist() == [30.0]


def test_a_held_stoop_is_not_accepted_beyond_60_degrees():
    fold, _ = told(made_frames(10, trunk_flexion=61.0))
    assert fold.not_acceptable_s[0, ZONED.index("trunk")] == 10.0
    assert told(made_frames(10, trunk_flexion=50.0))[0].not_acceptable_s[0, ZONED.index("trunk")] == 0.0


def test_what_goes_on_over_an_hour_is_one_movement():
    """Bent by 30 degrees from 3590 s to 3610 s, in two stretches: one movement, of trunk and of an arm."""
    bent = {"trunk_flexion": 30.0, "left_arm_elevation": 30.0, "left_arm_flexion": 30.0}
    fold, _ = told(made_frames(10, start_s=3590.0, **bent), made_frames(10, start_s=3600.0, **bent))
    assert fold.moves[0, [ZONED.index("trunk"), ZONED.index("left_arm")]].tolist() == [1.0, 1.0]
    two = made_frames(3, worker=0, **bent), made_frames(3, worker=1, start_s=3.0, **bent)
    assert told(*two, n_workers=2)[0].moves[:, ZONED.index("trunk")].tolist() == [1.0, 1.0]


def test_an_edge_of_a_stretch_makes_no_bend_too_often():
    """Up at 3599 s, held till 3601 s, and bent once more at 3630 s: in the second minute there is one bend, not two."""
    angle = np.zeros(60)
    angle[0], angle[30] = 40.0, 40.0
    before = np.zeros(60)
    before[59] = 40.0
    fold, _ = told(
        made_frames(60, start_s=3540.0, trunk_flexion=before), made_frames(60, start_s=3600.0, trunk_flexion=angle)
    )
    assert fold.not_acceptable_s[0, ZONED.index("trunk")] == 0.0


def test_who_leans_back_or_has_an_arm_behind_him_holds_it():
    back = {"trunk_flexion": -10.0, "right_arm_elevation": 15.0, "right_arm_flexion": -15.0}
    fold, runs = told(made_frames(10, **back))
    held = dict(zip(REGIONS, fold.held_s[0].tolist()))
    assert held == {"trunk": 10.0, "left_arm": 0.0, "right_arm": 10.0, "neck": 0.0, "head": 10.0}
    assert runs["right_arm"].angle_deg.tolist() == [-15.0]


def test_three_holds_are_told_apart():
    fold, runs = told(made_frames(trunk_flexion=np.repeat([25.0, 70.0, 25.0], [20, 8, 20])))
    assert runs["trunk"].seconds.tolist() == [20.0, 8.0, 20.0] and fold.held_s[0, STILL_TRUNK] == 48.0


def test_what_nobody_knows_is_not_counted():
    frames = made_frames(10)
    frames.measures[:] = np.nan
    fold, runs = told(frames)
    assert fold.known_s.sum() == 0 and fold.held_s.sum() == 0 and not any(one.seconds.size for one in runs.values())
