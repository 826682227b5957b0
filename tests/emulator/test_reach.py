"""``MotionEmulator.given`` and ``reach``: made people at shelves, where truth is known."""

import pickle
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from emulator_evidence.reach import drawn_of, energy, in_bodies, seen_of, summary
from motion_evidence import reach as motion_evidence

from emulator import MotionEmulator, Target
from emulator.model import reach_emulator
from emulator.model.gaussian import LowRankNormal
from emulator.model.joint_law import JointLaw
from emulator.model.reach import SURE, LocalRegression, _least_sure, derivative, held, reached_law
from emulator.model.targets import HandPlaces
from emulator.synthetic.shelf import MARK, crew, make_shelf, median_duration_s
from tests.emulator.fitted import made

SHELF_M, STEP_AHEAD_M = 1.2, 0.6


@cache
def shelf():
    rng = np.random.default_rng(3)
    return MotionEmulator.fit(make_shelf(crew(6, rng), 10, rng=rng))


def at(height_m, **more):
    return shelf().given(Target("hands", MARK, height_m=height_m, **more))


def wrists_m(drawn):
    """(n, 3) the middle of the wrists at the mark, from the middle of the ankles at the start, ahead, aside, high."""
    names = drawn.skeleton.names
    joints = drawn.positions_m(np.concatenate([np.zeros((len(drawn), 1)), drawn.mark_s[:, :1]], axis=1))
    hands, feet = ([names.index(f"{side}_{joint}") for side in ("left", "right")] for joint in ("wrist", "ankle"))
    origin = joints[:, 0, feet].mean(axis=1) * [1.0, 1.0, 0.0]
    return joints[:, 1, hands].mean(axis=1) - origin


def draws(emulator, n=24, worker=None, condition=None):
    return emulator.sample(n, np.random.default_rng(1), worker=worker, condition=condition)


@pytest.mark.parametrize("height_m", [0.3, 0.8, 1.5])
@pytest.mark.parametrize("body", [None, {"height_m": 1.55}, {"height_m": 1.95}])
def test_decoded_hands_are_within_5_mm_of_the_shelf(height_m, body):
    worker = None if body is None else shelf().draw_worker(np.random.default_rng(2), body)
    assert np.abs(wrists_m(draws(at(height_m), worker=worker))[:, 2] - height_m).max() < 0.005


def test_all_three_axes_are_met_and_what_is_left_out_scatters():
    place = np.array([0.40, 0.03, 1.0])
    hands = wrists_m(draws(at(place[2], ahead_m=place[0], aside_m=place[1])))
    assert np.abs(hands - place).max() < 0.005
    assert wrists_m(draws(at(place[2])))[:, 0].std() > 0.005


@pytest.mark.parametrize("condition", [{"duration_s": 2.2}, {"log_duration_shift": 0.1}, {"pace": 1.2}])
def test_hands_stay_where_they_are_under_a_condition(condition):
    drawn = draws(at(SHELF_M), condition=condition)
    assert np.abs(wrists_m(drawn)[:, 2] - SHELF_M).max() < 0.005
    if "duration_s" in condition:
        assert np.allclose(drawn.duration_s, condition["duration_s"])


def test_a_low_shelf_takes_the_time_and_the_trunk_that_were_put_in():
    low, high = draws(at(0.25), 64), draws(at(1.2), 64)
    asked = np.log(median_duration_s(np.array([0.25, 1.2])))
    assert np.log(low.duration_s).mean() - np.log(high.duration_s).mean() == pytest.approx(asked[0] - asked[1], abs=0.1)
    pelvis, neck = (shelf().skeleton.names.index(name) for name in ("pelvis", "neck"))
    trunks = [
        one.positions_m(one.mark_s)[:, 0, neck] - one.positions_m(one.mark_s)[:, 0, pelvis] for one in (low, high)
    ]
    bent, upright = (np.degrees(np.arccos(t[:, 2] / np.linalg.norm(t, axis=1))).mean() for t in trunks)
    assert bent > 45 and upright < 10


def test_draws_are_nearer_to_fresh_movements_at_the_shelf_than_free_draws():
    fresh = seen_of(
        make_shelf(crew(12, np.random.default_rng(8)), 4, rng=np.random.default_rng(9), heights_m=[0.3])
    ).rows
    given, free = (drawn_of(one, [None], 48).rows for one in (at(0.3), shelf()))
    assert energy(given, fresh) < 0.15 * energy(free, fresh)


