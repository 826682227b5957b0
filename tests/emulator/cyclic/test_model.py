"""Walking of any length, drawn: ways that end where they shall, times that are distance over speed, feet that stay."""

from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from emulator import Target
from emulator.cyclic.contacts import foot_skate_m
from emulator.cyclic.model import CyclicEmulator
from emulator.model.library import LibraryError, MotionLibrary
from emulator.synthetic.cycles import make_cycles
from emulator.synthetic.walking import make_walks

SHIPPED = Path(__file__).parents[3] / "scenarios" / "libraries" / "walking.npz"


@lru_cache
def walk():
    return MotionLibrary.load(SHIPPED)["walk"]


@lru_cache
def small():
    return CyclicEmulator.fit(make_walks(3, 4, seed=5)[0], points=60)


@lru_cache
def cycles(task):
    return CyclicEmulator.fit(make_cycles(task, 3, 3)[0], task=task, points=60)


def drawn(n=1, seed=0, **condition):
    return walk().sample(n, np.random.default_rng(seed), condition=condition)


def frames(performance, rate_hz=60.0):
    return np.arange(0.0, performance.duration_s[0], 1 / rate_hz)


@pytest.mark.parametrize("distance_m", [0.3, 1.0, 3.0, 7.7, 40.0])
def test_the_way_ends_where_it_shall_with_both_feet_together(distance_m):
    one = drawn(distance_m=distance_m)
    last = one.positions_m(one.duration_s)[0, -1]
    index = one.skeleton.index
    assert last[0, 0] == pytest.approx(distance_m, abs=0.01)
    assert last[index("left_ankle"), 0] == pytest.approx(last[index("right_ankle"), 0], abs=0.03)


@pytest.mark.parametrize(
    ("distance_m", "speed"), [(3.0, 0.4), (3.0, 0.8), (3.0, 1.3), (20.0, 0.4), (20.0, 0.8), (20.0, 1.3), (20.0, 1.8)]
)
def test_the_mean_duration_is_distance_over_speed(distance_m, speed):
    many = drawn(2000, distance_m=distance_m, speed_m_per_s=speed).duration_s
    error = many.std(ddof=1) / np.sqrt(len(many))
    assert abs(many.mean() - distance_m / speed) < 1.96 * error
    assert 0.003 < many.std() / many.mean() < 0.03


def test_a_way_too_short_for_its_speed_takes_as_long_as_feet_need():
    quick = walk().mean_duration_s(condition={"distance_m": 0.6, "speed_m_per_s": 2.0})
    assert quick > 0.6 / 2.0
    assert drawn(500, distance_m=0.6, speed_m_per_s=2.0).duration_s.mean() == pytest.approx(quick, rel=0.1)


def test_a_time_that_is_asked_for_is_met_exactly():
    both = drawn(20, distance_m=4.0, length_s=3.5)
    assert both.duration_s == pytest.approx(3.5) and both.distance_m == pytest.approx(4.0)
    assert drawn(20, length_s=6.0).duration_s == pytest.approx(6.0)


def test_as_many_steps_as_asked_for():
    assert np.isfinite(drawn(5, cycles=6).beat_s).sum(axis=1).tolist() == [12] * 5


def test_step_length_follows_speed_and_leg():
    who = [walk().draw_worker(np.random.default_rng(1), {"height_m": h}) for h in (1.55, 1.95)]
    step = {}
    for k, one in enumerate(who):
        for speed in (0.8, 1.6):
            walked = walk().sample(
                4, np.random.default_rng(0), worker=one, condition={"distance_m": 60.0, "speed_m_per_s": speed}
            )
            step[k, speed] = 60.0 / np.isfinite(walked.beat_s).sum(axis=1).mean()
    assert step[0, 1.6] / step[0, 0.8] == pytest.approx(np.sqrt(2), rel=0.05)
    leg = [float(walk().channel.leg_m(one.bone_length_m)) for one in who]
    assert step[1, 0.8] / step[0, 0.8] == pytest.approx((leg[1] / leg[0]) ** 0.75, rel=0.05)


