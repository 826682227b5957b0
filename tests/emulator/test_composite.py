"""A task of several motions: times add up, marks follow, one body, joins without a jump, feet that stay.

A seam: both sides have the value half-way and the mean of both rates, and the ease reaches no further than asked.

Motions one after another: times exact, speed and posture continuous, feet that stay, nothing changed elsewhere.
"""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from emulator import Target
from emulator.composite import transitions as seams
from emulator.composite.joining import JoinError, joined, most_gap_rad, posture_gap_rad
from emulator.composite.task import CompositeEmulator, Part
from emulator.composite.transitions import End
from emulator.geometry import sphere
from emulator.motion import motion_from_positions, turn
from emulator.skeleton import Skeleton
from emulator.synthetic.tasks import make
from tests.emulator.fitted import shipped

NAMES = ("reach", "place", "fasten", "fasten")


@cache
def kit():
    return CompositeEmulator("kit", tuple(Part(name, shipped(name)) for name in NAMES))


@cache
def drawn(n=12):
    effect = kit().draw_worker(np.random.default_rng(1), {"height_m": 1.7})
    return effect, kit().sample(n, np.random.default_rng(2), worker=effect)


def test_the_duration_is_the_sum_of_the_parts_durations_and_so_is_the_mean():
    effect, some = drawn()
    assert np.array_equal(some.duration_s, np.cumsum([p.duration_s for p in some.parts], axis=0)[-1])
    means = [part.model.mean_duration_s(effect.effects[part.name]) for part in kit().parts]
    assert kit().mean_duration_s(effect) == pytest.approx(sum(means), rel=1e-12)


def test_parts_are_drawn_as_they_would_be_one_by_one():
    effect, some = drawn()
    rng = np.random.default_rng(2)
    for part, own in zip(kit().parts, some.parts):
        alone = part.model.sample(12, rng, worker=effect.effects[part.name])
        assert np.array_equal(alone.duration_s, own.duration_s) and np.array_equal(alone.scores, own.scores)


def test_marks_follow_one_another_under_names_with_numbers_where_parts_repeat():
    _, some = drawn()
    assert kit().mark_names == (
        "reach.touch", "place.release", "fasten.1.start", "fasten.1.stop", "fasten.2.start", "fasten.2.stop",
    )  # fmt: skip
    assert some.mark_s.shape == (12, 6) and np.all(np.diff(some.mark_s, axis=1) > 0)
    before = some.parts[0].duration_s + some.parts[1].duration_s
    assert np.allclose(some.mark_s[:, 2:4], before[:, None] + some.parts[2].mark_s, atol=1e-12)


def test_a_repeated_part_has_draws_of_its_own_by_the_same_worker():
    effect, some = drawn()
    assert set(effect.effects) == {"reach", "place", "fasten"}
    assert not np.allclose(some.parts[2].duration_s, some.parts[3].duration_s)


def test_a_row_alone_is_the_row_of_the_block():
    _, some = drawn()
    for what in ("positions_m", "directions", "root_m", "path"):
        block = getattr(some, what)(n_times=40)
        assert np.abs(getattr(some[7], what)(n_times=40) - block[7:8]).max() < 1e-10
        assert np.abs(getattr(some[np.array([3, 7])], what)(n_times=40) - block[[3, 7]]).max() < 1e-10


def test_every_part_of_a_performance_is_one_body():
    _, some = drawn()
    positions = some.positions_m(n_times=60)
    lengths = some.skeleton.bone_lengths(positions)
    assert np.abs(lengths - some.bone_length_m[:, None]).max() < 1e-10


def test_outside_the_joins_postures_are_those_of_the_parts():
    _, some = drawn()
    start_s = some.stop_s - some.part_s
    for k, part in enumerate(some.parts):
        before, after = (
            w[side].max() for w, side in ((some.windows_s[max(k - 1, 0)], 1), (some.windows_s[min(k, 2)], 0))
        )
        own_s = np.linspace(before, some.part_s[:, k] - after, 9)[1:-1].T
        found = some.directions(times_s=start_s[:, k, None] + own_s)
        assert np.abs(found - part.directions(times_s=own_s)).max() < 1e-9


def test_postures_and_speeds_are_continuous_at_a_join():
    _, some = drawn()
    step_s = 1e-4
    for stop_s, window in zip(some.stop_s.T[:-1], some.windows_s):
        d = some.directions(times_s=stop_s[:, None] + step_s * np.array([-2.0, -1.0, 0.0, 1.0, 2.0]))
        speed = np.diff(d, axis=1) / step_s
        assert np.linalg.norm(np.diff(d, axis=1), axis=-1).max() < 8 * step_s
        assert np.linalg.norm(speed[:, 2] - speed[:, 1], axis=-1).max() < 0.05
        assert np.all(window[0] >= 0.3 - 1e-12)


