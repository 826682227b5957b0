"""A task of several motions: times add up, marks follow, one body, joins without a jump, feet that stay."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from emulator.composite.task import CompositeEmulator, Part
from emulator.geometry import sphere
from emulator.motion import turn
from emulator.skeleton import Skeleton
from tests.emulator.fitted import made

NAMES = ("reach", "place", "fasten", "fasten")


@cache
def kit():
    return CompositeEmulator("kit", tuple(Part(name, made(name)[2]) for name in NAMES))


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
        self.asked, self.skeleton, self.body_keys, self.workers = [], made("reach")[2].skeleton, (), ()

    def mean_duration_s(self, worker=None, condition=None):
        return condition["distance_m"] / condition.get("speed_m_per_s", 1.0)

    def draw_worker(self, rng, body=None):
        return None

    def sample(self, n, rng, *, worker=None, condition=None):
        self.asked.append(condition)
        return made("reach")[2].sample(n, rng)


def test_a_walk_is_asked_for_its_length_at_the_worker_s_own_speed():
    way = Way()
    model = CompositeEmulator("kit", (Part("reach", made("reach")[2]), Part("walk", way, {"distance_m": 3.0})))
    effect = model.draw_worker(np.random.default_rng(0), {"walk_m_per_s": 1.5, "height_m": 1.7})
    model.sample(2, np.random.default_rng(0), worker=effect, condition={"pace": 1.1})
    assert way.asked == [{"distance_m": 3.0, "speed_m_per_s": 1.5, "pace": 1.1}]
    reach_s = made("reach")[2].mean_duration_s(effect.effects["reach"])
    assert model.mean_duration_s(effect) == pytest.approx(reach_s + 2.0)
    assert model.body_part == 1


def test_parts_of_one_key_are_one_task_whoever_asks_for_their_effects():
    parts = (Part("reach", made("reach")[2], key="bench"), Part("reach", made("reach")[2], key="bench"))
    asked = []
    effect = CompositeEmulator("kit", parts).draw_worker(
        np.random.default_rng(0),
        own=lambda key, model: asked.append(key) or model.draw_worker(np.random.default_rng(5)),
    )
    assert asked == ["bench"] and list(effect.effects) == ["bench"]


def test_a_person_is_known_where_every_part_knows_him():
    assert kit().workers == made("reach")[2].workers and kit().body_keys == ("height_m", "pace", "person")
    assert kit().sample(3, np.random.default_rng(0), worker="w2").duration_s.shape == (3,)


def test_joins_say_how_far_postures_are_apart():
    first, second, third = kit().joins()
    assert (first.before, first.after) == ("reach", "place") and 0.5 < first.gap_rad < first.most_rad
    assert first.joint in ("right_wrist", "left_wrist", "right_hand", "left_hand") and third.gap_rad < 0.1
    assert second.after == "fasten.1"


def test_other_skeletons_effects_and_nothing_are_refused():
    reach = made("reach")[2]
    other = SimpleNamespace(skeleton=Skeleton((*reach.skeleton.names[:-1], "right_heel"), reach.skeleton.parents))
    with pytest.raises(ValueError, match="kit: kick has no right_toe and also right_heel, unlike reach; expected one"):
        CompositeEmulator("kit", (Part("reach", reach), Part("kick", other)))
    with pytest.raises(ValueError, match="found no motions"):
        CompositeEmulator("kit", ())
    with pytest.raises(ValueError, match="was not drawn from this emulator"):
        kit().sample(1, np.random.default_rng(0), worker=made("reach")[2].known_worker("w1"))


def test_the_typical_performance_takes_the_parts_mean_times():
    one = kit().typical()
    assert len(one) == 1 and one.duration_s[0] == pytest.approx(kit().mean_duration_s(), rel=0.03)
    assert one.positions_m(n_times=5).shape == (1, 5, 21, 3)