@pytest.mark.parametrize("speed", [0.7, 1.2, 1.7])
def test_planted_feet_move_less_than_a_millimetre_and_bones_do_not_stretch(speed):
    for seed in range(4):
        one = drawn(seed=seed, distance_m=6.0, speed_m_per_s=speed)
        at = frames(one)
        positions, contact = one.positions_m(at)[0], one.contact(at)[0]
        assert foot_skate_m(positions, contact).max() < 1.2e-3
        assert foot_skate_m(positions, contact).mean() < 0.4e-3
        assert np.ptp(one.skeleton.bone_lengths(positions), axis=0).max() < 1e-9


def test_nothing_jumps():
    """A change of velocity between two frames of a sixtieth of a second, against that of the fastest made walk."""
    recording, _ = make_walks(2, 3, seed=0, speeds_m_per_s=(1.4, 2.2))
    fastest = max(np.linalg.norm(np.diff(t.positions_m, 2, axis=0), axis=-1).max() for t in recording.takes)
    for seed in range(6):
        one = drawn(seed=seed, distance_m=8.0, speed_m_per_s=1.2)
        positions = one.positions_m(frames(one))[0]
        assert np.linalg.norm(np.diff(positions, 2, axis=0), axis=-1).max() < 2 * fastest
        root = np.linalg.norm(np.diff(positions[:, 0], 2, axis=0), axis=-1)
        assert root.max() < fastest / 3


def test_no_toe_goes_through_the_floor():
    one = drawn(distance_m=6.0)
    assert one.positions_m(frames(one))[..., 2].min() > -2e-3


def test_a_row_alone_is_the_row_of_the_block():
    block = drawn(6, seed=2, distance_m=5.0)
    at = np.linspace(0, 4, 30)
    alone = drawn(6, seed=2, distance_m=5.0)[4]
    assert np.abs(block.positions_m(at)[4] - alone.positions_m(at)[0]).max() < 1e-10
    assert np.abs(block[1:3].directions(at) - block.directions(at)[1:3]).max() < 1e-10


def test_directions_have_no_heading_and_path_is_root_and_heading():
    from emulator.motion import heading_rad

    one = drawn(distance_m=4.0)
    at = np.linspace(0, one.duration_s[0], 20)
    directions, path = one.directions(at)[0], one.path(at)[0]
    hips = [one.skeleton.bone_names.index(f"{side}_hip") for side in ("left", "right")]
    across = directions[:, hips[0]] - directions[:, hips[1]]
    assert np.abs(np.arctan2(-across[:, 0], across[:, 1])).max() < 1e-6
    assert np.abs(path[:, 3] - heading_rad(one.skeleton, one.positions_m(at)[0])).max() < 1e-6
    assert np.allclose(path[:, :3], one.root_m(at)[0])


@pytest.mark.slow
def test_a_kilometre_stays_a_walk():
    one = drawn(distance_m=1000.0)
    at = np.linspace(0.9, 1.0, 400) * one.duration_s[0]
    positions = one.positions_m(at)[0]
    assert np.ptp(positions[:, 0, 2]) < 0.2 and np.abs(positions[:, 0, 1]).max() < 0.3


@pytest.mark.parametrize(
    ("condition", "words"),
    [
        ({"distance_m": 3.0, "speed_m_per_s": 3.0}, "0.3 to 2.5 m/s"),
        ({"distance_m": 3.0, "cycles": 2}, "expected one of them"),
        ({"distanc_m": 3.0}, "did you mean 'distance_m'"),
        ({"distance_m": -1}, "metres from 0.05"),
        ({"cycles": 2.5}, "a whole number"),
        ({"distance_m": 10.0, "length_s": 1.0}, "expected 0.05 to 4"),
        ({"distance_m": float("nan")}, "metres from"),
        (3.0, "expected a mapping"),
    ],
)
def test_what_cannot_be_walked_is_refused_in_plain_words(condition, words):
    with pytest.raises(ValueError, match=words):
        walk().sample(1, np.random.default_rng(0), condition=condition)