def test_the_root_goes_on_without_a_jump_and_no_joint_sinks_into_the_floor():
    _, some = drawn()
    path = some.root_m(n_times=1500)
    assert np.linalg.norm(np.diff(path, axis=1), axis=-1).max() < 0.02
    assert some.positions_m(n_times=150)[..., 2].min() > -0.01


def test_planted_feet_do_not_slide_at_a_join():
    _, some = drawn()
    for foot in ("left_toe", "right_toe"):
        way = some.positions_m(n_times=200)[:, :, some.skeleton.index(foot), :2]
        assert np.linalg.norm(way - way[:, :1], axis=-1).max() < 0.05


def test_directions_are_positions_without_heading_and_place():
    _, some = drawn()
    times_s = np.linspace(0, some.duration_s, 30).T
    world = some.skeleton.directions(some.positions_m(times_s=times_s))
    assert sphere.angle(turn(some.directions(times_s=times_s), some.path(times_s)[..., 3:]), world).max() < 1e-6


def test_a_pace_passes_to_all_parts():
    effect, some = drawn()
    quick = kit().sample(12, np.random.default_rng(2), worker=effect, condition={"pace": 2.0})
    assert np.allclose(quick.part_s * 2, some.part_s, rtol=1e-9)
    with pytest.raises(ValueError, match="knows no 'pase'; did you mean 'pace'"):
        kit().sample(1, np.random.default_rng(0), condition={"pase": 2.0})


class Way:
    """A walk by an emulator of fixed length: it takes distance over speed."""

    def __init__(self):
        self.asked, self.skeleton, self.body_keys, self.workers = [], shipped("reach").skeleton, (), ()

    def mean_duration_s(self, worker=None, condition=None):
        return condition["distance_m"] / condition.get("speed_m_per_s", 1.0)

    def draw_worker(self, rng, body=None):
        return None

    def sample(self, n, rng, *, worker=None, condition=None):
        self.asked.append(condition)
        return shipped("reach").sample(n, rng)


def test_a_walk_is_asked_for_its_length_at_the_worker_s_own_speed():
    way = Way()
    model = CompositeEmulator("kit", (Part("reach", shipped("reach")), Part("walk", way, {"distance_m": 3.0})))
    effect = model.draw_worker(np.random.default_rng(0), {"walk_m_per_s": 1.5, "height_m": 1.7})
    model.sample(2, np.random.default_rng(0), worker=effect, condition={"pace": 1.1})
    assert way.asked == [{"distance_m": 3.0, "speed_m_per_s": 1.5, "pace": 1.1}]
    reach_s = shipped("reach").mean_duration_s(effect.effects["reach"])
    assert model.mean_duration_s(effect) == pytest.approx(reach_s + 2.0)
    assert model.body_part == 1


def test_parts_of_one_key_are_one_task_whoever_asks_for_their_effects():
    parts = (Part("reach", shipped("reach"), key="bench"), Part("reach", shipped("reach"), key="bench"))
    asked = []
    effect = CompositeEmulator("kit", parts).draw_worker(
        np.random.default_rng(0),
        own=lambda key, model: asked.append(key) or model.draw_worker(np.random.default_rng(5)),
    )
    assert asked == ["bench"] and list(effect.effects) == ["bench"]


def test_a_person_is_known_where_every_part_knows_him():
    assert kit().workers == shipped("reach").workers and kit().body_keys == ("height_m", "pace", "person")
    assert kit().sample(3, np.random.default_rng(0), worker="w2").duration_s.shape == (3,)


def test_joins_say_how_far_postures_are_apart():
    first, second, third = kit().joins()
    assert (first.before, first.after) == ("reach", "place") and 0.5 < first.gap_rad < first.most_rad
    assert first.joint in ("right_wrist", "left_wrist", "right_hand", "left_hand") and third.gap_rad < 0.1
    assert second.after == "fasten.1"


def test_other_skeletons_effects_and_nothing_are_refused():
    reach = shipped("reach")
    other = SimpleNamespace(skeleton=Skeleton((*reach.skeleton.names[:-1], "right_heel"), reach.skeleton.parents))
    with pytest.raises(ValueError, match="kit: kick has no right_toe and also right_heel, unlike reach; expected one"):
        CompositeEmulator("kit", (Part("reach", reach), Part("kick", other)))
    with pytest.raises(ValueError, match="found no motions"):
        CompositeEmulator("kit", ())
    with pytest.raises(ValueError, match="was not drawn from this emulator"):
        kit().sample(1, np.random.default_rng(0), worker=shipped("reach").known_worker("w1"))


