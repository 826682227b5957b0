import numpy as np
import pytest

from emulator.model.emulator import MotionEmulator
from emulator.model.library import MotionLibrary
from emulator.model.mean_performance import mean_performance
from tests.emulator.fitted import made
from tests.emulator.pausing import paused_work


def shipped():
    from opsim.shipped import shipped_folder

    return MotionLibrary.load(shipped_folder() / "libraries" / "bench_work.npz")


@pytest.mark.parametrize("worker", [None, "known"])
def test_it_lasts_the_mean_duration_of_everybody_or_of_one_worker(worker):
    emulator = made("lift")[2]
    worker = emulator.workers[0] if worker else None
    mean = mean_performance(emulator, worker)
    assert mean.duration_s == pytest.approx([emulator.mean_duration_s(worker)], rel=1e-9)


def test_aligned_postures_are_the_mean_of_those_of_many_draws():
    emulator = made("lift")[2]
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
    return MotionEmulator.fit(paused_work("carry", 0.4, 5, 6, seed=3, spread=0.3).motions)


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
    mean = mean_performance(made("lift")[2])
    whole = np.concatenate([[0.0], mean.mark_s[0], mean.duration_s])
    assert len(whole) > 2 and np.all(np.diff(whole) > 0)


def test_an_unknown_worker_is_refused_with_the_nearest():
    emulator = made("lift")[2]
    with pytest.raises(ValueError, match=rf"did you mean '{emulator.workers[0]}'"):
        mean_performance(emulator, emulator.workers[0] + "x")