@pytest.mark.parametrize("speed", [0.1, 2.6, 3.6])
def test_a_speed_asked_for_at_which_nobody_walks_is_refused(speed):
    with pytest.raises(ValueError, match=r"0\.3 to 2\.5 m/s"):
        drawn(distance_m=20.0, speed_m_per_s=speed)


@pytest.mark.parametrize(
    ("condition", "speed"),
    [
        ({"pace": 3.0}, 2.5),
        ({"log_duration_shift": -2.0}, 2.5),
        ({"log_duration_shift": 2.0}, 0.3),
        ({"speed_m_per_s": 1.2, "pace": 3.0}, 2.5),
    ],
)
def test_a_pace_makes_nobody_walk_faster_or_slower_than_people_do(condition, speed):
    assert walk().mean_duration_s(condition={"distance_m": 100.0, **condition}) == pytest.approx(100.0 / speed)
    assert drawn(4, distance_m=100.0, **condition).duration_s == pytest.approx(100.0 / speed, rel=0.05)


def test_a_slow_worker_walks_no_slower_than_people_do():
    slow = walk().draw_worker(np.random.default_rng(0), {"pace": 0.05})
    assert walk().mean_duration_s(slow, {"distance_m": 3.0}) == pytest.approx(3.0 / 0.3)
    assert "0.3 m/s" in CyclicEmulator.sample.__doc__ and "2.5 m/s" in CyclicEmulator.sample.__doc__


def test_no_performances_have_empty_postures():
    none, (bones, joints) = drawn(0, distance_m=3.0), (walk().skeleton.n_bones, len(walk().skeleton.names))
    assert none.directions().shape == (0, 101, bones, 3)
    assert none.positions_m(np.arange(4.0), dtype=np.float32).shape == (0, 4, joints, 3)
    assert none.positions_m(np.arange(4.0), dtype=np.float32).dtype == np.float32
    assert none.root_m(n_times=5).shape == (0, 5, 3) and none.path(n_times=5).shape == (0, 5, 4)
    assert none.contact(n_times=5).shape == (0, 5, 2) and none.contact(n_times=5).dtype == bool
    assert none.distance_m.shape == (0,) and none.mark_s.shape == (0, 0)


def test_every_mistake_of_a_condition_is_named_at_once():
    with pytest.raises(ValueError) as error:
        walk().sample(1, np.random.default_rng(0), condition={"distance_m": -1, "speed_m_per_s": 9, "foo": 1})
    assert len(str(error.value).splitlines()) == 3


def test_workers_known_and_new():
    model = walk()
    assert model.known_worker("w3").name == "w3"
    with pytest.raises(ValueError, match="no worker 'w99'"):
        model.sample(1, np.random.default_rng(0), worker="w99")
    tall = model.draw_worker(np.random.default_rng(0), {"height_m": 1.9, "pace": 1.2, "person": "w2"})
    slow = model.draw_worker(np.random.default_rng(0), {"height_m": 1.9, "person": "w2"})
    assert model.mean_duration_s(tall) == pytest.approx(model.mean_duration_s(slow) / 1.2, rel=0.02)


def test_shift_and_pace_change_the_time():
    still = {"distance_m": 20.0}
    mean = walk().mean_duration_s(condition=still)
    assert walk().mean_duration_s(condition=still | {"pace": 1.25}) == pytest.approx(mean / 1.25)
    assert walk().mean_duration_s(condition=still | {"log_duration_shift": 0.1}) == pytest.approx(mean * np.exp(0.1))


def test_a_fit_says_what_it_found():
    rows = dict(small().report.rows())
    assert {"components", "contact states", "stride time, recorded / drawn", "foot skate, recorded / drawn"} <= set(
        rows
    )
    assert small().report.skate_drawn_cm < 0.1
    assert small().pace.slope == pytest.approx(0.5, abs=0.08)