def test_the_typical_performance_takes_the_parts_mean_times():
    one = kit().typical()
    assert len(one) == 1 and one.duration_s[0] == pytest.approx(kit().mean_duration_s(), rel=0.03)
    assert one.positions_m(n_times=5).shape == (1, 5, 21, 3)


def ends(rng, n=3, n_bones=4):
    value = sphere.normalise(rng.normal(size=(n, n_bones, 3)))
    rate = rng.normal(size=(n, n_bones, 3))
    rate -= np.sum(rate * value, axis=-1, keepdims=True) * value
    return End(value, rate, np.zeros((n, n_bones)))


def test_the_ease_is_0_and_1_with_no_slope_at_its_ends():
    at = np.array([-0.5, 0.0, 1e-5, 0.5, 1.0 - 1e-5, 1.0])
    assert seams.ease(at) == pytest.approx([0, 0, 0, 0.5, 1, 1], abs=1e-9)
    assert np.max(np.diff(seams.ease(np.linspace(0, 1, 1001))) * 1000) == pytest.approx(seams.PEAK, rel=1e-5)


def test_the_ease_of_the_rate_changes_a_slope_by_1_and_no_value():
    step = 1e-6
    assert seams.ease_rate(np.array([0.0, 1.0])) == pytest.approx([0, 0])
    assert (0 - seams.ease_rate(1 - step)) / step == pytest.approx(1.0, rel=1e-4)


def test_both_sides_of_a_seam_meet_half_way_at_the_mean_of_both_rates():
    rng = np.random.default_rng(2)
    before, after = ends(rng), ends(rng)
    window_s, step = np.full(3, 0.3), 1e-6
    to_seam_s = np.tile([step, 0.0], (3, 1))
    first, second = seams.turns(before, after)
    a = seams.eased_turn(_moving(before, -to_seam_s), first, to_seam_s, window_s)
    b = seams.eased_turn(_moving(after, to_seam_s), second, -to_seam_s, window_s)
    assert np.allclose(a[:, 1], b[:, 1], atol=1e-12)
    assert np.allclose(sphere.angle(a[:, 1], before.value), sphere.angle(before.value, after.value) / 2, atol=1e-12)
    assert np.allclose((a[:, 1] - a[:, 0]) / step, (b[:, 0] - b[:, 1]) / step, atol=1e-4)


def test_opposite_bones_meet_half_way_too():
    up, down = (End(np.array([[[0, 0, z]]]), np.zeros((1, 1, 3)), np.zeros((1, 1))) for z in (1.0, -1.0))
    first, second = seams.turns(up, down)
    met = sphere.turned(up.value, first.shift), sphere.turned(down.value, second.shift)
    assert np.allclose(met[0], met[1], atol=1e-12) and abs(met[0][0, 0, 2]) < 1e-12


def test_plain_channels_meet_half_way_at_the_mean_of_both_rates():
    before, after = (End(np.array([[v]]), np.array([[r]]), np.zeros((1, 1))) for v, r in ((1.0, 0.5), (2.0, -0.5)))
    first, second = seams.shifts(before, after)
    window_s, times = np.array([0.4]), np.linspace(0, 0.4, 4001)
    a = seams.eased_shift((1.0 + 0.5 * (times - 0.4))[None, :, None], first, (0.4 - times)[None], window_s)[0, :, 0]
    b = seams.eased_shift((2.0 - 0.5 * times)[None, :, None], second, -times[None], window_s)[0, :, 0]
    assert a[-1] == pytest.approx(1.5) and b[0] == pytest.approx(1.5)
    assert (a[-1] - a[-2]) / 1e-4 == pytest.approx(0.0, abs=1e-2) and (b[1] - b[0]) / 1e-4 == pytest.approx(0, abs=1e-2)
    assert a[0] == 1.0 - 0.2 and b[-1] == 2.0 - 0.2


def test_a_jump_of_speed_no_larger_than_those_beside_it_is_left():
    times = np.arange(20)[None] * 0.02
    rough = np.cumsum(np.where(np.arange(20) % 2, 0.1, 0.0))[None, :, None]
    one, two = seams.end_of(rough, times, last=True), seams.end_of(rough, times, last=False)
    assert seams.shifts(one, two)[0].rate == 0.0


def _moving(end, seconds):
    """Directions (n, T, B, 3) that pass the end's value at 0 s with its rate."""
    return sphere.exp(end.value[:, None] + 0 * seconds[..., None, None], seconds[..., None, None] * end.rate[:, None])


