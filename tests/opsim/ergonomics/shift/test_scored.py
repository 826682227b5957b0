"""Each frame is scored with what the scenario says of its own task."""

from dataclasses import replace

import numpy as np
import pytest

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.scores.scoring import NOTHING_OPEN, WALKING, bounds_of, score
from opsim.ergonomics.shift.day import fold, said_of, scored
from opsim.ergonomics.shift.frames import STANDING, WAITING, Frames
from opsim.ergonomics.shift.frames import WALKING as WALKS
from opsim.plan.tasks import Handling
from tests.opsim.ergonomics.made_work import BEND, COUNT, made_plan
from tests.opsim.kpi.made_logs import made, work

HEAVY = Handling(load_kg=25.0, force="static", grip="poor", forearm="mid", arms_supported=False, sitting=False)
SAID = replace(HEAVY, legs="balanced", rapid=False)


def plan():
    of = made_plan()
    return replace(of, tasks=(replace(of.tasks[BEND], handling=SAID), *of.tasks[1:]))


def frames(tasks, flexion, **flags):
    n = len(tasks)
    measures = np.tile(STANDING, (n, 1))
    measures[:, AT["trunk_flexion"]] = flexion
    measures[np.isnan(flexion)] = np.nan
    marks = {name: np.asarray(flags.get(name, np.zeros(n)), bool) for name in ("carrying", "repeated", "static")}
    whole, ranks = np.arange(n), np.asarray(tasks, np.int32)
    return Frames(
        0, whole * 1.0, np.ones(n), ranks, ranks, ranks, whole, whole, whole * 0.1, **marks, measures=measures
    )


def test_each_task_s_frames_are_scored_by_what_is_said_of_it_whatever_stands_between():
    tasks = [BEND, COUNT, WALKS, BEND, WAITING, COUNT]
    some = frames(tasks, [70.0, 70, 10, 30, 0, 10], carrying=[1, 1, 1, 0, 0, 1], repeated=[1, 0, 0, 0, 0, 0])
    found, of = scored(some, plan()), plan()
    for at, task in enumerate(tasks):
        flags = (some.repeated[at], some.static[at], some.carrying[at])
        alone = score(some.measures[at : at + 1], said_of(task, of), of.ergonomics, *flags)
        for name in ("rula", "reba", "owas"):
            assert np.array_equal(getattr(found, name)[at], getattr(alone, name)[0])


def test_what_nobody_knows_scores_nothing():
    found = scored(frames([BEND, COUNT], [np.nan, 5.0]), plan())
    assert not found.rula[0].any() and not found.reba[0].any() and not found.owas[0].any() and found.rula[1].all()


def test_a_load_that_is_said_leaves_nothing_open_and_one_that_is_not_does():
    found = scored(frames([BEND, COUNT], [70.0, 70.0], carrying=[1, 1]), plan())
    assert found.rula[0, 0] == found.rula[0, 1] and found.rula[1, 0] < found.rula[1, 1]


def test_who_waits_stands_and_who_walks_walks():
    of = plan()
    assert said_of(WAITING, of) == NOTHING_OPEN and said_of(BEND, of) == bounds_of(SAID)
    assert said_of(WALKS, of).empty_handed() == WALKING.empty_handed()


def test_every_fold_sees_the_same_stretches_once():
    class Seen:
        def __init__(self):
            self.stretches = []

        def add(self, frames, scores):
            self.stretches.append((frames.worker, len(frames), len(scores.rula)))

    of, folds = made_plan(horizon_s=7200.0), [Seen(), Seen()]
    rows = [work(at, at + 9, 0, worker=worker, k=at // 3600, task=BEND) for worker in (0, 1) for at in (0, 3600)]
    fold(made(rows, of), of, folds)
    assert folds[0].stretches == folds[1].stretches == [(w, 108, 108) for w in (0, 0, 1, 1)]


@pytest.mark.parametrize("name", ["rula", "reba", "owas"])
def test_somebody_who_stands_upright_is_at_the_least(name):
    """RULA 2 and not 1, as a straight elbow is a lower arm of 2."""
    found = scored(frames([WAITING], [0.0]), plan())
    assert getattr(found, name)[0].tolist() == [2 if name == "rula" else 1] * 2 and len(STANDING) == len(COLUMNS)
