"""Skeletons that lack joints: which scores remain is said, of the tasks whose they are."""

from dataclasses import replace
from types import SimpleNamespace

import plans
import pytest

from opsim.ergonomics.angles import CANONICAL
from opsim.plan.model_warnings import lacking, unseen

CELL = """
opsim: 1
name: joints
run: {horizon: 1 h}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks: {make: {emulator: work/fasten}, bake: {fixed: 9 s, automatic: true}, look: {fixed: 9 s}}
stations: {s1: {at: a, tasks: [make, look, bake]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {skills: {s1: 1}}}
"""


@pytest.fixture(scope="module")
def plan():
    return plans.plan(CELL)


def without(plan, *gone):
    """The plan with bodies that lack some joints."""
    names = [joint for joint in CANONICAL if joint not in gone]
    model = SimpleNamespace(skeleton=SimpleNamespace(names=names))
    return replace(plan, tasks=tuple(replace(t, model=model) if t.name == "make" else t for t in plan.tasks))


def test_whole_bodies_and_times_without_one_need_no_word(plan):
    assert list(unseen(plan, ["rula_mean"])) == []


def test_what_is_missing_is_said_with_the_scores_that_become_wider(plan):
    (head,) = unseen(without(plan, "head"), ["rula_mean"])
    assert head.startswith("make: no head: the neck is not known, so RULA and REBA are wider")
    (wrists,) = unseen(without(plan, "left_wrist", "right_wrist"), ["reba_p90"])
    assert wrists.startswith("make: no wrists: how far elbow and wrist are bent is not known")


def test_nobody_is_warned_of_scores_he_does_not_ask_for(plan):
    assert list(unseen(without(plan, "head"), ["walked_m"])) == []


def test_tasks_of_the_same_skeleton_share_a_sentence(plan):
    blind = without(plan, "head").tasks
    both = [task for task in blind if task.name == "make"] * 2
    assert list(lacking(both).values()) == [["make", "make"]]