def test_what_is_loaded_is_what_was_fitted(tmp_path):
    MotionLibrary.of(small()).save(tmp_path / "a.npz")
    MotionLibrary.of(small()).save(tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    back = MotionLibrary.load(tmp_path / "a.npz")["walk"]
    one, other = (m.sample(2, np.random.default_rng(1)) for m in (small(), back))
    assert np.array_equal(one.duration_s, other.duration_s)
    assert np.array_equal(one.positions_m(n_times=40), other.positions_m(n_times=40))


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("dynamics_used", lambda a: a + 10_000),
        ("dynamics_border_used", lambda a: a * 0),
        ("dynamics_noise", lambda a: -a),
        ("finer_length", lambda a: 0 * a),
        ("bone_length_m", lambda a: -a),
    ],
)
def test_hostile_numbers_are_refused(tmp_path, name, change):
    from emulator.cyclic.serialise import pack, unpack

    plain, arrays = pack(small())
    arrays[name] = change(arrays[name])
    with pytest.raises(ValueError):
        unpack("walk", plain, {f"walk/{key}": array for key, array in arrays.items()})


def test_a_kind_that_nobody_knows_is_refused(tmp_path):
    from emulator.model.serialise import unpack

    with pytest.raises(ValueError, match="newer than opsim"):
        unpack("walk", {"kind": "dance"}, {})


@pytest.mark.parametrize("task", ["hammer", "crank"])
def test_other_cycles_have_any_count_and_time(task):
    model = cycles(task)
    counted = model.sample(3, np.random.default_rng(0), condition={"cycles": 11})
    assert np.isfinite(counted.beat_s).sum(axis=1).tolist() == [12] * 3
    assert model.sample(3, np.random.default_rng(0), condition={"length_s": 8.0}).duration_s == pytest.approx(8.0)
    positions = counted.positions_m(n_times=400)[0]
    wrist = positions[:, model.skeleton.index("right_wrist"), 2]
    busy = wrist[60:-60]
    middle, strokes, low = 0.5 * (busy.min() + busy.max()), 0, True
    for height in wrist:
        strokes, low = (
            (strokes + 1, False) if low and height > middle + 0.05 else (strokes, low or height < middle - 0.05)
        )
    assert abs(strokes - 11) <= 1
    assert foot_skate_m(positions, np.ones((400, 2), bool)).max() < 1e-9
    with pytest.raises(ValueError, match="nobody walks"):
        model.sample(1, np.random.default_rng(0), condition={"distance_m": 3.0})


def test_markers_and_gaps_are_refused_in_plain_words():
    from dataclasses import replace

    recording = make_walks(1, 2)[0]
    gap = recording.takes[0].positions_m.copy()
    gap[5, 3] = np.nan
    with pytest.raises(ValueError, match="clean the recording first"):
        CyclicEmulator.fit(replace(recording, takes=(replace(recording.takes[0], positions_m=gap),)))
    bare = tuple(replace(take, parents=None) for take in recording.takes)
    with pytest.raises(ValueError, match="map them first"):
        CyclicEmulator.fit(replace(recording, takes=bare))


def test_times_are_drawn_a_thousand_times_faster_than_walked():
    import time

    drawn(2, distance_m=10.0)
    start = time.process_time()
    many = drawn(256, distance_m=10.0)
    assert many.duration_s.sum() > 1000 * (time.process_time() - start)


def test_an_old_library_still_loads():
    assert len(MotionLibrary.load(SHIPPED.with_name("bench_work.npz"))) == 9
    with pytest.raises(LibraryError, match="did you mean 'walk'"):
        MotionLibrary.load(SHIPPED)["wak"]


def test_a_place_cannot_be_asked_of_cycles():
    with pytest.raises(ValueError, match=r"walk: motion of cycles has no marks .* ask it for distance_m"):
        walk().given(Target("hands", 0, height_m=1.0))
