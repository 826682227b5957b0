import time
from dataclasses import replace

import numpy as np
import pytest

from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.motion import MotionSet
from emulator.people.workers import WorkerEffect
from emulator.synthetic.tasks import make
from tests.emulator.fitted import made, motions_of

GAUSSIAN = SCHEMES[-1]
"""Fitted in a third of the time, for what no density changes."""


@pytest.fixture(scope="module")
def emulator():
    return made("lift")[1]


def rng(seed=0):
    return np.random.default_rng(seed)


def test_the_same_generator_gives_the_same_bytes(emulator):
    one, two = (emulator.sample(64, rng(9)) for _ in range(2))
    for name in ("duration_s", "mark_s", "scores"):
        assert getattr(one, name).tobytes() == getattr(two, name).tobytes()
    assert one.positions_m(n_times=5).tobytes() == two.positions_m(n_times=5).tobytes()


def test_the_within_worker_numbers_come_first_whoever_performs(emulator):
    drawn = [replace(emulator.draw_worker(rng(seed)), like="") for seed in (3, 4)]
    one, two = (emulator.sample(8, rng(1), worker=effect).scores - effect.z for effect in drawn)
    assert np.allclose(one, two, atol=1e-12)


def test_drawing_takes_the_same_numbers_whatever_the_worker(emulator):
    states = []
    for name in ("w1", "w4"):
        generator = rng(2)
        emulator.sample(64, generator, worker=name)
        states.append(generator.bit_generator.state["state"]["state"])
    assert states[0] == states[1]


def test_the_mean_duration_is_that_of_many_draws(emulator):
    for worker in (None, "w2", emulator.draw_worker(rng(5))):
        duration_s = emulator.sample(20_000, rng(3), worker=worker).duration_s
        error = duration_s.std() / np.sqrt(20_000)
        assert abs(duration_s.mean() - emulator.mean_duration_s(worker)) < 4 * error
        assert np.isclose(duration_s.std() / duration_s.mean(), emulator.duration_cv(worker), rtol=0.03)


def test_known_workers_differ_as_their_recordings_do(emulator):
    motions = motions_of("lift")
    recorded = [motions.duration_s[motions.worker_index == w].mean() for w in range(5)]
    emulated = [emulator.mean_duration_s(name) for name in motions.workers]
    assert np.corrcoef(recorded, emulated)[0, 1] > 0.98
    assert np.std(emulated) < np.std(recorded)


def test_one_worker_varies_less_than_the_population(emulator):
    assert emulator.duration_cv("w1") < emulator.duration_cv()


def test_a_given_duration_is_met_and_the_rest_follows(emulator):
    drawn = emulator.sample(2000, rng(), condition={"duration_s": 5.0})
    assert np.allclose(drawn.duration_s, 5.0)
    free = emulator.sample(40_000, rng(1))
    near = np.abs(np.log(free.duration_s / 5.0)) < 0.03
    assert near.sum() > 100
    apart = np.abs(drawn.scores.mean(0) - free.scores[near].mean(0)) / free.scores.std(0)
    assert apart.max() < 0.2  # four standard errors of 516 draws


def test_a_shift_moves_log_duration_by_just_that_and_nothing_at_zero(emulator):
    plain = emulator.sample(64, rng(4), worker="w1")
    shifted = emulator.sample(64, rng(4), worker="w1", condition={"log_duration_shift": 0.1})
    assert np.allclose(shifted.duration_s / plain.duration_s, np.exp(0.1))
    assert not np.allclose(shifted.scores[:, 0], plain.scores[:, 0])
    same = emulator.sample(64, rng(4), worker="w1", condition={"log_duration_shift": 0.0})
    assert np.allclose(same.scores, plain.scores, atol=1e-12)


CHAIN = ("left_ankle", "left_knee", "spine", "chest", "neck", "head")


def chain_m(model, effect):
    """From the ankles to the head of a worker."""
    length = dict(zip(model.skeleton.bone_names, model.performances(effect.z[None], effect.scale).bone_length_m[0]))
    return sum(length[name] for name in CHAIN)


def test_where_nobody_was_measured_a_height_is_kept_from_the_ankles_to_the_head():
    bare = [replace(motion, covariates={}) for motion in motions_of("lift").motions]
    model = MotionEmulator.fit(replace(motions_of("lift"), motions=tuple(bare)), n_times=21, n_knots=8, scheme=GAUSSIAN)
    for height_m in (1.5, 1.9):
        assert chain_m(model, model.new_worker(height_m=height_m)) == pytest.approx(height_m - 0.2)
        assert chain_m(model, model.draw_worker(rng(1), {"height_m": height_m})) == pytest.approx(height_m - 0.2)


