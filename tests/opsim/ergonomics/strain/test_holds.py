"""Postures that are held, across stretches of frames."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.ergonomics.angles import AT
from opsim.ergonomics.strain.static_holds import CHANNELS, STATIC, STATIC_WORK, Holding, StaticMarker, marked
from tests.opsim.ergonomics.holding import Stretch, frames, naive_held

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
