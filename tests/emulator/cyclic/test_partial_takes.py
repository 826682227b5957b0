"""Walks of takes that begin or end in the middle of a step: the way asked is gone, in a time that is a number."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from emulator.cyclic.contacts import foot_skate_m
from emulator.cyclic.model import CyclicEmulator
from emulator.model.library import MotionLibrary
from emulator.synthetic.walking import make_walks

CUT_S = 1.2
KINDS = ((False, True), (True, False), (False, False), (True, True))
WAYS = (
    {"distance_m": 0.1},
    {"distance_m": 0.4},
    {"distance_m": 2.0},
    {"distance_m": 9.0, "speed_m_per_s": 1.6},
    {"distance_m": 3.0, "length_s": 3.0},
    {"cycles": 1},
    {"cycles": 4},
    {"length_s": 0.5},
    {"length_s": 4.0},
    None,
)


@lru_cache
def fitted(starts, stops):
    recording = make_walks(2, 3, seed=5, n_steps=(9, 10))[0]
    takes = []
    for take in recording.takes:
        cut = round(CUT_S * take.rate_hz)
        kept = slice(0 if starts else cut, take.n_frames - (0 if stops else cut))
        takes.append(replace(take, positions_m=take.positions_m[kept], contact=take.contact[kept]))
    return CyclicEmulator.fit(replace(recording, takes=tuple(takes)), points=60)


@pytest.mark.parametrize(("starts", "stops"), KINDS)
@pytest.mark.parametrize("condition", WAYS)
def test_the_way_is_gone_whether_or_not_takes_begin_and_end_standing(starts, stops, condition):
    model = fitted(starts, stops)
    assert (len(model.starts) > 0, len(model.stops) > 0) == (starts, stops)
    drawn = model.sample(3, np.random.default_rng(1), condition=condition)
    root = drawn.root_m(n_times=2)
    assert root[:, 0, 0] == pytest.approx(0.0, abs=1e-9)
    assert root[:, -1, 0] == pytest.approx(drawn.distance_m, abs=0.01)
    if "distance_m" in (condition or {}):
        assert drawn.distance_m == pytest.approx(condition["distance_m"], abs=0.01)
    mean_s = model.mean_duration_s(condition=condition)
    assert 0 < mean_s < 20 and np.all(np.isfinite(drawn.duration_s))


@pytest.mark.parametrize(("starts", "stops"), KINDS)
def test_a_cycle_is_two_steps_and_mean_time_is_distance_over_speed(starts, stops):
    model = fitted(starts, stops)
    beats = np.isfinite(model.sample(1, np.random.default_rng(0), condition={"cycles": 4}).beat_s).sum()
    assert beats == 8 + (not starts)
    many = model.sample(1000, np.random.default_rng(2), condition={"distance_m": 12.0, "speed_m_per_s": 1.2}).duration_s
    assert abs(many.mean() - 10.0) < 2.6 * many.std(ddof=1) / np.sqrt(len(many))


@pytest.mark.parametrize(("starts", "stops"), KINDS)
def test_steps_are_even_up_to_where_a_walk_begins_or_ends_in_the_middle(starts, stops):
    one = fitted(starts, stops).mean_performance(condition={"distance_m": 6.0})
    at = np.arange(0.0, one.duration_s[0], 1 / 60)
    positions, contact = one.positions_m(at)[0], one.contact(at)[0]
    assert foot_skate_m(positions, contact).max() < 1.5e-3
    prints = np.unique(
        np.concatenate(
            [
                np.round(positions[contact[:, k] & ~np.r_[False, contact[:-1, k]], one.skeleton.index(name), 0], 2)
                for k, name in enumerate(("left_ankle", "right_ankle"))
            ]
        )
    )
    inside = np.diff(prints)[1 if starts else 0 : -1]
    assert inside.max() / inside.min() < 1.35


def test_such_a_walk_is_kept_in_a_library(tmp_path):
    model = fitted(False, False)
    MotionLibrary.of(model).save(tmp_path / "a.npz")
    back = MotionLibrary.load(tmp_path / "a.npz")["walk"]
    assert back.sample(1, np.random.default_rng(1), condition={"distance_m": 0.4}).duration_s[0] > 0


def test_starts_that_take_no_time_are_refused():
    from emulator.cyclic.serialise import pack, unpack

    plain, arrays = pack(fitted(True, True))
    plain["pace"] = dict(plain["pace"], start_beats=0.0)
    with pytest.raises(ValueError, match="starts and stops"):
        unpack("walk", plain, {f"walk/{key}": array for key, array in arrays.items()})


def test_whether_it_is_walking_is_said_by_the_median_take_and_not_the_first():
    from emulator.cyclic.preparation import walks

    recording = make_walks(1, 3, seed=2)[0]
    stands = replace(recording.takes[0], positions_m=recording.takes[0].positions_m * [1e-3, 1e-3, 1.0])
    assert walks(replace(recording, takes=(stands, *recording.takes[1:])))
    assert not walks(replace(recording, takes=(recording.takes[0], stands, stands)))


def test_the_seed_of_the_figures_does_not_change_the_model():
    from emulator.cyclic.serialise import pack

    recording = make_walks(2, 3, seed=5, n_steps=(9, 10))[0]
    (one, some), (other, same) = map(pack, (fitted(True, True), CyclicEmulator.fit(recording, points=60, seed=3)))
    assert {k: v for k, v in one.items() if k != "report"} == {k: v for k, v in other.items() if k != "report"}
    assert all(np.array_equal(some[name], same[name]) for name in some)


def test_the_draws_that_choose_the_temper_have_a_seed_of_their_own(monkeypatch):
    from emulator.cyclic import fitting as judged

    asked = []
    drawn = judged._drawn
    monkeypatch.setattr(judged, "_drawn", lambda m, t, rng: asked.append(rng.random()) or drawn(m, t, rng))
    CyclicEmulator.fit(make_walks(1, 2, seed=1)[0], points=40, seed=9)
    first, last = np.random.default_rng(judged.TEMPERING_SEED).random(), np.random.default_rng(9).random()
    assert set(asked[:-1]) == {first} and asked[-1] == last
