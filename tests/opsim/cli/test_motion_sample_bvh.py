"""``opsim motion sample -o x.bvh``: drawn performances for programs of animation."""

import numpy as np
import pytest

from emulator import MotionLibrary
from emulator.recordings.bvh import read_bvh
from emulator.recordings.npz import read_recording
from tests.opsim.cli.test_motion import BENCH, opsim


def test_performances_are_files_that_hold_their_joints(tmp_path):
    code, shown, _ = opsim(
        "motion", "sample", BENCH, "reach", "-n", 3, "--seed", 3, "--fps", 25, "-o", tmp_path / "a.bvh"
    )
    assert code == 0 and f"{tmp_path / 'a_k0.bvh'} to a_k2.bvh" in shown
    drawn = MotionLibrary.load(BENCH)["reach"].sample(3, np.random.default_rng(3))
    for k in range(3):
        take = read_bvh(tmp_path / f"a_k{k}.bvh")
        assert take.rate_hz == 25 and take.duration_s == pytest.approx(drawn.duration_s[k], abs=0.5 / 25)
        places = drawn[k].positions_m(times_s=np.arange(take.n_frames) / 25)[0]
        order = [take.names.index(name) for name in drawn.skeleton.names]
        assert np.abs(take.positions_m[:, order] - places).max() < 1e-7
        bones = np.linalg.norm(take.positions_m[:, 1:] - take.positions_m[:, list(take.parents[1:])], axis=2)
        assert np.ptp(bones, axis=0).max() < 1e-6


def test_one_performance_is_one_file_of_that_name(tmp_path):
    assert opsim("motion", "sample", BENCH, "reach", "-n", 1, "-o", tmp_path / "one.BVH")[0] == 0
    assert [path.name for path in tmp_path.iterdir()] == ["one.BVH"]


def test_ten_files_stand_in_order(tmp_path):
    assert opsim("motion", "sample", BENCH, "reach", "-n", 11, "--fps", 5, "-o", tmp_path / "a.bvh")[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"a_k{k:02d}.bvh" for k in range(11)]


def test_a_drawn_movement_comes_back_where_it_was_facing_as_it_did(tmp_path):
    words = ("motion", "sample", BENCH, "reach", "-n", 1, "--seed", 5, "--fps", 25, "-o")
    assert opsim(*words, tmp_path / "s.npz")[0] == 0 and opsim(*words, tmp_path / "x.bvh")[0] == 0
    code, _, err = opsim("motion", "import", tmp_path / "x.bvh", "-o", tmp_path / "back.npz")
    assert code == 0, err
    (one,), (other,) = (read_recording(tmp_path / name).takes for name in ("s.npz", "back.npz"))
    order = [other.names.index(name) for name in one.names]
    assert np.abs(one.positions_m - other.positions_m[:, order]).max() < 1e-6


def test_files_of_an_earlier_draw_do_not_stay_beside_the_new_ones(tmp_path):
    out = tmp_path / "x.bvh"
    words = ("motion", "sample", BENCH, "reach", "--fps", 5, "-o", out, "-n")
    assert opsim(*words, 3)[0] == 0
    (tmp_path / "x_k7.bvh").write_text("HIERARCHY\nROOT Hips\n{\n")
    (tmp_path / "x_kept.bvh").write_text("mine")
    code, shown, _ = opsim(*words, 2)
    assert code == 0 and "removed, of an earlier draw: x_k2.bvh" in shown
    assert "left beside them, not of this draw: x_k7.bvh" in shown
    assert sorted(p.name for p in tmp_path.iterdir()) == ["x_k0.bvh", "x_k1.bvh", "x_k7.bvh", "x_kept.bvh"]
    code, shown, _ = opsim(*words, 1)
    assert code == 0 and "x_k0.bvh, x_k1.bvh" in shown
    assert sorted(p.name for p in tmp_path.iterdir()) == ["x.bvh", "x_k7.bvh", "x_kept.bvh"]
