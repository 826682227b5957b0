"""The fold that counts what is held, and what moves."""

import numpy as np

from opsim.ergonomics.strain.posture_limits import ZONED, Still
from opsim.ergonomics.strain.static_holds import REGIONS
from tests.opsim.ergonomics.made_frames import made_frames

TRUNK = list(REGIONS).index("trunk")


def told(*stretches, n_workers=1):
    fold = Still(n_workers)
    for frames in stretches:
        fold.add(frames)
    return fold, fold.close()


def test_a_hold_over_two_stretches_is_one_with_its_mean_angle():
    """6 s at 30 degrees and 2 s at 38: (6 x 30 + 2 x 38) / 8 = 32 degrees."""
    first, second = made_frames(6, trunk_flexion=30.0), made_frames(2, start_s=6.0, trunk_flexion=38.0)
    fold, runs = told(first, second)
    trunk = runs["trunk"]
    assert (trunk.start_s.tolist(), trunk.seconds.tolist(), trunk.angle_deg.tolist()) == ([0.0], [8.0], [32.0])
    assert fold.held_s[0, TRUNK] == 8.0


def test_four_seconds_are_not_yet_held_and_another_worker_starts_anew():
    assert told(made_frames(4, trunk_flexion=30.0))[1]["trunk"].seconds.size == 0
    two = made_frames(3, worker=0, trunk_flexion=30.0), made_frames(3, worker=1, start_s=3.0, trunk_flexion=30.0)
    assert told(*two, n_workers=2)[1]["trunk"].seconds.size == 0


def test_the_head_is_trunk_and_neck_together():
    """15 + 15 degrees: neither trunk nor neck is out of neutral, the head is."""
    fold, runs = told(made_frames(10, trunk_flexion=15.0, neck_flexion=15.0))
    assert fold.held_s[0].tolist() == [0.0, 0.0, 0.0, 0.0, 10.0]
    assert runs["head"].angle_deg.tolist() == [30.0]


def test_a_held_stoop_is_not_accepted_beyond_60_degrees():
    fold, _ = told(made_frames(10, trunk_flexion=61.0))
    assert fold.not_acceptable_s[0, ZONED.index("trunk")] == 10.0
    assert told(made_frames(10, trunk_flexion=50.0))[0].not_acceptable_s[0, ZONED.index("trunk")] == 0.0


def test_what_goes_on_over_an_hour_is_one_movement():
    """Bent by 30 degrees from 3590 s to 3610 s, in two stretches: one movement, of trunk and of an arm."""
    bent = {"trunk_flexion": 30.0, "left_arm_elevation": 30.0, "left_arm_flexion": 30.0}
    fold, _ = told(made_frames(10, start_s=3590.0, **bent), made_frames(10, start_s=3600.0, **bent))
    assert fold.moves[0, [ZONED.index("trunk"), ZONED.index("left_arm")]].tolist() == [1.0, 1.0]
    two = made_frames(3, worker=0, **bent), made_frames(3, worker=1, start_s=3.0, **bent)
    assert told(*two, n_workers=2)[0].moves[:, ZONED.index("trunk")].tolist() == [1.0, 1.0]


def test_an_edge_of_a_stretch_makes_no_bend_too_often():
    """Up at 3599 s, held till 3601 s, and bent once more at 3630 s: in the second minute there is one bend, not two."""
    angle = np.zeros(60)
    angle[0], angle[30] = 40.0, 40.0
    before = np.zeros(60)
    before[59] = 40.0
    fold, _ = told(
        made_frames(60, start_s=3540.0, trunk_flexion=before), made_frames(60, start_s=3600.0, trunk_flexion=angle)
    )
    assert fold.not_acceptable_s[0, ZONED.index("trunk")] == 0.0


def test_who_leans_back_or_has_an_arm_behind_him_holds_it():
    back = {"trunk_flexion": -10.0, "right_arm_elevation": 15.0, "right_arm_flexion": -15.0}
    fold, runs = told(made_frames(10, **back))
    held = dict(zip(REGIONS, fold.held_s[0].tolist()))
    assert held == {"trunk": 10.0, "left_arm": 0.0, "right_arm": 10.0, "neck": 0.0, "head": 10.0}
    assert runs["right_arm"].angle_deg.tolist() == [-15.0]


def test_three_holds_are_told_apart():
    fold, runs = told(made_frames(trunk_flexion=np.repeat([25.0, 70.0, 25.0], [20, 8, 20])))
    assert runs["trunk"].seconds.tolist() == [20.0, 8.0, 20.0] and fold.held_s[0, TRUNK] == 48.0


def test_what_nobody_knows_is_not_counted():
    frames = made_frames(10)
    frames.measures[:] = np.nan
    fold, runs = told(frames)
    assert fold.known_s.sum() == 0 and fold.held_s.sum() == 0 and not any(one.seconds.size for one in runs.values())