def test_two_shelves_share_their_luck():
    """A centimetre higher is the same movement a little changed: item k keeps its own noise."""
    one, other = draws(at(1.0), 64), draws(at(1.01), 64)
    assert np.corrcoef(np.log(one.duration_s), np.log(other.duration_s))[0, 1] > 0.99
    assert np.abs(one.duration_s / other.duration_s - 1.0).max() < 0.05
    free = draws(shelf(), 64)
    assert np.corrcoef(np.log(free.duration_s), np.log(one.duration_s))[0, 1] > 0.3


def test_a_short_and_a_tall_worker_do_different_things_at_one_shelf():
    short, tall = (shelf().draw_worker(np.random.default_rng(2), {"height_m": h}) for h in (1.55, 1.95))
    low = at(0.7)
    assert low.mean_duration_s(tall) > 1.05 * low.mean_duration_s(short)


def test_the_mean_duration_is_that_of_draws():
    worker = shelf().draw_worker(np.random.default_rng(4))
    for effect in (None, worker):
        given = at(0.5)
        mean_s = draws(given, 4000, effect).duration_s.mean()
        assert given.mean_duration_s(effect) == pytest.approx(mean_s, rel=0.02)


def test_where_places_tell_nothing_of_time_durations_are_those_of_free_draws():
    given = at(0.3)
    trend = given._trend
    silent = replace(trend, times=replace(trend.times, trust=np.zeros(trend.timed.sum())))
    law = reached_law(given, None, given.places, given.target_m, silent).law
    drawn, free = (one.sample(64, np.random.default_rng(1)) for one in (law, shelf().law(None)))
    duration, posture = (shelf().scale.block(name) for name in ("duration", "posture"))
    assert np.allclose(drawn[:, duration], free[:, duration], atol=1e-12)
    assert np.abs(drawn[:, posture] - free[:, posture]).max() > 0.5


def test_draws_that_trunk_and_arms_cannot_bring_to_a_high_shelf_are_drawn_in(monkeypatch):
    """A shelf above what people of that stature were recorded at: where a miss counts nothing, more miss."""
    short, high = shelf().draw_worker(np.random.default_rng(2), {"height_m": 1.6}), 1.71
    off = []
    for counts in (reach_emulator.MISSED_PER_S, 0.0):
        monkeypatch.setattr(reach_emulator, "MISSED_PER_S", counts)
        drawn = draws(at(high), 64, worker=short)
        off.append(np.sum(np.abs(wrists_m(drawn)[:, 2] - high) > 0.005))
    assert off[0] <= 7 < off[1]


@pytest.mark.parametrize(("body", "height_m"), [(1.5, 1.54), (1.6, 1.68), (None, 1.9)])
def test_nobody_misses_the_highest_shelf_that_was_reached_for(body, height_m):
    worker = None if body is None else shelf().draw_worker(np.random.default_rng(2), {"height_m": body})
    assert np.abs(wrists_m(draws(at(height_m), 64, worker=worker))[:, 2] - height_m).max() < 0.005


def test_feet_stand_as_they_do_without_a_target():
    free, given = draws(shelf()), draws(at(1.6))
    feet = [shelf().skeleton.names.index(f"{side}_{joint}") for side in ("left", "right") for joint in ("ankle", "toe")]
    slid = [np.ptp(one.positions_m(n_times=41)[:, :, feet, :2], axis=1).max(axis=(1, 2)) for one in (free, given)]
    assert slid[1].max() < max(1.5 * slid[0].max(), 0.03)


def test_no_joint_is_faster_than_the_bound_unless_the_mean_movement_is():
    drawn = draws(at(1.5), 48)
    assert np.all((drawn._ground.fastest_m_per_s <= shelf().most_m_per_s + 1e-9) | (drawn.damped == 1.0))


def test_without_targets_nothing_changes():
    """The base class's own way: bits are compared with those of a law that never heard of targets."""
    free = draws(shelf())
    assert type(free).__name__ == "MotionPerformances"
    law = shelf().workforce.law(None)
    assert np.array_equal(free.scores, law.sample(24, np.random.default_rng(1)))


