from types import SimpleNamespace

import numpy as np
import pytest
from plans import plan

from opsim.ergonomics.joint_loads import JOINTS
from opsim.human import muscle_fatigue as burden
from opsim.human.muscle_fatigue import DRAWS, PARTS, Burdens

CELL = """
opsim: 1
name: bench
run: {horizon: 1 h, seed: 4}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  empty: {emulator: work/stoop}
  laden: {emulator: work/stoop, load: 12 kg}
  later: {emulator: work/stoop, load: 12 kg, loaded: {from: 0.5, to: 1.0}}
  sits: {emulator: work/stoop, handling: {sitting: true, arms_supported: true}}
  reach: {emulator: work/reach}
  timed: {fixed: 10 s}
stations: {s: {at: a, tasks: [empty, laden, later, sits, reach, timed], buffer: 1}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {ana: {height: 1.62 m, mass: 58 kg, sex: f, skills: {s: 1.0}}, ben: {skills: {s: 1.0}}}
"""


@pytest.fixture(scope="module")
def made():
    return plan(CELL)


def rank(made, name):
    return [task.name for task in made.tasks].index(name)


def course(made, task, worker=0):
    return Burdens(made, 0).course(worker, rank(made, task))


def test_a_course_is_shares_of_strength(made):
    found = course(made, "laden")
    assert found.shape == (PARTS, len(JOINTS))
    assert found.min() >= 0.0 and found.max() <= 1.0
    assert course(made, "timed") is None


def test_a_load_asks_more_of_every_joint_of_the_arms_and_back(made):
    arms = [at for at, joint in enumerate(JOINTS) if joint != "knees"]
    assert course(made, "laden").mean(axis=0)[4] > 1.1 * course(made, "empty").mean(axis=0)[4]
    assert np.all(course(made, "laden").mean(axis=0)[arms[:4]] > course(made, "empty").mean(axis=0)[arms[:4]])


def test_a_load_that_is_taken_in_the_middle_asks_for_more_from_then_on(made):
    later, empty = course(made, "later"), course(made, "empty")
    assert np.allclose(later[: PARTS // 2, 2:4].sum(), course(made, "empty")[: PARTS // 2, 2:4].sum(), rtol=0.25)
    assert later[PARTS // 2 :, 4].mean() > empty[PARTS // 2 :, 4].mean()


def test_what_something_else_carries_is_asked_of_nobody(made):
    found = dict(zip(JOINTS, course(made, "sits").T))
    assert not any(found[joint].any() for joint in JOINTS if joint != "back")
    assert found["back"].any()


def test_a_stoop_is_heavier_than_a_reach_and_a_task_nobody_saw_is_like_the_mean(made):
    burdens = Burdens(made, 0)
    heaviness = {task.name: burdens.heaviness(0, at) for at, task in enumerate(made.tasks)}
    assert heaviness["laden"] > heaviness["empty"] > heaviness["reach"]
    assert heaviness["timed"] == 1.0
    seen = [value for name, value in heaviness.items() if name != "timed"]
    assert np.mean(seen) == pytest.approx(1.0)


def test_the_same_people_have_the_same_burdens_and_others_others(made):
    assert np.array_equal(course(made, "reach"), course(made, "reach"))
    assert not np.array_equal(course(made, "reach"), Burdens(made, 1).course(0, rank(made, "reach")))
    assert not np.array_equal(course(made, "reach"), course(made, "reach", worker=1))


def test_a_burden_is_drawn_once_a_process(made, monkeypatch):
    Burdens(made, 0).course(0, rank(made, "reach"))
    monkeypatch.setattr(burden, "_drawn", lambda *_: pytest.fail("drawn again"))
    Burdens(made, 0).course(0, rank(made, "reach"))


def test_models_that_cannot_be_kept_are_drawn_again(made):
    class Slotted:
        __slots__ = ()
        __hash__ = None

        def draw_worker(self, _rng, _body=None):
            return None

        def sample(self, n, _rng, *, worker=None, condition=None):
            assert n == DRAWS and worker is None and condition is None
            return SimpleNamespace(duration_s=np.ones(n), skeleton=None)

    task = SimpleNamespace(name="x", model=Slotted(), handling=None)
    person = SimpleNamespace(name="ana", body=None)
    alone = SimpleNamespace(seed=1, across_tasks="as_recorded", workers=[person], tasks=[task])
    assert Burdens(alone, 0).course(0, 0) is None
