"""What must not change, or change in a known way, when recordings are moved, turned, scaled, put in another order,
renamed, filmed at another rate, slowed down or mirrored: from joints, through the whole fit, to what is drawn.

Where the numbers that the fit sees are the same but for rounding, draws with one seed are the same to ``ROUNDING``:
of the coordinates only PCA could swell a rounding error, by the ratio of the largest to the smallest component kept.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.geometry import elastic, sphere
from emulator.geometry.alignment import resample
from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.motion import motion_from_positions, turn
from emulator.synthetic.tasks import make
from tests.made import made_sequences

ROUNDING = 1e-6
MADE = make("lift", 4, 4, seed=1)[0]
SETTINGS = {"n_times": 61, "n_knots": 15}


@cache
def fitted(scheme=SCHEMES[0]):
    return MotionEmulator.fit(MADE, scheme=scheme, **SETTINGS)


def refitted(motions, scheme=SCHEMES[0]):
    return MotionEmulator.fit(motions, scheme=scheme, **SETTINGS)


def filmed(change):
    """The made recordings again, from joint positions (T, J, 3) that ``change(positions, number)`` has changed."""
    motions = [
        motion_from_positions(
            motion.skeleton,
            change(motion.positions_m(world=True, rigid=False), number),
            (len(motion.time_s) - 1) / motion.duration_s,
            worker=motion.worker,
            trial=motion.trial,
            mark_s=motion.mark_s,
        )
        for number, motion in enumerate(MADE.motions)
    ]
    return replace(MADE, motions=tuple(motions))


def drawn(emulator, n=30, worker=None):
    return emulator.sample(n, np.random.default_rng(3), worker=worker)


def assert_same(
    emulator, other, *, seconds=1.0, metres=1.0, workers=(None, "w2"), to=ROUNDING, turn_rad=None, feet_m=ROUNDING
):
    """The same draws, of new people (None) and known ones; all times ``seconds``, lengths ``metres`` times as long."""
    for worker in workers:
        one, two = drawn(emulator, worker=worker), drawn(other, worker=worker)
        assert np.allclose(two.duration_s, seconds * one.duration_s, rtol=to)
        assert np.allclose(two.mark_s, seconds * one.mark_s, rtol=to)
        assert sphere.angle(one.directions(n_times=9), two.directions(n_times=9)).max() < (turn_rad or to)
        assert np.allclose(two.bone_length_m, metres * one.bone_length_m, rtol=to)
        assert np.allclose(two.positions_m(n_times=9), metres * one.positions_m(n_times=9), atol=feet_m)
    assert other.mean_duration_s() == pytest.approx(seconds * emulator.mean_duration_s(), rel=ROUNDING)
    assert other.duration_cv() == pytest.approx(emulator.duration_cv(), rel=ROUNDING)
    assert other.between_share == pytest.approx(emulator.between_share, abs=ROUNDING)


@pytest.mark.slow
def test_recordings_taken_elsewhere_in_the_room_give_the_same_draws():
    places = np.random.default_rng(0).uniform(-50, 50, (len(MADE), 3)) * [1, 1, 0]
    assert_same(fitted(), refitted(filmed(lambda joints, number: joints + places[number])))


def test_recordings_turned_about_the_vertical_each_by_its_own_angle_give_the_same_draws():
    angles = np.random.default_rng(1).uniform(-np.pi, np.pi, len(MADE))
    assert_same(fitted(), refitted(filmed(lambda joints, number: turn(joints, angles[number]))))


@pytest.mark.parametrize("size", [0.7, pytest.param(1.3, marks=pytest.mark.slow)])
def test_larger_bodies_move_alike_and_everything_they_reach_is_as_much_larger(size):
    """But for the feet, which share the support within a centimetre whoever stands on them (``root.SOFT_M``): the path
    of the root is another by less than a millimetre. New people then come of the same law by other random numbers."""
    other = refitted(filmed(lambda joints, _: size * joints))
    assert_same(fitted(), other, metres=size, workers=("w2",), to=1e-4, feet_m=1e-3)
    people = [emulator.workforce.between for emulator in (fitted(), other)]
    rest = np.arange(len(people[0].mean)) != fitted().scale.block("root").start
    assert np.allclose(people[0].mean[rest], people[1].mean[rest], atol=ROUNDING)
    assert np.allclose(*(some.covariance[np.ix_(rest, rest)] for some in people), atol=ROUNDING)


@pytest.mark.parametrize("times", [pytest.param(0.9, marks=pytest.mark.slow), 1.25])
def test_slower_recordings_give_the_same_postures_slower(times):
    """Up to where a rest becomes a pause: lifts 1.25 times slower rest for less than a quarter of a second. Legs to a
    few milliradians: what is slow enough to stand is said in metres a second, the root follows feet within .15 s, and
    twice as fast, feet that lag in the longest draws make the search for new people's noise end elsewhere."""
    slower = [replace(m, time_s=times * m.time_s, mark_s=times * m.mark_s) for m in MADE.motions]
    assert_same(fitted(), refitted(replace(MADE, motions=tuple(slower))), seconds=times, turn_rad=0.02, feet_m=0.006)


