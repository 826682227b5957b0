import numpy as np
import pytest

from emulator.judge.clips import Clips, resampled
from emulator.judge.joint_speeds import (
    energies,
    joint_rates,
    median_speed_ratio,
    peak_ratio,
    peaks,
    places_and_speeds,
    share_too_fast,
    share_too_fast_left_out,
)
from emulator.judge.kinematic_test import area_under_curve, feature_names, features, filled, kinematic_test, logistic
from tests.emulator.judge.made_clips import NO_FEET, SKELETON, clips, still, waved

HAND = SKELETON.index("left_hand")


def moved(course, n_times=121):
    """The left hand goes along x as ``course`` says of the time from 0 to 1, two seconds long."""
    body = still(n_times)
    body[:, HAND, 0] += course(np.linspace(0, 1, n_times))
    return clips(body)


@pytest.mark.parametrize(("order", "rate"), [(1, 3.0), (2, 6.0), (3, 6.0)])
def test_a_power_of_time_has_the_derivative_of_the_textbook(order, rate):
    made = moved(lambda u: {1: 3.0, 2: 3.0, 3: 1.0}[order] * (2 * u) ** order)
    assert np.allclose(joint_rates(made, order)[0][:, HAND], rate)
    assert np.allclose(peaks(made, order)[0], np.where(np.arange(SKELETON.n_joints) == HAND, rate, 0.0))


def test_the_frame_rate_of_a_clip_decides_nothing():
    for n_times in (61, 121, 241):
        assert np.isclose(peaks(moved(lambda u: np.sin(2 * np.pi * u), n_times), 1).max(), np.pi, rtol=0.01)


def test_twice_as_fast_has_eight_times_the_jerk():
    one, other = moved(lambda u: np.sin(2 * np.pi * u)), moved(lambda u: np.sin(2 * np.pi * u))
    quick = Clips(SKELETON, other.positions_m, other.duration_s / 2)
    assert np.isclose(peak_ratio(quick, one, 1), 2, rtol=0.02) and np.isclose(peak_ratio(quick, one, 3), 8, rtol=0.05)
    assert np.isclose(median_speed_ratio(quick, one), 2, rtol=0.02)


def test_a_draw_is_too_fast_from_a_tenth_above_the_fastest():
    recorded = clips(*(moved(lambda u, v=v: v * u).positions_m[0] for v in (1.0, 2.0)))
    drawn = clips(*(moved(lambda u, v=v: v * u).positions_m[0] for v in (1.0, 2.1, 2.3, 3.0)))
    assert share_too_fast(drawn, recorded) == 0.5
    assert share_too_fast_left_out(recorded, np.array([0, 1])) == 0.5
    assert np.isnan(share_too_fast_left_out(recorded, np.array([0, 0])))


def test_who_stands_still_is_not_too_fast_and_has_no_ratio():
    stands = clips(still())
    assert share_too_fast(clips(still() + 1e-9), stands) == 0.0
    assert np.isnan(peak_ratio(stands, stands, 3)) and np.isnan(median_speed_ratio(stands, stands))


def test_energies_are_nothing_of_a_sample_with_itself_and_the_distance_of_two_places():
    rng = np.random.default_rng(0)
    made = waved(5, rng)
    assert np.allclose(energies(made, made), 0, atol=1e-9)
    raised = still()
    raised[..., 2] += 0.1
    places, speeds = energies(clips(still()), clips(raised))
    assert np.isclose(places, 200) and np.isclose(speeds, 0)  # twice 10 cm, in mm


def test_places_begin_at_the_root_and_speeds_are_in_real_time():
    away = clips(still() + np.array([3.0, -2.0, 0.0]))
    assert np.allclose(places_and_speeds(away)[0], places_and_speeds(clips(still()))[0])
    run = still()
    run[..., 0] += np.linspace(0, 4, len(run))[:, None]
    assert np.allclose(np.linalg.norm(places_and_speeds(clips(run))[1], axis=1), 2.0)


def test_a_clip_of_three_frames_is_read_on_four_points():
    places, step_s = clips(still(3), seconds=0.05).at_rate(30)
    assert len(places[0]) == 4 and np.isclose(step_s[0], 0.05 / 3)
    assert peaks(clips(still(3), seconds=0.05), 3).shape == (1, SKELETON.n_joints)


def test_between_frames_it_goes_straight():
    assert np.allclose(resampled(np.array([0.0, 1.0, 4.0]), 5), [0, 0.5, 1, 2.5, 4])


