from functools import cache

import numpy as np
import pytest

from emulator.covariates.body import BodyError
from emulator.model.emulator import MotionEmulator
from emulator.synthetic.tasks import make
from tests.emulator.fitted import made


@pytest.fixture(scope="module")
def emulator():
    return made("lift")[1]


def rng(seed=0):
    return np.random.default_rng(seed)


def numbers(seed):
    """A worker's number for each recorded person, the same whoever asks."""
    return lambda name: float(np.random.default_rng([seed, *name.encode()]).standard_normal())


def median_moving_s(emulator, effect):
    at = emulator.scale.block("duration").start
    raw = emulator.scale.centre[at] + emulator.scale.spread[at] * effect.z[at]
    return float(np.exp(emulator.margin.inverse(np.array([raw])))[0])


def test_numbers_for_people_draw_the_same_law_as_numbers_of_their_own(emulator):
    """To a fifth of a standard deviation: who leans farthest to somebody is also like that one."""
    between = emulator.workforce.between
    assert np.allclose(emulator.workforce.by_person.T @ emulator.workforce.by_person, np.eye(len(between.factor)))
    given, own = (
        np.stack([emulator.draw_worker(rng(i), None, people(i)).z for i in range(1500)])
        for people in (numbers, lambda i: None)
    )
    varies = between.spread > 0.1
    for share in (0.05, 0.25, 0.5, 0.75, 0.95):
        apart = (np.quantile(given, share, axis=0) - np.quantile(own, share, axis=0))[varies] / between.spread[varies]
        assert np.median(np.abs(apart)) < 0.2


def test_new_people_spread_as_the_next_of_so_few_does(emulator):
    """Five people: a t with 4 degrees of freedom and sqrt(1 + 1/5), beside the normal's 0.674 and 1.645."""
    at, between = emulator.scale.block("duration").start, emulator.workforce.between
    off = np.array([emulator.draw_worker(rng(i)).z[at] for i in range(1500)]) - between.mean[at]
    middle, most = np.quantile(np.abs(off) / between.spread[at], [0.5, 0.9])
    assert middle == pytest.approx(0.741 * np.sqrt(1.2), rel=0.2)
    assert most == pytest.approx(2.132 * np.sqrt(1.2), rel=0.2)


def test_who_leans_to_one_person_is_drawn_towards_him(emulator):
    crew = emulator.workforce
    for number, name in enumerate(crew.names):
        drawn = np.mean(
            [emulator.draw_worker(rng(i), None, lambda n, me=name: 2.0 * n.endswith(f"/{me}")).z for i in range(200)], 0
        )
        way = drawn - crew.between.mean
        likeness = (crew.effects - crew.effects.mean(axis=0)) @ way
        assert int(np.argmax(likeness)) == number


@cache
def two_tasks():
    """Two tasks done by the same twelve people, whose pace is theirs in both."""
    z = []
    for task in ("pick", "place"):
        z.append(MotionEmulator.fit(make(task, 12, 4, seed=7, between_share=0.9)[0], n_times=21, n_knots=8))
    return z


@pytest.mark.slow
def test_effects_of_two_tasks_agree_as_the_people_of_both_do():
    """The correlation of drawn effects is that of the recorded people's, by the shrinkage given up; else it is 0."""
    one, two = two_tasks()
    at = [e.scale.block("duration").start for e in (one, two)]
    recorded = np.corrcoef(one.workforce.effects[:, at[0]], two.workforce.effects[:, at[1]])[0, 1]
    pairs = [
        [e.draw_worker(rng(i + 9 * k), None, numbers(i)).z[a] for k, (e, a) in enumerate(zip((one, two), at))]
        for i in range(1500)
    ]
    apart = [[e.draw_worker(rng(2 * i + k)).z[a] for k, (e, a) in enumerate(zip((one, two), at))] for i in range(1500)]
    kept = 1 - one.workforce.between.rho
    assert abs(recorded) > 0.3
    assert np.corrcoef(np.array(pairs).T)[0, 1] == pytest.approx(kept * recorded, abs=0.08)
    assert abs(np.corrcoef(np.array(apart).T)[0, 1]) < 0.08


@pytest.mark.parametrize("pace", [0.8, 1.1, 1.5])
@pytest.mark.parametrize("luck", [None, 3])
def test_a_pace_is_kept_exactly_whoever_is_drawn(emulator, pace, luck):
    usual = median_moving_s(emulator, emulator.new_worker())
    asked = emulator.new_worker(None if luck is None else rng(luck), pace=pace)
    assert median_moving_s(emulator, asked) == pytest.approx(usual / pace, rel=1e-9)


def test_the_posture_goes_with_the_pace(emulator):
    slow, fast = (emulator.new_worker(pace=p).z for p in (0.8, 1.25))
    at = emulator.scale.block("duration").start
    expected = (
        emulator.workforce.between.covariance_with(at) * (fast - slow)[at] / emulator.workforce.between.spread[at] ** 2
    )
    assert np.allclose(np.delete(fast - slow, at), np.delete(expected, at))