def test_where_people_were_measured_a_height_has_the_bones_of_those_as_tall_and_beyond_them_in_proportion(emulator):
    heights = {motion.worker: motion.covariates["stature_m"] for motion in motions_of("lift").motions}
    for name, height_m in heights.items():
        own, asked = emulator.known_worker(name), emulator.new_worker(height_m=float(height_m))
        assert chain_m(emulator, asked) == pytest.approx(chain_m(emulator, own), rel=0.03)
    tallest = float(max(heights.values()))
    giant = emulator.new_worker(height_m=1.1 * tallest)
    assert chain_m(emulator, giant) == pytest.approx(1.1 * chain_m(emulator, emulator.new_worker(height_m=tallest)))


def test_recordings_of_one_person_have_no_worker_effect():
    motions = motions_of("lift")
    emulator = MotionEmulator.fit(motions.where("worker == w1"))
    assert emulator.draw_worker(rng()) is None
    assert np.isnan(emulator.report.icc)
    assert ("ICC of log duration", "not estimable") in emulator.report.rows()
    assert emulator.sample(3, rng()).positions_m(n_times=3).shape == (3, 3, 21, 3)


def test_a_task_without_marks_can_be_fitted():
    motions = motions_of("reach")
    from dataclasses import replace

    bare = MotionSet("bare", tuple(replace(m, mark_s=np.empty(0)) for m in motions.motions[:12]))
    assert MotionEmulator.fit(bare).sample(4, rng()).mark_s.shape == (4, 0)


def test_the_report_is_that_of_the_recordings(emulator):
    motions = motions_of("lift")
    report = emulator.report
    assert (report.n_sequences, report.n_workers) == (40, 5)
    assert np.isclose(report.duration_mean_s, motions.duration_s.mean())
    assert np.isclose(report.duration_cv, motions.duration_s.std(ddof=1) / motions.duration_s.mean())
    assert report.icc_low < report.icc < report.icc_high
    assert 0.98 <= report.explained_variance < 1
    assert 0.5 < report.roughness_ratio < 1.5
    assert 0.4 < report.novelty_ratio < 2.0
    assert 0 < report.reconstruction_deg < 1.5


@pytest.mark.slow
def test_more_components_reconstruct_better():
    motions = motions_of("lift")
    few, many = (MotionEmulator.fit(motions, n_components=n).report for n in (2, 10))
    assert (few.n_components, many.n_components) == (2, 10)
    assert many.reconstruction_deg < few.reconstruction_deg
    assert many.explained_variance > few.explained_variance


def test_fitting_reports_its_progress():
    seen = []
    heard = {"progress": lambda done, total, label: seen.append((done, total))}
    MotionEmulator.fit(make("reach", 2, 3)[0], scheme=GAUSSIAN, **heard)
    assert seen
    assert all(0 <= done <= total for done, total in seen)


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        ({"scheme": "SIEM/JointPCA/VAR"}, "scheme"),
        ({"n_knots": 1}, "n_knots"),
        ({"n_times": 3}, "n_times"),
        ({"n_components": 1000}, "n_components"),
    ],
)
def test_settings_that_make_no_sense_are_refused(settings, word):
    with pytest.raises(ValueError, match=word):
        MotionEmulator.fit(motions_of("reach"), **settings)


def test_two_repetitions_are_too_few():
    with pytest.raises(ValueError, match="at least 3"):
        MotionEmulator.fit(motions_of("reach").subset([0, 1]))


def test_an_unknown_worker_is_answered_with_the_nearest(emulator):
    with pytest.raises(ValueError, match="no worker 'w11'; did you mean 'w1'"):
        emulator.sample(1, rng(), worker="w11")


def test_an_unknown_condition_is_refused(emulator):
    with pytest.raises(ValueError, match="no 'durations'; did you mean 'duration_s'"):
        emulator.sample(1, rng(), condition={"durations": 1.1})


def test_all_mistakes_of_a_condition_are_named_at_once(emulator):
    wrong = {"duration_s": 0.0, "log_duration_shift": np.nan, "pace": -1.0}
    with pytest.raises(ValueError, match=r"positive seconds\n.*a finite number\n.*a positive ratio"):
        emulator.sample(1, rng(), condition=wrong)


def test_a_pace_is_the_shift_that_makes_everything_that_much_shorter(emulator):
    plain, fast = (emulator.sample(64, rng(4), condition=c) for c in (None, {"pace": 1.25}))
    assert np.allclose(plain.duration_s / fast.duration_s, 1.25)


def test_an_effect_of_another_emulator_is_refused(emulator):
    with pytest.raises(ValueError, match="not drawn from this emulator"):
        emulator.sample(1, rng(), worker=WorkerEffect(np.zeros(2)))


def test_a_block_of_times_is_drawn_within_a_millisecond(emulator):
    worker, generator, best = emulator.known_worker("w1"), rng(), np.inf
    for _ in range(200):
        start = time.perf_counter()
        emulator.sample(64, generator, worker=worker)
        best = min(best, time.perf_counter() - start)
    assert best < 1e-3