@pytest.mark.parametrize("scheme", [SCHEMES[0], pytest.param(SCHEMES[1], marks=pytest.mark.slow), SCHEMES[-1]])
def test_the_order_of_the_recordings_decides_not_a_single_bit(scheme):
    order = np.random.default_rng(2).permutation(len(MADE))
    one, two = (drawn(emulator) for emulator in (fitted(scheme), refitted(MADE.subset(order), scheme)))
    assert one.scores.tobytes() == two.scores.tobytes()
    assert one.positions_m(n_times=5).tobytes() == two.positions_m(n_times=5).tobytes()


def test_names_of_workers_decide_not_a_single_bit_as_long_as_their_order_stays():
    names = {"w1": "anna", "w2": "ben", "w3": "c 2", "w4": "c 10"}
    other = refitted(replace(MADE, motions=tuple(replace(m, worker=names[m.worker]) for m in MADE.motions)))
    assert other.workers == tuple(names.values())
    for worker in (None, "w3"):
        one, two = drawn(fitted(), worker=worker), drawn(other, worker=worker and names[worker])
        assert one.scores.tobytes() == two.scores.tobytes() and one.duration_s.tobytes() == two.duration_s.tobytes()


@pytest.mark.slow
@pytest.mark.parametrize("rate_hz", [25.0, 120.0])
def test_another_frame_rate_gives_the_same_times_and_hardly_other_postures(rate_hz):
    """A posture between two frames is a guess: at 25 frames a second a lifting hand turns by 3 degrees between two."""
    other = refitted(replace(MADE, motions=tuple(_at(motion, rate_hz) for motion in MADE.motions)))
    assert other.report.duration_mean_s == pytest.approx(fitted().report.duration_mean_s, rel=1e-12)
    assert other.mean_duration_s() == pytest.approx(fitted().mean_duration_s(), rel=0.005)
    assert other.duration_cv() == pytest.approx(fitted().duration_cv(), rel=0.03)
    one, two = drawn(fitted(), 2000), drawn(other, 2000)
    assert np.allclose(np.median(two.mark_s / two.duration_s[:, None], 0), _median_share(one), atol=0.01)
    means = [sphere.normalise(some[:200].directions(n_times=9).mean(axis=0)) for some in (one, two)]
    assert np.degrees(sphere.angle(*means)).mean() < 1.0


def test_mirrored_recordings_give_mirrored_people():
    """Not the same draws: the sign of a component is a convention that a mirror may turn. Their means and spreads."""
    skeleton = MADE.skeleton
    swap = [skeleton.index(_other_side(name)) for name in skeleton.names]
    other = refitted(filmed(lambda joints, _: joints[:, swap] * [1, -1, 1]))
    assert other.mean_duration_s() == pytest.approx(fitted().mean_duration_s(), rel=ROUNDING)
    assert other.duration_cv() == pytest.approx(fitted().duration_cv(), rel=ROUNDING)
    assert np.allclose(_median_share(drawn(other, 4000)), _median_share(drawn(fitted(), 4000)), atol=0.005)
    bones = [skeleton.bone_names.index(_other_side(name)) for name in skeleton.bone_names]
    mirrored = drawn(other, 400).directions(n_times=9)[:, :, bones] * [1, -1, 1]
    means = [sphere.normalise(some.mean(axis=0)) for some in (mirrored, drawn(fitted(), 400).directions(n_times=9))]
    assert np.degrees(sphere.angle(*means)).mean() < 1.0


