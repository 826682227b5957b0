"""People who do a task with the other hand are of a kind of their own: known answers, and a made task."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.model.emulator import MotionEmulator
from emulator.model.library import MotionLibrary
from emulator.motion import Motion, MotionSet
from emulator.people.kinds import Kinds, kinds_of
from emulator.skeleton import Skeleton
from emulator.synthetic.tasks import make

RIGHT, LEFT, BOTH = (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)
"""How far left and right hand are lifted."""
SIDES = [
    ((RIGHT, RIGHT, LEFT, RIGHT), [0, 0, 1, 0]),
    ((LEFT, RIGHT, LEFT, RIGHT, RIGHT), [0, 1, 0, 1, 1]),
    ((BOTH, BOTH, RIGHT, LEFT), [0, 0, 0, 0]),  # those with both hands lie between
    ((BOTH, BOTH, BOTH), [0, 0, 0]),
    ((RIGHT, LEFT), [0, 0]),  # no two on one side
    ((RIGHT,), [0]),
]


def lifting(people, skeleton, size=1.0, luck=0.02):
    """One repetition each of people who lift the hands so far, forwards and outwards, one slower than the other."""
    rng, motions = np.random.default_rng(0), []
    for number, hands in enumerate(people):
        time_s = np.linspace(0.0, 1.0 + 0.1 * number, 20 + 3 * number)
        directions = np.tile([0.0, 0.0, -1.0], (len(time_s), skeleton.n_bones, 1))
        for bone, far, out in zip((0, 1), hands, (0.3, -0.3)):
            angle = size * far * np.linspace(0.0, 1.5, len(time_s))
            directions[:, bone] = np.stack([np.sin(angle), out * np.sin(angle), -np.cos(angle)], axis=1)
        directions = directions + luck * rng.normal(size=directions.shape)
        directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
        still, bones = np.zeros((len(time_s), 3)), np.ones(skeleton.n_bones)
        motions.append(Motion(skeleton, directions, time_s, still, still[:, 0], bones, np.zeros(0), f"w{number}", "r1"))
    return MotionSet("lifting", tuple(motions), (), "made", "CC0")


TWO_HANDS = Skeleton(("root", "left_hand", "right_hand"), (-1, 0, 0))


@pytest.mark.parametrize(("people", "kinds"), SIDES)
def test_people_are_of_one_kind_who_do_it_on_the_same_side_or_have_others_between_them(people, kinds):
    assert kinds_of(lifting(people, TWO_HANDS)).tolist() == kinds


def test_who_leans_a_little_to_the_other_side_or_has_no_sides_is_of_one_kind():
    """Leaning by a tenth of a degree, and by so much that sides would be found, in a trunk that has none."""
    for names, lean in ((TWO_HANDS.names, 0.002), (("root", "spine", "head"), 1.0)):
        assert not kinds_of(lifting((RIGHT, RIGHT, LEFT), Skeleton(names, (-1, 0, 0)), lean, luck=0.0)).any()


def test_means_of_kinds_are_apart_and_people_about_them_are_not():
    rng = np.random.default_rng(0)
    of, rows, differ = np.array([0, 1, 0, 1, 0, 2]), rng.normal(size=(6, 4)), np.array([True, True, True, False])
    kinds = Kinds.fit(of, rows, differ)
    for kind in range(3):
        assert np.allclose((rows - kinds.shift)[of == kind, :3].mean(axis=0), rows[:, :3].mean(axis=0))
    assert not kinds.shift[:, 3].any() and not Kinds.fit(np.zeros(6, int), rows, differ).shift.any()
    assert (kinds.n_free, kinds.df_lost.tolist(), kinds.n_not_alone.tolist()) == (4, [2, 2, 2, 0], [5, 5, 5, 6])


def mirrored(motion, skeleton):
    """The same movement by somebody who does it with the other hand."""
    other = {name: name.replace("left", "*").replace("right", "left").replace("*", "right") for name in skeleton.names}
    bones = [skeleton.bone_names.index(other[name]) for name in skeleton.bone_names]
    flip = np.array([1.0, -1.0, 1.0])
    return replace(
        motion,
        directions=motion.directions[:, bones] * flip,
        bone_length_m=motion.bone_length_m[bones],
        root_m=motion.root_m * flip,
        yaw_rad=-motion.yaw_rad,
    )


@pytest.fixture(scope="module")
def of_two_kinds():
    """Who reaches (six people, four repetitions each), two of them with the left hand, and the fit."""
    motions = make("reach", 6, 4, seed=4)[0]
    left = motions.workers[:2]
    some = [mirrored(m, motions.skeleton) if m.worker in left else m for m in motions.motions]
    motions = replace(motions, motions=tuple(some))
    return motions, MotionEmulator.fit(motions)


def lifted_m(performances):
    """(n, 2) how high left and right hand come."""
    hands = [performances.skeleton.names.index(f"{side}_wrist") for side in ("left", "right")]
    return performances.positions_m(n_times=41)[:, :, hands, 2].max(axis=1)


def test_new_people_do_it_with_one_hand_or_the_other(of_two_kinds, tmp_path):
    motions, model = of_two_kinds
    assert model.workforce.kinds.of.tolist() == [0, 0, 1, 1, 1, 1]
    assert any("2 sides" in note and ", ".join(motions.workers[:2]) in note for note in model.report.notes)
    left, right = lifted_m(model.sample(300, np.random.default_rng(0))).T
    known = np.concatenate([lifted_m(model.sample(20, np.random.default_rng(1), worker=w)) for w in motions.workers])
    least = np.abs(known[:, 0] - known[:, 1]).min()
    assert np.mean(np.abs(left - right) > 0.5 * least) > 0.95
    assert np.mean(left > right) == pytest.approx(2 / 6, abs=0.08)
    MotionLibrary.of(model).save(tmp_path / "hands.npz")
    again = MotionLibrary.load(tmp_path / "hands.npz")["reach"]
    drawn = (one.sample(5, np.random.default_rng(2)).scores for one in (model, again))
    assert np.array_equal(*drawn)


def test_a_new_worker_is_of_a_recorded_kind_at_any_pace(of_two_kinds):
    _, model = of_two_kinds
    for body in ({}, {"pace": 0.8}, {"height_m": 1.6, "pace": 1.2}):
        workers = [model.new_worker(np.random.default_rng(i), **body) for i in range(40)]
        heights = np.array(
            [lifted_m(model.sample(1, np.random.default_rng(i), worker=w))[0] for i, w in enumerate(workers)]
        )
        apart = np.abs(heights[:, 0] - heights[:, 1])
        assert np.mean(apart > 0.5 * np.median(apart)) > 0.82  # of 40; of a normal between two kinds .74


def test_of_one_repetition_each_there_is_one_gaussian_and_one_kind(of_two_kinds):
    motions = of_two_kinds[0]
    once = motions.subset([motions.worker_index.tolist().index(w) for w in range(len(motions.workers))])
    model = MotionEmulator.fit(once)
    assert not model.workforce.kinds.several and not any("sides" in note for note in model.report.notes)
