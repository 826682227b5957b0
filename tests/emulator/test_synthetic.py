import numpy as np
import pytest

from emulator.model.emulator import MotionEmulator
from emulator.synthetic.choreography import TASKS
from emulator.synthetic.tasks import RATE_HZ, main, make


@pytest.mark.parametrize("task", TASKS)
def test_every_task_has_people_above_the_floor_with_rigid_bones(task):
    motions, _ = make(task, 2, 2, seed=1)
    assert motions.workers == ("w1", "w2")
    for motion in motions.motions:
        position = motion.positions_m()
        lengths = motions.skeleton.bone_lengths(position)
        assert np.ptp(lengths, axis=0).max() < 1e-9
        assert position[..., 2].min() > 0
        assert 1.2 < position[0, motions.skeleton.index("head"), 2] < 2.0


@pytest.mark.parametrize("task", TASKS)
def test_marks_are_where_the_warp_puts_them(task):
    motions, truth = make(task, 2, 3, seed=2)
    clock = np.linspace(0, 1, truth.warps.shape[1])
    for i, motion in enumerate(motions.motions):
        expected = motion.duration_s * np.interp(truth.mark_clock[i], clock, truth.warps[i])
        assert np.allclose(motion.mark_s, expected)
        assert np.all(np.diff(np.concatenate([[0], motion.mark_s, [motion.duration_s]])) > 0)


def test_durations_are_those_of_the_truth_and_frames_about_50_a_second():
    motions, truth = make("lift", 2, 4)
    assert np.allclose(motions.duration_s, np.exp(truth.log_duration), rtol=1e-12)
    rate = (np.array([len(m.time_s) for m in motions.motions]) - 1) / motions.duration_s
    assert np.allclose(rate, RATE_HZ, rtol=0.01)


def test_warps_run_from_zero_to_one():
    warps = make("walk", 2, 4)[1].warps
    assert np.all(warps[:, 0] == 0)
    assert np.allclose(warps[:, -1], 1)
    assert np.all(np.diff(warps, axis=1) > 0)


def test_a_planted_foot_of_a_walk_does_not_move():
    motion = make("walk", 1, 1)[0].motions[0]
    ankle = motion.positions_m()[:, motion.skeleton.index("left_ankle")]
    low = ankle[:, 2] < ankle[:, 2].min() + 1e-4
    both = low[1:] & low[:-1]
    assert both.mean() > 0.4
    assert np.linalg.norm(np.diff(ankle[:, :2], axis=0), axis=1)[both].max() < 2e-3


def test_walkers_walk_and_the_others_stand():
    way = {task: np.ptp(make(task, 1, 1)[0].motions[0].root_m[:, 0]) for task in TASKS}
    assert min(way["walk"], way["carry"]) > 2.0
    assert max(w for task, w in way.items() if task not in ("walk", "carry")) < 0.4


def test_the_grasping_hand_of_a_lift_is_lowest_at_the_grasp():
    motions, _ = make("lift", 2, 2)
    for motion in motions.motions:
        hand = motion.positions_m()[:, motion.skeleton.index("right_wrist"), 2]
        assert abs(motion.time_s[hand.argmin()] - motion.mark_s[0]) < 0.08 * motion.duration_s


def test_the_same_seed_makes_the_same_motions():
    one, two = (make("pick", 2, 2, seed=5)[0].motions[3] for _ in range(2))
    assert one.directions.tobytes() == two.directions.tobytes()


def test_the_population_is_the_one_that_was_asked_for():
    truth = make("reach", 150, 4, seed=3, between_share=0.7, correlation=-0.5)[1]
    per_worker = truth.log_duration.reshape(150, 4)
    within = per_worker.var(axis=1, ddof=1).mean()
    between = per_worker.mean(axis=1).var(ddof=1) - within / 4
    assert abs(between / (between + within) - 0.7) < 0.08
    assert abs(np.corrcoef(truth.latents[:, 0], truth.log_duration)[0, 1] + 0.5) < 0.1
    assert abs(np.exp(truth.log_duration).mean() / truth.duration_mean_s - 1) < 0.05


@pytest.mark.parametrize("pace", [-0.9, 0.0, 0.6])
def test_who_takes_longer_does_so_on_the_way_there_if_asked_for(pace):
    truth = make("reach", 150, 1, seed=4, correlation=0.4, pace_correlation=pace)[1]
    half = np.log(truth.warps[:, 100] / (1 - truth.warps[:, 100]))
    assert abs(np.corrcoef(half, truth.log_duration)[0, 1] - pace) < 0.2
    assert abs(np.corrcoef(truth.latents[:, 0], truth.log_duration)[0, 1] - 0.4) < 0.2


def test_correlations_that_no_numbers_have_are_refused():
    with pytest.raises(ValueError, match=r"0\.8 and pace_correlation 0\.7 must add to 1"):
        make("reach", 2, 2, correlation=0.8, pace_correlation=0.7)


def test_an_unknown_task_is_answered_with_the_nearest():
    with pytest.raises(ValueError, match="did you mean 'fasten'"):
        make("fastn")


@pytest.mark.slow
def test_the_emulator_recovers_the_truth():
    motions, truth = make("reach", 60, 8, seed=7, between_share=0.6, correlation=0.6)
    emulator = MotionEmulator.fit(motions)
    assert abs(emulator.mean_duration_s() / truth.duration_mean_s - 1) < 0.06
    assert abs(emulator.duration_cv() / truth.duration_cv - 1) < 0.15
    assert abs(emulator.between_share - truth.between_share) < 0.12
    assert emulator.report.icc_low < truth.between_share < emulator.report.icc_high
    drawn = emulator.sample(4000, np.random.default_rng(0))
    assert abs(drawn.duration_s.mean() / truth.duration_mean_s - 1) < 0.06
    assert abs(np.std(drawn.duration_s) / np.mean(drawn.duration_s) / truth.duration_cv - 1) < 0.15
    made_height = _height([m.positions_m() for m in motions.motions], motions.skeleton)
    assert np.corrcoef(made_height, truth.latents[:, 0])[0, 1] > 0.95
    found = np.corrcoef(_height(drawn.positions_m(n_times=41), drawn.skeleton), np.log(drawn.duration_s))[0, 1]
    assert abs(found - truth.posture_duration_correlation) < 0.1


def _height(positions, skeleton):
    """How high the hand gets, in heights of the head: what latent 0 moves."""
    hand, head = skeleton.index("right_wrist"), skeleton.index("head")
    return np.array([p[:, hand, 2].max() / p[0, head, 2] for p in positions])


@pytest.mark.slow
def test_the_command_writes_the_library_of_bench_work(tmp_path, capsys):
    from emulator.model.library import MotionLibrary

    main(["-o", str(tmp_path / "bench_work.npz"), "--seed", "3"])
    library = MotionLibrary.load(tmp_path / "bench_work.npz")
    assert tuple(library) == tuple(TASKS)
    assert library["walk"].report.source == "synthetic, made by this project"
    assert "--seed 3" in library.command
    assert (tmp_path / "bench_work.npz").stat().st_size < 2_100_000
    assert "ICC of log duration" in capsys.readouterr().out