def test_without_luck_a_new_worker_is_the_typical_one(emulator):
    assert np.array_equal(emulator.new_worker().z, emulator.workforce.between.mean)
    assert emulator.new_worker(height_m=1.9).scale > emulator.new_worker(height_m=1.5).scale


def test_a_recorded_person_is_drawn_as_surely_as_his_repetitions_tell(emulator):
    crew = emulator.workforce
    drawn = np.stack([emulator.draw_worker(rng(i), {"person": "w2"}).z for i in range(1000)])
    number = crew.names.index("w2")
    assert np.allclose(drawn.std(axis=0), crew.doubt[number], rtol=0.15)
    assert np.all(np.abs(drawn.mean(axis=0) - crew.effects[number]) <= 4 * crew.doubt[number] / np.sqrt(1000) + 1e-12)
    at = emulator.scale.block("duration").start
    assert 0 < crew.doubt[number][at] < 0.6 * crew.between.spread[at]


def test_a_recorded_person_may_be_asked_for_at_a_pace_of_his_own(emulator):
    plain, fast = (emulator.draw_worker(rng(), {"person": "w2", "pace": p}) for p in (None, 1.25))
    assert plain.name == fast.name == "w2"
    shape = emulator.sample(64, rng(1), worker=plain).duration_s / emulator.sample(64, rng(1), worker=fast).duration_s
    assert np.allclose(shape, 1.25)


def test_a_person_whom_the_task_does_not_know_is_a_new_one(emulator):
    somebody = emulator.draw_worker(rng(5), {"person": "s99"})
    assert somebody.name == "" and np.array_equal(somebody.z, emulator.draw_worker(rng(5)).z)


def test_only_what_changes_something_is_read(emulator):
    assert emulator.body_keys == ("height_m", "pace", "person")


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"height_m": 162}, "height_m: found 162, expected 0.9 to 2.4 .metres.; did you mean 1.62"),
        ({"heigth_m": 1.62}, "no 'heigth_m'; did you mean 'height_m'"),
        ({"pace": 0.0, "age_years": 200}, "age_years: found 200.*\n.*pace: found 0"),
    ],
)
def test_a_body_that_cannot_be_is_refused_with_all_its_mistakes(emulator, body, words):
    with pytest.raises(BodyError, match=words):
        emulator.new_worker(rng(), **body)


def test_a_person_asked_for_by_name_is_that_one_or_refused(emulator):
    assert np.array_equal(emulator.new_worker(person="w2").z, emulator.known_worker("w2").z)
    assert emulator.new_worker(rng(), person="w2").name == "w2"
    with pytest.raises(ValueError, match="no worker 'w22'; did you mean 'w2'"):
        emulator.new_worker(person="w22")


@pytest.mark.parametrize("body", [3, "tall", [1.7]])
def test_what_is_no_body_is_refused(emulator, body):
    with pytest.raises(BodyError, match="expected a mapping or something with any of height_m"):
        emulator.draw_worker(rng(), body)


def test_luck_that_is_no_number_is_refused(emulator):
    with pytest.raises(BodyError, match="slowness: found nan"):
        emulator.draw_worker(rng(), None, None, float("nan"))
    with pytest.raises(BodyError, match=r"people: found .nan"):
        emulator.draw_worker(rng(), None, lambda name: float("nan"))
    with pytest.raises(BodyError, match="expected a numpy Generator; a body goes by names"):
        emulator.new_worker({"height_m": 1.7})


@pytest.mark.parametrize("slowness", [-1.5, 0.0, 2.0])
def test_slowness_is_kept_in_standard_deviations_whatever_the_luck(emulator, slowness):
    at, between = emulator.scale.block("duration").start, emulator.workforce.between
    for seed in range(3):
        z = emulator.draw_worker(rng(seed), None, numbers(seed), slowness).z
        assert z[at] == pytest.approx(between.mean[at] + slowness * between.spread[at])


def test_slowness_by_luck_is_the_law_of_any_worker(emulator):
    between = emulator.workforce.between
    slow = rng(1).standard_normal(1500)
    drawn = np.stack([emulator.draw_worker(rng(i), None, None, float(s)).z for i, s in enumerate(slow)])
    at, varies = emulator.scale.block("duration").start, between.spread > 0.1
    assert drawn[:, at].std() == pytest.approx(between.spread[at], rel=0.05)
    assert 0.6 < np.median(drawn.std(axis=0)[varies] / between.spread[varies]) < 1.6


def test_a_pace_that_is_asked_for_goes_before_slowness(emulator):
    one, other = (emulator.draw_worker(rng(4), {"pace": 1.2}, None, s) for s in (None, 2.0))
    assert np.array_equal(one.z, other.z)