def test_a_row_is_decoded_to_what_it_is_in_the_block():
    drawn = draws(at(0.8), 5)
    assert np.allclose(drawn[3].positions_m(n_times=9)[0], drawn.positions_m(n_times=9)[3], atol=1e-8)


def test_a_given_emulator_survives_pickling_and_takes_more_targets():
    given = pickle.loads(pickle.dumps(at(0.8)))
    assert np.array_equal(draws(given).duration_s, draws(at(0.8)).duration_s)
    both = given.given(Target("pelvis", MARK, height_m=0.95))
    assert both.targets == (*given.targets, Target("pelvis", MARK, height_m=0.95))


def test_two_marks_are_met_at_once():
    _, emulator = made("lift")
    targets = [Target("hands", "grasp", height_m=0.40), Target("hands", "set_down", height_m=1.0)]
    drawn = draws(emulator.given(targets))
    names = drawn.skeleton.names
    joints = [names.index("left_wrist"), names.index("right_wrist")]
    assert np.abs(drawn.positions_m(drawn.mark_s)[:, :, joints, 2].mean(axis=-1) - [0.40, 1.0]).max() < 0.005


# what is known, and what is refused


def test_places_by_a_few_frames_are_those_of_whole_bodies():
    """h(z) leaves out what feet correct: recordings, whose feet stand, are met to a centimetre."""
    z = shelf().workforce.smoothed.scores[:20]
    places = HandPlaces.of(shelf(), [Target("right_wrist", MARK, height_m=1.0)])
    decoded = places.decoded(shelf().performances(z))
    assert np.abs(places(z) - decoded).max() < 0.01


def test_reach_tells_the_recorded_range():
    reach = shelf().reach("hands", MARK)
    assert reach.height_m == pytest.approx((0.1, 1.9), abs=0.15)
    assert list(reach.quantiles_m()["height_m"]) == sorted(reach.quantiles_m()["height_m"])
    assert len(reach.places_m) == 60


@pytest.mark.parametrize(("height_m", "word"), [(1.2, "fine"), (2.03, "stretched"), (2.4, "refused")])
def test_the_verdict_goes_by_the_distance_to_recordings(height_m, word):
    verdict = shelf().reach("hands", MARK).verdict(Target("hands", MARK, height_m=height_m))
    assert verdict.word == word
    assert "heights 0.1" in verdict.sentence and f"{height_m:.2f} m" in verdict.sentence


def test_a_verdict_of_a_worker_goes_by_that_body():
    short = shelf().draw_worker(np.random.default_rng(2), {"height_m": 1.5})
    reach, high = shelf().reach("hands", MARK), Target("hands", MARK, height_m=1.9)
    assert reach.verdict(high, short).mahalanobis2 > reach.verdict(high).mahalanobis2


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: Target("hands", MARK), "found no place"),
        (lambda: Target("hands", MARK, height_m=-0.1), "below the floor"),
        (lambda: Target("hands", MARK, height_m=float("nan")), "expected metres"),
        (lambda: at(5.0), "above anybody's reach; expected at most"),
        (lambda: shelf().given(Target("rihgt_wrist", MARK, height_m=1)), "did you mean 'right_wrist'?"),
        (lambda: shelf().given(Target("hands", "grap", height_m=1)), "no mark 'grap'; did you mean 'grasp'?"),
        (lambda: shelf().given(Target("hands", 1, height_m=1)), "no mark 1; known: grasp"),
        (lambda: shelf().given([Target("hands", MARK, height_m=1)] * 2), "given twice"),
        (lambda: shelf().given([]), "found no target"),
        (lambda: shelf().given("hands"), "expected a Target"),
        (lambda: shelf().reach("nose", MARK), "no joint 'nose'"),
        (lambda: at(1.0).save("nowhere.npz"), "save the emulator it was made of"),
    ],
)
def test_what_cannot_be_asked_for_is_told(wrong, words):
    with pytest.raises(ValueError) as caught:
        wrong()
    assert words in str(caught.value)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(ValueError) as caught:
        shelf().given([Target("nose", MARK, height_m=1), Target("hands", "grap", height_m=1)])
    assert len(str(caught.value).splitlines()) == 2


