from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from emulator.model.decoding import directions_numpy
from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.model.library import MotionLibrary
from emulator.model.mean_performance import mean_performance
from emulator.motion import turn
from tests.emulator.fitted import made
from tests.emulator.pausing import paused_work


@pytest.fixture(scope="module")
def drawn():
    return made("lift")[1].sample(12, np.random.default_rng(1))


def test_shapes_are_those_of_the_seam(drawn):
    n_bones = drawn.skeleton.n_bones
    assert drawn.duration_s.shape == (12,)
    assert drawn.mark_s.shape == (12, 2)
    assert drawn.scores.shape[0] == 12
    assert drawn.directions(n_times=31).shape == (12, 31, n_bones, 3)
    assert drawn.positions_m(np.linspace(0, 1, 7)).shape == (12, 7, n_bones + 1, 3)
    assert drawn.root_m().shape == (12, 101, 3)


def test_marks_are_in_order_and_inside_the_duration(drawn):
    many = made("lift")[1].sample(5000, np.random.default_rng(0))
    edges = np.column_stack([np.zeros(5000), many.mark_s, many.duration_s])
    assert np.all(np.diff(edges, axis=1) > 0)


def test_a_posture_decoded_alone_is_the_blocks_to_1e_10(drawn):
    block = drawn.positions_m(n_times=33)
    for i in (0, 5, 11):
        assert np.abs(drawn[i].positions_m(n_times=33)[0] - block[i]).max() < 1e-10
        assert np.abs(drawn[i].positions_m(drawn.duration_s[i] * np.array([0.5]))[0, 0] - block[i, 16]).max() < 1e-10
    assert np.abs(drawn[3:6].directions() - drawn.directions()[3:6]).max() < 1e-10


def test_the_last_performance_can_be_had_from_the_end(drawn):
    assert np.array_equal(drawn[-1].duration_s, drawn.duration_s[-1:])


def test_directions_have_unit_length_and_positions_their_bones(drawn):
    assert np.abs(np.linalg.norm(drawn.directions(), axis=-1) - 1).max() < 1e-12
    lengths = drawn.skeleton.bone_lengths(drawn.positions_m())
    assert np.abs(lengths - drawn.bone_length_m[:, None]).max() < 1e-12


def test_decoding_is_its_definition_in_numpy(drawn):
    """Warp, splines between the common postures, heading, bones: step by step, without blocks and kernels.

    How feet are put on the floor has its own twin: tests/naive_footing.py.
    """
    model, own = replace(drawn.model, footing=None), np.linspace(0, 1, 41)
    clock = np.arange(float(model.n_times))
    drawn = model.performances(drawn.scores)
    place = np.stack([np.interp(own, warp, clock) for warp in model.warps(drawn.scores)])
    between = directions_numpy(model.posture, model.flatten, model.scale.raw(drawn.scores, "posture"), place)
    assert np.abs(drawn.directions(n_times=41) - between).max() < 1e-10
    assert np.abs(drawn.directions(n_times=41, dtype=np.float32) - between).max() < 1e-5
    aligned = model.aligned_directions(drawn.scores)
    root, yaw = model.channel.inverse_numpy(model.root_channel(drawn.scores), aligned, drawn.bone_length_m)
    course = np.concatenate([root, yaw[..., None]], axis=-1)
    path = np.stack([CubicSpline(clock, way)(at) for way, at in zip(course, place)])
    world = turn(between, path[..., 3:])
    joints = drawn.skeleton.positions(world, drawn.bone_length_m[:, None], path[..., :3])
    assert np.abs(drawn.positions_m(n_times=41) - joints).max() < 1e-10
    single = drawn.positions_m(n_times=41, dtype=np.float32)
    assert single.dtype == np.float32 and np.abs(single - joints).max() < 1e-5


def test_the_path_starts_at_the_origin_and_nothing_is_below_the_floor(drawn):
    position = drawn.positions_m()
    assert np.abs(position[:, 0, drawn.skeleton.root, :2]).max() < 1e-12
    assert np.array_equal(position[:, :, drawn.skeleton.root], drawn.root_m())
    assert position[..., 2].min() > -0.005


def test_after_its_end_a_performance_holds_its_last_posture(drawn):
    late = drawn.positions_m(np.array([drawn.duration_s.max(), 1000.0]))
    assert np.array_equal(late[:, 1], drawn.positions_m(n_times=2)[:, 1])


def test_times_of_each_performance_can_be_its_own(drawn):
    own = drawn.duration_s[:, None] * np.linspace(0, 1, 9)
    assert np.allclose(drawn.directions(own), drawn.directions(n_times=9), atol=1e-12)