@pytest.mark.parametrize(
    ("broken", "words"),
    [
        (lambda: clips(np.where(np.arange(21)[:, None] == HAND, np.nan, still(9))), "clip 0: joint 'left_hand' is not"),
        (lambda: clips(still(1)), "expected \\(T, 21, 3\\), T from 2"),
        (lambda: clips(still(), seconds=0.0), "clip 0: found a duration of 0.0 s"),
        (lambda: clips(still(), skeleton=NO_FEET), "expected \\(T, 3, 3\\)"),
        (lambda: Clips(SKELETON, (), np.empty(0)), "found 0 movements"),
    ],
)
def test_what_is_no_movement_is_refused_by_name(broken, words):
    with pytest.raises(ValueError, match=words):
        broken()


def test_two_samples_of_one_law_cannot_be_told_apart():
    found = [
        kinematic_test(waved(20, rng), waved(20, rng), rng, n_permutations=9)
        for rng in (np.random.default_rng(seed) for seed in range(6))
    ]
    assert abs(np.mean([test.auc for test in found]) - 0.5) < 0.1
    assert sum(test.p <= 0.1 for test in found) <= 2


def test_a_sample_that_trembles_is_told_apart():
    rng = np.random.default_rng(1)
    found = kinematic_test(waved(15, rng), waved(15, rng, shake_m=0.005), rng, n_permutations=19)
    assert found.auc > 0.98 and found.p == 0.05 and found.null_95 < 0.8
    assert found.telling[1] > 0.95


def test_a_sample_of_other_spread_but_one_mean_is_told_by_the_squares():
    rng = np.random.default_rng(2)
    assert kinematic_test(waved(40, rng, size=0.02), waved(40, rng, size=0.6), rng, n_permutations=0).auc > 0.8


def test_of_pairs_that_hardly_differ_nothing_is_learnt_by_heart():
    rng = np.random.default_rng(3)
    recorded = waved(20, rng)
    again = Clips(
        recorded.skeleton,
        tuple(p + 1e-7 * rng.normal(size=p.shape) for p in recorded.positions_m),
        recorded.duration_s,
    )
    found = kinematic_test(recorded, again, rng, pairs=True, n_permutations=9)
    assert abs(found.auc - 0.5) < 0.15 and 0.3 < found.null_mean < 0.7


def test_what_lies_above_six_hertz_is_not_looked_at():
    time_s = np.linspace(0, 2, 241)
    rates = []
    for hz in (1.0, 25.0):
        body = still(241)
        body[:, :, 0] += 0.001 * np.sin(2 * np.pi * hz * time_s)[:, None]
        rates.append(np.exp(features(clips(body))[0, 4]) - 0.01)
    assert rates[1] < 0.1 * rates[0]  # as drawn it would be 25 times as fast


def test_features_of_a_body_without_feet_leave_the_feet_out():
    body = np.cumsum(np.random.default_rng(0).normal(size=(40, 3, 3)), axis=0)
    made = clips(body, skeleton=NO_FEET)
    assert features(made).shape == (1, len(feature_names(made))) == (1, 21)
    assert features(clips(still(3))).shape == (1, 24) and np.isfinite(filled(features(clips(still(3))))).all()


def test_the_area_under_the_curve_counts_pairs():
    score, positive = np.array([1.0, 2.0, 2.0, 3.0]), np.array([False, True, False, True])
    pairs = [(s > t) + 0.5 * (s == t) for s in score[positive] for t in score[~positive]]
    assert area_under_curve(score, positive) == np.mean(pairs) == 0.875


def test_the_logistic_curve_is_at_its_least():
    rng = np.random.default_rng(4)
    x, y = rng.normal(size=(60, 3)), rng.random(60) < 0.3
    beta = logistic(x, y, ridge=0.7)
    weight = np.where(y, 0.5 / y.mean(), 0.5 / (1 - y.mean()))

    def loss(b):
        line = b[0] + x @ b[1:]
        return np.sum(weight * (np.log1p(np.exp(line)) - y * line)) + 0.35 * np.sum(b[1:] ** 2)

    assert all(loss(beta) <= loss(beta + 0.02 * step) for step in rng.normal(size=(50, 4)))


@pytest.mark.parametrize(("n", "m", "pairs"), [(2, 9, False), (9, 2, False), (9, 8, True)])
def test_too_few_or_unequal_pairs_are_refused(n, m, pairs):
    rng = np.random.default_rng(0)
    with pytest.raises(ValueError, match=f"found {n} recorded and {m} drawn"):
        kinematic_test(waved(n, rng), waved(m, rng), rng, pairs=pairs)