RATE_HZ = 50.0


@pytest.fixture(scope="module")
def moves():
    """One repetition of each, all by the first of the same made people."""
    return {task: make(task, 1, 1, seed=3)[0].motions[0] for task in ("reach", "pick", "carry", "place", "walk")}


@pytest.fixture(scope="module")
def kits(moves):
    parts = [moves[task] for task in ("reach", "pick", "carry", "place")]
    return joined(parts), parts


def cut(motion, frame):
    positions = motion.positions_m()
    return [
        motion_from_positions(motion.skeleton, some, RATE_HZ, worker="w", trial="t")
        for some in (positions[: frame + 1], positions[frame:])
    ]


def speeds(motion):
    """(T - 1, B, 3) how fast directions change, radians a second."""
    return np.diff(motion.directions, axis=0) / np.diff(motion.time_s)[:, None, None]


def test_joining_one_motion_is_the_motion(moves):
    assert joined([moves["reach"]]) is moves["reach"]


def test_durations_add_up_exactly(kits):
    whole, parts = kits
    assert whole.duration_s == np.cumsum([part.duration_s for part in parts])[-1]


def test_marks_are_shifted_by_what_went_before_and_by_nothing_else(kits):
    whole, parts = kits
    starts = np.concatenate([[0], np.cumsum([part.duration_s for part in parts])[:-1]])
    assert np.array_equal(whole.mark_s, np.concatenate([s + p.mark_s for s, p in zip(starts, parts)]))


@pytest.mark.parametrize("frame", [20, 40, 60])
@pytest.mark.parametrize("task", ["reach", "walk"])
def test_the_halves_of_a_motion_joined_are_the_motion(moves, task, frame):
    motion = moves[task]
    again = joined(cut(motion, frame), bone_length_m=motion.bone_length_m)
    assert np.abs(again.positions_m(world=True) - motion.positions_m()).max() < 1e-12


def test_joining_is_associative_where_motions_are_longer_than_two_blends(moves):
    a, b, c = (moves[task] for task in ("pick", "carry", "place"))
    left, right, flat = joined([joined([a, b]), c]), joined([a, joined([b, c])]), joined([a, b, c])
    for other in (left, right):
        assert np.abs(other.positions_m() - flat.positions_m()).max() < 1e-12
        assert np.allclose(other.mark_s, flat.mark_s, atol=1e-12)


def test_outside_the_blends_nothing_changes_but_place_and_heading(kits):
    whole, parts = kits
    start, at = 0, 0.0
    for part in parts:
        inside = (part.time_s > 0.3 + 1e-9) & (part.time_s < part.duration_s - 0.3 - 1e-9)
        rows = start + np.flatnonzero(inside)
        assert np.abs(whole.directions[rows] - part.directions[inside]).max() < 1e-12
        assert np.abs(np.diff(whole.yaw_rad[rows]) - np.diff(part.yaw_rad[inside])).max() < 1e-12
        assert np.allclose(whole.time_s[rows], at + part.time_s[inside], atol=1e-12)
        start, at = start + len(part.time_s) - 1, at + part.duration_s


def test_steps_of_the_root_outside_the_blends_are_as_they_were(moves):
    a, b = moves["walk"], moves["carry"]
    whole = joined([a, b], bone_length_m=a.bone_length_m)
    inside = np.flatnonzero((a.time_s > 0) & (a.time_s < a.duration_s - 0.31))
    assert np.abs(whole.root_m[inside] - a.root_m[inside]).max() < 1e-12


def test_directions_stay_unit(kits):
    assert np.abs(np.linalg.norm(kits[0].directions, axis=-1) - 1).max() < 1e-12


def test_the_jump_of_speed_at_a_seam_is_no_larger_than_within_its_motions(kits):
    whole, parts = kits
    frame = 0
    for before, after in pairwise(parts):
        frame += len(before.time_s) - 1
        jump = np.linalg.norm(speeds(whole)[frame] - speeds(whole)[frame - 1], axis=-1).max()
        usual = max(np.linalg.norm(np.diff(speeds(p), axis=0), axis=-1).max() for p in (before, after))
        assert jump <= usual


def test_without_easing_the_same_seam_does_jump(moves):
    """The control: what the join takes away."""
    a, b = moves["pick"], moves["carry"]
    posture_jump = np.linalg.norm(b.directions[0] - a.directions[-1], axis=-1).max() * RATE_HZ
    assert posture_jump > 3 * np.linalg.norm(speeds(joined([a, b])), axis=-1)[len(a.time_s) - 8 :][:16].max()