def test_durations_and_marks_are_drawn_without_decoding_a_posture(monkeypatch):
    def refuse(*_):
        raise AssertionError("a posture was decoded")

    for name in ("aligned_directions", "root_channel", "bone_length_m"):
        monkeypatch.setattr(MotionEmulator, name, refuse)
    assert len(made("lift")[1].sample(64, np.random.default_rng(0))) == 64


def test_the_grasp_mark_is_where_the_hand_is_lowest():
    drawn = made("lift")[1].sample(40, np.random.default_rng(2))
    hand = drawn.positions_m(n_times=201)[:, :, drawn.skeleton.index("right_wrist"), 2]
    share = hand.argmin(axis=1) / 200 - drawn.mark_s[:, 0] / drawn.duration_s
    assert np.median(np.abs(share)) < 0.03


def shipped():
    from opsim.shipped import shipped_folder

    return MotionLibrary.load(shipped_folder() / "libraries" / "bench_work.npz")


@pytest.mark.parametrize("worker", [None, "known"])
def test_it_lasts_the_mean_duration_of_everybody_or_of_one_worker(worker):
    emulator = made("lift")[1]
    worker = emulator.workers[0] if worker else None
    mean = mean_performance(emulator, worker)
    assert mean.duration_s == pytest.approx([emulator.mean_duration_s(worker)], rel=1e-9)


def test_aligned_postures_are_the_mean_of_those_of_many_draws():
    emulator = made("lift")[1]
    drawn = emulator.sample(400, np.random.default_rng(0))
    many = emulator.aligned_directions(drawn.scores).mean(axis=0)
    many /= np.linalg.norm(many, axis=-1, keepdims=True)
    mean = emulator.aligned_directions(mean_performance(emulator).moving.scores)[0]
    apart_rad = np.arccos(np.clip(np.sum(many * mean, axis=-1), -1, 1))
    assert apart_rad.max() < 0.06


def test_it_is_not_as_blunt_as_the_mean_of_sequences_that_are_not_registered():
    """Fastening turns a wrist to and fro: everybody's turns fall at other shares of the time."""
    emulator = shipped()["fasten"]
    drawn = emulator.sample(64, np.random.default_rng(1)).directions()
    blunt = drawn.mean(axis=0)
    blunt /= np.linalg.norm(blunt, axis=-1, keepdims=True)
    length = [
        np.mean([way(each) for each in drawn]),
        way(mean_performance(emulator).moving.directions()[0]),
        way(blunt),
    ]
    assert length[1] > 0.95 * length[0] and length[2] < 0.85 * length[0]


def way(directions):
    """Radians that all bones turn on the way, steps of a hundredth of the time."""
    return np.linalg.norm(np.diff(directions, axis=0), axis=-1).sum()


@pytest.fixture(scope="module")
def pausing():
    """Carrying, with a pause of about 1.2 s in 40 % of the repetitions."""
    return MotionEmulator.fit(paused_work("carry", 0.4, 5, 6, seed=3, spread=0.3).motions, scheme=SCHEMES[-1])


def test_a_pause_lasts_the_mean_of_all_dwells_and_the_movement_the_mean_of_moving_times(pausing):
    drawn, mean = pausing.sample(4000, np.random.default_rng(1)), mean_performance(pausing)
    assert mean.duration_s == pytest.approx([pausing.mean_duration_s()], rel=1e-6)
    assert mean.dwell_s == pytest.approx(pausing.dwell_s(drawn.scores).mean(axis=0), rel=0.08)
    assert mean.moving.duration_s == pytest.approx([pausing.moving_s(drawn.scores).mean()], rel=0.03)
    assert mean.mark_s[0] == pytest.approx(drawn.mark_s.mean(axis=0), rel=0.05)


def test_it_stands_still_as_long_as_the_pause_and_not_longer(pausing):
    mean = mean_performance(pausing)
    times_s = np.arange(0.0, mean.duration_s[0], 0.01)
    steps = np.linalg.norm(np.diff(mean.positions_m(times_s)[0], axis=0), axis=-1).max(axis=-1)
    assert 0.01 * np.sum(steps == 0) == pytest.approx(mean.dwell_s.sum(), abs=0.021)
    assert np.allclose(mean.positions_m(n_times=2)[0], mean.moving.positions_m(n_times=2)[0])


def test_marks_lie_inside_and_in_order():
    mean = mean_performance(made("lift")[1])
    whole = np.concatenate([[0.0], mean.mark_s[0], mean.duration_s])
    assert len(whole) > 2 and np.all(np.diff(whole) > 0)


def test_an_unknown_worker_is_refused_with_the_nearest():
    emulator = made("lift")[1]
    with pytest.raises(ValueError, match=rf"did you mean '{emulator.workers[0]}'"):
        mean_performance(emulator, emulator.workers[0] + "x")
