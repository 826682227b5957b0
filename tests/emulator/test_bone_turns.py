"""Bones of new people point a few degrees another way throughout: how much is learnt, and what stays as it is."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.model.emulator import MotionEmulator
from emulator.model.library import LibraryError
from emulator.model.performances import turned
from emulator.people.bone_turns import MIRRORED, SHARE, BoneTurns
from emulator.skeleton import standard_skeleton
from tests.emulator.fitted import made
from tests.emulator.test_library import with_header


@pytest.fixture(scope="module")
def emulator():
    return made("lift")[1]


def people_turned(spread_rad, alike, n_people, seed):
    """Two repetitions each of n people, all bones of whom point as one body's do, turned: (directions, worker)."""
    skeleton, rng = standard_skeleton(), np.random.default_rng(seed)
    unit = rng.standard_normal((n_people, skeleton.n_bones, 3))
    for left, right in enumerate(skeleton.other_side):
        if left < right:
            unit[:, right] = alike * MIRRORED * unit[:, left] + np.sqrt(1 - alike**2) * unit[:, right]
    body = sphere.normalise(rng.standard_normal((skeleton.n_bones, 3)))
    for left, right in enumerate(skeleton.other_side):
        if left < right:
            body[right] = body[left] * -MIRRORED
    return np.repeat(sphere.turned(body, spread_rad * unit), 2, axis=0), np.repeat(np.arange(n_people), 2)


@pytest.mark.parametrize("alike", [0.0, 0.8])
def test_how_much_people_differ_and_how_alike_their_sides_are_is_found_again(alike):
    """3 degrees of 40 people to a tenth; of three people on the average of 60 crews."""
    skeleton = standard_skeleton()
    many = BoneTurns.fit(*people_turned(np.radians(3), alike, 40, 0), np.zeros(40, int), skeleton)
    assert np.degrees(many.spread_rad) == pytest.approx(3, rel=0.1)
    assert many.alike == pytest.approx(alike, abs=0.1)
    few = [BoneTurns.fit(*people_turned(np.radians(3), alike, 3, 1 + k), np.zeros(3, int), skeleton) for k in range(60)]
    assert np.degrees(np.mean([one.spread_rad for one in few])) == pytest.approx(3, rel=0.1)


def test_drawn_turns_have_the_spread_and_the_sides_that_were_asked_for():
    skeleton, law = standard_skeleton(), BoneTurns(0.1, 0.6, 0.8)
    drawn = law.drawn(4000, np.array([1.0]), skeleton, np.array([0]))
    paired = np.array([one != other for one, other in enumerate(skeleton.other_side)])
    assert drawn.std(axis=0)[paired] == pytest.approx(SHARE * 0.1, rel=0.06)
    leaning, bending = SHARE * 0.1 * np.sqrt([1 - 0.8, 1 + 0.8])
    expected = np.broadcast_to([leaning, bending, leaning], (np.sum(~paired), 3))
    assert drawn.std(axis=0)[~paired] == pytest.approx(expected, rel=0.06)
    left, right = (skeleton.bone_names.index(f"{side}_knee") for side in ("left", "right"))
    hips = (drawn[:, skeleton.bone_names.index(f"{side}_hip")] for side in ("left", "right"))
    assert np.array_equal(next(hips) * MIRRORED, next(hips))
    for axis in range(3):
        together = np.corrcoef(MIRRORED[axis] * drawn[:, left, axis], drawn[:, right, axis])[0, 1]
        assert together == pytest.approx(0.6, abs=0.05)


def test_trunks_that_bend_and_do_not_lean_are_told_so():
    skeleton, rng = standard_skeleton(), np.random.default_rng(4)
    body = np.broadcast_to([0.0, 0.0, 1.0], (skeleton.n_bones, 3))
    by = 0.05 * rng.standard_normal((12, skeleton.n_bones, 3)) * [0.1, 1.0, 0.1]
    found = BoneTurns.fit(sphere.turned(body, by), np.arange(12), np.zeros(12, int), skeleton)
    assert found.upright == pytest.approx((1 - 0.01) / (1 + 0.01), abs=0.01)


def test_kinds_of_people_do_not_count_as_differences_between_people():
    directions, worker = people_turned(np.radians(3), 0.0, 8, 0)
    other = np.where((worker >= 4)[:, None, None], sphere.turned(directions, np.array([0.0, 1.0, 0.0])), directions)
    kinds = np.repeat([0, 1], 4)
    together, apart = (BoneTurns.fit(other, worker, kind, standard_skeleton()) for kind in (np.zeros(8, int), kinds))
    assert apart.spread_rad == pytest.approx(
        BoneTurns.fit(directions, worker, kinds, standard_skeleton()).spread_rad, rel=0.1
    )
    assert together.spread_rad > 3 * apart.spread_rad


