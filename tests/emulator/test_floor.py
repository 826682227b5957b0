"""Feet and floor of recordings: none, one, a slope, a step."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.fitting.preprocessing import floor_notes
from emulator.motion import motion_from_positions
from emulator.skeleton import Skeleton
from emulator.synthetic.tasks import make

LIFTS = make("lift", 3, 6, seed=2)[0]
SKELETON = LIFTS.skeleton


def moved(change):
    """The lifts with their places (T, J, 3) in the room changed, each standing elsewhere on 3 by 3 metres."""
    rng = np.random.default_rng(5)
    motions = []
    for motion in LIFTS.motions:
        places = motion.positions_m(world=True) + np.append(rng.uniform(-1.5, 1.5, 2), 0.0)
        rate_hz = (len(places) - 1) / motion.duration_s
        said = {"worker": motion.worker, "trial": motion.trial}
        motions.append(motion_from_positions(SKELETON, change(places), rate_hz, mark_s=motion.mark_s, **said))
    return motions


def sloping(degrees, heading=0.0):
    pitch, turn = np.radians(degrees), np.radians(heading)
    up = np.array([[np.cos(pitch), 0, -np.sin(pitch)], [0, 1, 0], [np.sin(pitch), 0, np.cos(pitch)]])
    round_z = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    return lambda places: places @ (round_z @ up @ round_z.T).T


def without(*words):
    names, parents = SKELETON.names, SKELETON.parents
    keep = [i for i, name in enumerate(names) if not any(word in name for word in words)]
    short = Skeleton(tuple(names[i] for i in keep), tuple(keep.index(parents[i]) if i else -1 for i in keep))
    said = ((m, m.positions_m(world=True)[:, keep]) for m in LIFTS.motions)
    return [motion_from_positions(short, p, 50.0, worker=m.worker, trial=m.trial) for m, p in said]


def test_a_level_floor_is_not_spoken_of():
    assert floor_notes(LIFTS.motions) == []
    assert floor_notes(moved(lambda places: places)) == []


@pytest.mark.parametrize("degrees", [0.5, 1.5])
def test_a_floor_that_slopes_by_less_than_two_degrees_is_level(degrees):
    assert floor_notes(moved(sloping(degrees))) == []


@pytest.mark.parametrize(("degrees", "heading"), [(4, 0), (6, 60), (10, -120)])
def test_a_floor_that_slopes_is_told_with_degrees_and_heading(degrees, heading):
    (note,) = floor_notes(moved(sloping(degrees, heading)))
    words = note.split()
    told, towards = float(words[words.index("by", 8) + 1]), float(words[words.index("towards") + 1])
    assert told == pytest.approx(degrees, abs=0.7)
    assert abs((towards - heading + 180) % 360 - 180) < 12


def test_one_height_for_each_person_is_no_slope():
    shoes = {"w1": 0.0, "w2": 0.05, "w3": 0.1}
    motions = moved(lambda places: places)
    raised = [replace(m, root_m=m.root_m + np.array([0, 0, shoes[m.worker]])) for m in motions]
    raised = [replace(m, start_m=m.start_m + 3 * shoes[m.worker]) for m in raised]
    assert floor_notes(raised) == []


def test_feet_that_rest_on_a_step_are_told_with_the_time():
    motion = LIFTS.motions[0]
    n = len(motion.time_s)
    still = np.zeros(n, int)
    way = motion.root_m[still]
    way[n // 2 :, 2] += 0.3
    stands = replace(motion, directions=motion.directions[still], root_m=way, yaw_rad=motion.yaw_rad[still])
    (note,) = floor_notes([stands, *LIFTS.motions[1:]])
    assert note.startswith("both feet rest above the floor, on a step or held up: w1/r1 at ")
    assert note.endswith("(0.30 m)")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("ankle", "toe"), "no feet in the recordings"),
        (("left_ankle", "left_toe"), "no left foot in the recordings"),
        (("right_ankle", "right_toe"), "no right foot in the recordings"),
    ],
)
def test_feet_that_are_not_there_are_told(words, said):
    (note,) = floor_notes(without(*words))
    assert note.startswith(said)