def test_a_floor_that_was_taken_too_low_lifts_the_body_and_changes_nothing_else():
    """The one move that is seen: 10 cm of clearance under every foot, of the movements as recorded. Places are stored
    in steps of a share of the largest, which decides on the last component of the path; a draw goes by another then."""
    other = refitted(filmed(lambda joints, _: joints + np.array([0, 0, 0.1])))
    one, two = (some.performances(some.workforce.smoothed.scores) for some in (fitted(), other))
    assert np.allclose(two.duration_s, one.duration_s, rtol=0.01)
    assert np.degrees(sphere.angle(one.directions(n_times=9), two.directions(n_times=9))).max() < 1.0
    assert np.allclose(two.root_m(n_times=9) - one.root_m(n_times=9), [0, 0, 0.1], atol=0.02)
    assert other.mean_duration_s() == pytest.approx(fitted().mean_duration_s(), rel=1e-4)


def fields(seed, n_cells, dimension):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(2, n_cells, dimension)).cumsum(axis=1) / np.sqrt(n_cells)


@given(seed=st.integers(0, 10_000), n_cells=st.integers(8, 60), dimension=st.integers(1, 12))
@settings(max_examples=60)
def test_the_elastic_distance_is_symmetric(seed, n_cells, dimension):
    one, other = fields(seed, n_cells, dimension)
    there, back = elastic.best_warp(one, other)[1], elastic.best_warp(other, one)[1]
    assert there == pytest.approx(back, rel=1e-12, abs=1e-12)


@given(seed=st.integers(0, 10_000), angle=st.floats(-np.pi, np.pi), n_cells=st.integers(8, 40))
@settings(max_examples=40)
def test_the_elastic_distance_does_not_turn_with_the_room(seed, angle, n_cells):
    sequences, _, base = made_sequences(2, n_cells, n_bones=3, seed=seed, fine=301)
    plain = elastic.best_warp(*elastic.tsrvf(sequences, base))[1]
    turned = elastic.best_warp(*elastic.tsrvf(turn(sequences, angle), turn(base, angle)))[1]
    assert turned == pytest.approx(plain, rel=1e-9)


@given(seed=st.integers(0, 10_000), size=st.floats(0.01, 100.0))
@settings(max_examples=40)
def test_the_best_warp_does_not_depend_on_how_large_the_movement_is(seed, size):
    one, other = fields(seed, 30, 4)
    (warp, inner), (scaled_warp, scaled) = elastic.best_warp(one, other), elastic.best_warp(size * one, other)
    assert scaled == pytest.approx(size * inner, rel=1e-9)
    assert np.allclose(scaled_warp, warp, atol=1e-12)


def _at(motion, rate_hz):
    """The motion filmed with this many frames a second."""
    n_times = round(motion.duration_s * rate_hz) + 1
    place = np.linspace(0.0, 1.0, n_times)
    own = motion.time_s / motion.duration_s
    return replace(
        motion,
        directions=resample(motion.directions, place),
        time_s=place * motion.duration_s,
        root_m=np.stack([np.interp(place, own, column) for column in motion.root_m.T], axis=1),
        yaw_rad=np.interp(place, own, motion.yaw_rad),
        stretch=None,
    )


def _median_share(performances):
    return np.median(performances.mark_s / performances.duration_s[:, None], axis=0)


def _other_side(name):
    for one, other in (("left", "right"), ("right", "left")):
        if name.startswith(one):
            return other + name.removeprefix(one)
    return name