def test_nothing_is_turned_where_everybody_is_alone_or_all_are_the_same():
    skeleton = standard_skeleton()
    directions, worker = people_turned(np.radians(3), 0.0, 2, 0)
    assert BoneTurns.fit(directions, worker, np.arange(2), skeleton).spread_rad == 0
    assert BoneTurns.fit(directions[[0, 0]], np.arange(2), np.zeros(2, int), skeleton).spread_rad == 0


def test_bones_are_turned_as_by_their_matrices():
    rng = np.random.default_rng(3)
    directions, turns = sphere.normalise(rng.standard_normal((4, 7, 5, 3))), rng.standard_normal((4, 5, 3))
    expected = np.einsum("nbij,nsbj->nsbi", sphere.matrices(turns), directions)
    assert np.allclose(turned(directions.copy(), turns), expected, atol=1e-14)
    assert np.array_equal(turned(directions.copy(), turns[:, :0]), directions)


def test_no_bone_is_any_faster_for_being_turned(emulator):
    """Without feet, which bend the legs: each bone goes as far from moment to moment as it did."""
    free = replace(emulator, footing=None)
    drawn = emulator.sample(20, np.random.default_rng(0))
    steps = [
        sphere.angle(one[:, 1:], one[:, :-1])
        for one in (free.performances(drawn.scores, 1.0, turns).directions() for turns in (None, drawn.turns))
    ]
    assert np.abs(drawn.turns).max() > np.radians(2)
    assert np.allclose(steps[0], steps[1], atol=1e-9)


def test_known_people_are_as_they_were_recorded_and_times_are_those_of_the_draw(emulator):
    known = emulator.sample(5, np.random.default_rng(0), worker=emulator.workers[0])
    assert known.turns.shape == (5, 0, 3) and emulator.known_worker(emulator.workers[0]).turns is None
    rng, other = np.random.default_rng(0), np.random.default_rng(0)
    new = emulator.sample(5, rng)
    assert np.array_equal(new.scores, emulator.law(None).sample(5, other)) and rng.random() == other.random()
    as_drawn = emulator.performances(new.scores)
    assert np.array_equal(new.duration_s, as_drawn.duration_s) and np.array_equal(new.mark_s, as_drawn.mark_s)
    assert not np.allclose(new.positions_m(), as_drawn.positions_m(), atol=1e-3)


def test_a_new_worker_is_turned_alike_in_every_performance_and_wherever_the_same_people_do_it(emulator):
    """As far as people differ there; others follow by how alike sides are in that task."""
    models = emulator, made("pick")[1]

    def leaning(name):
        return float(np.random.default_rng([7, *name.rsplit("/", 1)[-1].encode()]).standard_normal())

    one, two = (model.draw_worker(np.random.default_rng(k), people=leaning) for k, model in enumerate(models))
    unit = [drawn.turns / m.workforce.population.turns.spread_rad for drawn, m in zip((one, two), models)]
    left = [name.startswith("left_") for name in emulator.skeleton.bone_names]
    assert np.allclose(unit[0][left], unit[1][left])
    assert np.array_equal(emulator.sample(3, np.random.default_rng(5), worker=one).turns, np.stack([one.turns] * 3))
    assert not np.allclose(one.turns, emulator.draw_worker(np.random.default_rng(9)).turns)


def test_the_report_says_by_how_much_bones_are_turned(emulator):
    said, turns = emulator.report.methods["bones of new people"], emulator.workforce.population.turns
    assert said == turns.said and f"{np.degrees(SHARE * turns.spread_rad):.2g} degrees" in said
    assert BoneTurns().said == "point as the movement has them"


def test_turns_are_kept_in_a_library(emulator, tmp_path):
    emulator.save(tmp_path / "lift.npz")
    again = MotionEmulator.load(tmp_path / "lift.npz")
    assert again.workforce.population.turns == emulator.workforce.population.turns
    rows = [model.sample(4, np.random.default_rng(0)).positions_m() for model in (emulator, again)]
    assert np.array_equal(*rows)


@pytest.mark.parametrize("turns", [{"spread_rad": -1.0}, {"alike": 1.5}, {"alike": "very"}, {"width": 1.0}, [0.1]])
def test_turns_that_make_no_sense_are_refused(emulator, tmp_path, turns):
    emulator.save(tmp_path / "lift.npz")

    def with_turns(header):
        return header | {"tasks": {"lift": header["tasks"]["lift"] | {"turns": turns}}}

    with pytest.raises(LibraryError):
        MotionEmulator.load(with_header(tmp_path / "lift.npz", with_turns))