def test_the_evidence_tells_how_often_it_helped():
    errors = np.array([[[0.2, 0.2, 0.1], [0.1, 0.1, 0.2]], [[0.2, 0.2, 0.1], [0.1, 0.1, 0.05]]])
    told = motion_evidence.lines("squat", errors, np.array([0.0, 0.5]))
    assert told[0] == "squat: 2 recordings left out, one at a time; 25% of the draws miss by 5 mm"
    assert [line.split()[-1] for line in told[1:]] == ["100%", "100%", "50%"]


def test_the_evidence_tells_the_bias_of_the_law_from_the_luck_of_a_fit():
    """Two fits whose times are 5 % off, one either way: no bias."""
    rows = np.zeros((2, 4, 16))
    rows[..., 3:5] = rows[..., 6:8] = np.arange(4.0)[:, None]
    rows[:, :, 5], rows[..., 15] = np.log([[1.05], [0.95]]), 1.0
    told = summary(rows)
    assert told[0] == "time: error of a fit mean 5.0%, 90 % of them within 5.0%, largest 5.0%; 0% within 3%"
    assert told[1].startswith("  bias over 2 fits mean 0.0%") and "standard error 5.0%" in told[1]


def test_the_evidence_asks_people_with_bones_as_long_as_those_of_made_ones():
    """By stature alone they are some tenths of a per cent off."""
    asked = [shelf().draw_worker(np.random.default_rng(i), {"height_m": 1.9}) for i in range(3)]
    like = make_shelf(crew(1, np.random.default_rng(0), 1.9, 1.9), 1, rng=np.random.default_rng(0)).motions[0]
    off = [
        np.abs([one.scale * shelf().bone_length_m(one.z[None])[0] / like.bone_length_m - 1.0 for one in people]).max()
        for people in (asked, in_bodies(shelf(), asked, 1.9))
    ]
    assert off[1] < 1e-9 < 0.002 < off[0]


# the parts


def test_held_noise_does_not_move_the_hands_and_else_varies_as_much():
    rng = np.random.default_rng(0)
    free = LowRankNormal.of_rows(np.zeros(6), rng.normal(size=(9, 6)) / 3, 0.1)
    slope = rng.normal(size=(2, 6))
    one = held(free, slope, np.ones(6, bool))
    x = one.sample(20000, np.random.default_rng(1))
    assert np.abs(x @ slope.T).max() < 1e-3
    exact = free.covariance - free.covariance @ slope.T @ np.linalg.solve(
        slope @ free.covariance @ slope.T, slope @ free.covariance
    )
    assert np.allclose(one.covariance, exact, atol=1e-5)
    assert np.allclose(np.cov(x.T), exact, atol=0.05)
    assert np.allclose(one.covariance_with(2), one.covariance[:, 2])


def test_noise_is_held_by_what_may_be_moved_and_the_rest_keeps_its_bits():
    rng = np.random.default_rng(0)
    free = LowRankNormal.of_rows(np.zeros(6), rng.normal(size=(9, 6)) / 3, 0.1)
    slope, moved = rng.normal(size=(2, 6)), np.arange(6) != 3
    one = held(free, slope, moved)
    x, plain = (law.sample(2000, np.random.default_rng(1)) for law in (one, free))
    assert np.abs(x @ slope.T).max() < 1e-3
    assert np.array_equal(x[:, 3], plain[:, 3])
    assert np.allclose(one.covariance[3, 3], free.covariance[3, 3])


def test_a_local_line_foretells_a_line_and_bends_with_a_bend():
    place = np.linspace(0.0, 2.0, 41)[:, None]
    at_places = np.array([[0.33], [1.4]])
    line = LocalRegression(np.hstack([3.0 * place, -place]), place, 0.5)
    assert np.allclose(line(at_places), np.hstack([3.0 * at_places, -at_places]), atol=0.05)
    bend = LocalRegression(np.sin(2.0 * place), place)
    best = bend.best(np.ones(1))
    assert np.isfinite(best.span)
    off = [np.abs(one(at_places) - np.sin(2.0 * at_places)).max() for one in (best, bend)]
    assert off[0] < 0.05 < off[1]


def test_a_parabola_foretells_a_parabola_of_two_axes_to_its_edge():
    rng = np.random.default_rng(2)
    place = rng.uniform(-1.0, 1.0, size=(60, 2))

    def z(at):
        return (at[:, :1] ** 2 - 3.0 * at[:, :1] * at[:, 1:] + at[:, 1:]) * [1.0, -2.0]

    edge = np.array([[0.95, 0.9], [-0.9, 0.9]])
    off = [np.abs(LocalRegression(z(place), place, 0.9, degree)(edge) - z(edge)).max() for degree in (1, 2)]
    assert off[1] < 0.1 < 0.5 < off[0]


