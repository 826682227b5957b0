"""The fold that counts what is held, and what moves."""

import numpy as np

from opsim.ergonomics.holds import REGIONS
from opsim.ergonomics.still import Still
from opsim.ergonomics.zones import ZONED
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


def test_what_nobody_knows_is_not_counted():
    frames = made_frames(10)
    frames.measures[:] = np.nan
    fold, runs = told(frames)
    assert fold.known_s.sum() == 0 and fold.held_s.sum() == 0 and not any(one.seconds.size for one in runs.values())