def test_planted_feet_do_not_slide_between_motions(moves):
    whole = joined([moves["reach"], moves["pick"], moves["reach"]], bone_length_m=moves["reach"].bone_length_m)
    for foot in ("left_ankle", "right_ankle", "left_toe", "right_toe"):
        way = whole.positions_m()[:, whole.skeleton.index(foot), :2]
        assert np.linalg.norm(way - way[0], axis=-1).max() < 0.01


def test_the_next_motion_goes_on_where_the_last_looks(moves):
    walk = moves["walk"]
    bend = replace(walk, yaw_rad=np.linspace(0, np.pi / 2, len(walk.time_s)))
    whole = joined([bend, walk])
    gone = whole.root_m[-1] - whole.root_m[len(walk.time_s) - 1]
    assert gone[1] == pytest.approx(walk.root_m[-1, 0], abs=0.02) and abs(gone[0]) < 0.05


def test_bones_are_the_first_motion_s_or_as_asked(moves):
    a, b = moves["reach"], replace(moves["pick"], bone_length_m=1.1 * moves["pick"].bone_length_m, stretch=None)
    assert np.array_equal(joined([a, b]).bone_length_m, a.bone_length_m)
    tall = joined([a, b], bone_length_m=b.bone_length_m)
    assert np.array_equal(tall.bone_length_m, b.bone_length_m)
    assert tall.root_m[0, 2] > 1.05 * a.root_m[0, 2]


def test_postures_too_far_apart_are_refused_with_place_found_and_expected(moves):
    a = moves["reach"]
    flipped = a.directions.copy()
    hand = a.skeleton.bone_names.index("right_wrist")
    flipped[:, hand] *= -1
    b = replace(a, directions=flipped, trial="r9")
    assert posture_gap_rad(a, b) > most_gap_rad(a, b)
    with pytest.raises(
        JoinError, match=r"seam 2 \(w1/r1 -> w1/r9\): the bone to right_wrist is 1[78]\d degrees away, exp"
    ):
        joined([a, a, b])


def test_all_wrong_seams_are_said_at_once(moves):
    a = moves["reach"]
    other = Skeleton((*a.skeleton.names[:-1], "right_heel"), a.skeleton.parents)
    b = replace(a, skeleton=other)
    with pytest.raises(JoinError) as caught:
        joined([a, b, a, b])
    assert str(caught.value).count("also right_heel") == 2


def test_nothing_and_no_time_are_refused(moves):
    with pytest.raises(JoinError, match="found no motions, expected one or more"):
        joined([])
    with pytest.raises(JoinError, match="blend_s: found 0, expected positive seconds"):
        joined([moves["reach"]], blend_s=0)


def test_motions_shorter_than_a_blend_can_be_joined(moves):
    pieces = cut(moves["reach"], 6)
    whole = joined([pieces[0], pieces[0], pieces[1]])
    assert np.isfinite(whole.positions_m()).all() and len(whole.time_s) == 12 + len(pieces[1].time_s)


# hands at a place in one of the motions


def rack():
    return CompositeEmulator("rack", (Part("place", shipped("place")), Part("shelf", shipped("lift"))))


@pytest.mark.parametrize("body", [None, {"height_m": 1.9}])
def test_a_target_is_passed_on_to_the_part_that_has_the_mark(body):
    given = rack().given(Target("hands", "shelf.grasp", height_m=0.5))
    effect = None if body is None else given.draw_worker(np.random.default_rng(2), body)
    some = given.sample(12, np.random.default_rng(1), worker=effect)
    wrists = [some.skeleton.names.index(f"{side}_wrist") for side in ("left", "right")]
    hands = some.positions_m(some.mark_s[:, [given.mark_names.index("shelf.grasp")]])[:, 0, wrists, 2].mean(axis=1)
    assert np.abs(hands - 0.5).max() < 0.005
    assert np.array_equal(
        some.parts[0].duration_s, rack().sample(12, np.random.default_rng(1), worker=effect).part_s[:, 0]
    )


@pytest.mark.parametrize(
    ("targets", "said"),
    [
        ([], "rack: found no target"),
        ("hands", "rack: found 'h', expected a Target"),
        (Target("hands", "shelf.gras", height_m=1.0), "no mark 'shelf.gras'; did you mean 'shelf.grasp'?"),
        (Target("nose", "shelf.grasp", height_m=1.0), "lift: no joint 'nose'"),
    ],
)
def test_a_target_that_no_part_can_meet_is_told(targets, said):
    with pytest.raises(ValueError) as caught:
        rack().given(targets)
    assert said in str(caught.value)
