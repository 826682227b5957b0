from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from opsim.libraries import load_library
from opsim.shipped import shipped_folder
from opsim.viewer.frame_codec import between, chosen, control_points, folded, frames_of, pack_frames, second_differences
from opsim.viewer.playback import rows_of
from opsim.viewer.scene import Drawn
from opsim.viewer.skeletons import Columns, unpacked_columns


class Nodding:
    """Somebody's emulator that tells no more than it must: joints of a body of three, and cannot be taken apart."""

    class skeleton:
        names = ("pelvis", "neck", "head")

    def __init__(self, n):
        self.duration_s = np.linspace(1.0, 2.0, n)

    def positions_m(self, times_s=None, n_times=101):
        angle = 0.3 * np.sin(3 * np.asarray(times_s) + np.arange(len(self.duration_s))[:, None])
        pelvis = np.stack([0.1 * angle, 0 * angle, 0.9 + 0 * angle], axis=-1)
        neck = pelvis + np.array([0.0, 0.0, 0.5])
        head = neck + 0.2 * np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=-1)
        return np.stack([pelvis, neck, head], axis=2)


@given(arrays(np.float64, (9, 5), elements=st.floats(-1.0, 1.0)), st.integers(1, 8))
def test_second_differences_are_undone_by_two_sums(channels, cut):
    values, scale = second_differences(channels, np.array([0, cut, 9]), 1)
    for begin, end in ((0, cut), (cut, 9)):
        own = values[5 * begin : 5 * end].reshape(5, -1)
        found = np.cumsum(np.cumsum(own, axis=1), axis=1).T * scale
        assert found == pytest.approx(channels[begin:end], abs=0.51 * scale.max() + 1e-6)


def test_long_jumps_take_longer_steps():
    values, scale = second_differences(np.array([[0.0], [900.0]]), np.array([0, 2]), 0)
    assert np.abs(values).max() <= 32_767 and np.cumsum(np.cumsum(values))[1] * scale[0] == pytest.approx(900, rel=1e-3)


def test_splines_meet_the_frames_of_each_performance_and_ends_are_held():
    frames = np.random.default_rng(0).normal(size=(12, 2))
    first = np.array([0, 6, 7, 9, 12])
    control = control_points(frames, first)
    for begin, end in pairwise(first.tolist()):
        own = control[begin:end]
        assert between(own, np.arange(float(end - begin))) == pytest.approx(frames[begin:end])
        assert between(own, np.array([-1.0, 99.0])) == pytest.approx(frames[[begin, end - 1]])


def test_a_swing_is_met_far_better_than_by_straight_lines():
    at = np.arange(0.0, 12.01, 0.4)
    frames, asked = np.sin(at)[:, None], np.linspace(3, 27, 500)
    assert between(control_points(frames, np.array([0, at.size])), asked)[:, 0] == pytest.approx(
        np.sin(0.4 * asked), abs=2e-4
    )


def test_whole_numbers_are_folded_small_ones_first():
    assert folded(np.array([0, -1, 1, -2, 2])).tolist() == [0, 1, 2, 3, 4]
    assert folded(np.array([-32_767, 32_767])).max() == 65_534


def test_rate_and_components_are_tried_on_people_all_over_the_run():
    """Blocks are many people of a workforce, and of one block two performances told too little: 5 mm at a hand."""
    model = load_library(shipped_folder() / "libraries" / "bench_work.npz")["stoop"]
    some = model.sample(60, np.random.default_rng(0))
    one, two = (Drawn("stoop", some.skeleton, blocks, first) for blocks, first in (
        ((some,), (0, 60)), ((some[:1], some[1:]), (0, 1, 60)),
    ))  # fmt: skip
    assert chosen(one) == chosen(two)


def test_bodies_of_another_emulator_are_packed_by_their_joints_alone():
    block = Nodding(4)
    some = rows_of(block, np.array([1, 3]))
    drawn = Drawn("nod", some.skeleton, (some,), (0, 2))
    columns = Columns()
    told = pack_frames(drawn, 0, columns, "m0_")
    found = unpacked_columns(columns.table, columns.close())
    assert told["codec"] == "frames" and told["n"] == 2
    assert found["m0_duration_s"] == pytest.approx(block.duration_s[[1, 3]], rel=1e-6)
    assert found["m0_bone_m"] == pytest.approx([0.5, 0.2, 0.5, 0.2])
    frames = frames_of(drawn, 20.0)
    joints = block.positions_m(times_s=np.full((4, 1), 0.5))[1, 0]
    assert frames.path[10, :3] == pytest.approx(joints[0]) and frames.directions[10, 3:] == pytest.approx(
        (joints[2] - joints[1]) / 0.2
    )