def test_of_windows_that_foretell_alike_the_narrower_one_is_taken():
    """A line under noise: all windows are as good, so that what bends is never smoothed over for nothing."""
    rng = np.random.default_rng(7)
    place = np.linspace(0.0, 2.0, 200)[:, None]
    one = LocalRegression(place + rng.normal(size=place.shape), place)
    best, close = one.best(np.ones(1)), one.best(np.ones(1), 1.03)
    error, more = (np.mean((each.z - each._left_out()) ** 2) for each in (best, close))
    assert error <= more <= 1.03 * error
    assert np.trace(close._smoother(place)) > np.trace(best._smoother(place))


def test_what_places_do_not_tell_is_not_believed():
    rng = np.random.default_rng(5)
    place = rng.normal(size=(30, 3))
    z = np.column_stack([place[:, 0] + 0.1 * rng.normal(size=30), rng.normal(size=30)])
    trust = LocalRegression(z, place).shrunk().trust
    assert trust[0] > 0.9 and trust[1] < 0.4


def test_what_places_tell_by_luck_alone_is_seldom_believed():
    """Of 200 times that have nothing to do with places; one that has is."""
    rng = np.random.default_rng(8)
    place = rng.normal(size=(20, 3))
    z = np.column_stack([place[:, 0] + 0.5 * rng.normal(size=20), rng.normal(size=(20, 200))])
    lenient, strict = (LocalRegression(z, place).shrunk(sure).trust for sure in (None, SURE))
    assert strict[0] > 0.7
    assert np.mean(strict[1:] > 0) <= 0.02 < 0.05 < np.mean(lenient[1:] > 0)


def test_what_hangs_on_one_recording_is_not_believed():
    """The least sure of all that is left when one is put aside, one by one."""
    rng = np.random.default_rng(9)
    gain = rng.normal(1.0, 2.0, size=(17, 5))
    sure = [np.delete(gain, i, axis=0) for i in range(len(gain))]
    each = [one.mean(axis=0) / (one.std(axis=0, ddof=1) / np.sqrt(len(one))) for one in sure]
    np.testing.assert_allclose(_least_sure(gain), np.min(each, axis=0), rtol=1e-12)


def with_step(motion):
    """The same movement by somebody who glides ahead early on and stays there."""
    share = np.clip((motion.time_s / motion.duration_s - 0.1) / 0.25, 0.0, 1.0)
    root_m = motion.root_m.copy()
    root_m[:, 0] += STEP_AHEAD_M * share**2 * (3.0 - 2.0 * share)
    return replace(motion, root_m=root_m, trial=motion.trial + "_step")


def test_a_body_that_steps_to_its_place_is_not_stood_back_where_it_was():
    """Recordings in which people step, and others in which they do not: all three axes are met by each draw."""
    stood = make_shelf(crew(3, np.random.default_rng(6)), 6, rng=np.random.default_rng(7), heights_m=[1.0, 1.2])
    stepping = [with_step(one) for one in stood.motions]
    emulator = MotionEmulator.fit(replace(stood, motions=(*stood.motions, *stepping)), n_times=41, n_knots=12)
    place = np.array([0.36 + STEP_AHEAD_M, 0.0, 1.1])
    drawn = draws(emulator.given(Target("hands", MARK, ahead_m=place[0], aside_m=place[1], height_m=place[2])), 32)
    assert np.linalg.norm(wrists_m(drawn) - place, axis=1).max() < 0.005


def test_the_derivative_is_that_of_a_line():
    slope = np.arange(6.0).reshape(2, 3)
    here, found = derivative(lambda z: z @ slope.T, np.ones(3))
    assert np.allclose(here, slope.sum(axis=1)) and np.allclose(found, slope)


def test_a_task_without_marks_is_refused():
    bare = JointLaw.__new__(MotionEmulator)
    for name, value in vars(shelf()).items():
        object.__setattr__(bare, name, value)
    object.__setattr__(bare, "mark_names", ())
    with pytest.raises(ValueError, match="the task has no marks"):
        bare.given(Target("hands", 0, height_m=1.0))
