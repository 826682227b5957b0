"""The picture of a cut take."""

import numpy as np
import pytest

from emulator.skeleton import Skeleton
from opsim.report.motion.segmentation import CutTake, apart, draw_cuts, spread
from tests.emulator.segmenting.made_movements import walking


@pytest.fixture(scope="module")
def cut_take():
    take = walking(3.0, 30.0)
    time_s = np.arange(take.n_frames) / take.rate_hz
    return CutTake(
        title="w1/1: 2 cycles <b>",
        time_s=time_s,
        curve=np.sin(2 * np.pi * time_s),
        says="coordinate on the manifold",
        pieces=[(0.2, 1.2, "first"), (1.2, 2.2, "second")],
        skeleton=Skeleton(take.names, take.parents),
        positions_m=take.positions_m,
        posture_s=np.array([0.2, 0.7, 1.2, 2.2]),
        units=[("initial", 0.0, 0.2), ("cyclic", 0.2, 2.2), ("final", 2.2, 3.0)],
        manifold=np.stack([np.cos(6 * time_s), np.sin(6 * time_s)], axis=1),
        manifold_s=time_s,
    )


def test_the_picture_names_pieces_units_and_take_and_is_the_same_every_time(cut_take, tmp_path):
    one, other = (draw_cuts([cut_take], tmp_path / name).read_bytes() for name in ("a.svg", "b.svg"))
    assert one == other
    for word in ("first", "second", "cyclic", "w1/1: 2 cycles &lt;b&gt;", "coordinate on the manifold"):
        assert word in one.decode()


def test_several_takes_stand_below_each_other_as_png(cut_take, tmp_path):
    assert draw_cuts([cut_take, cut_take], tmp_path / "two.png").read_bytes().startswith(b"\x89PNG")


def test_figures_stand_near_their_time_but_never_in_each_other():
    wanted = np.array([0.1, 0.15, 0.2, 5.0, 9.9, 9.95])
    places = spread(wanted, 10.0, 0.8)
    assert np.all(np.diff(places) > 0.8 - 1e-12) and places.min() >= 0 and places.max() <= 10
    assert places[3] == 5.0
    assert np.array_equal(spread(np.array([2.0, 4.0]), 10.0, 1.0), [2.0, 4.0])


def test_the_colours_of_units_are_explained_and_a_heading_stands_above(cut_take, tmp_path):
    drawn = draw_cuts([cut_take], tmp_path / "a.svg", heading="the first 1 of 9 takes").read_text(encoding="utf-8")
    assert "initial and final" in drawn and "the first 1 of 9 takes" in drawn


def test_times_on_the_manifold_do_not_stand_in_one_another():
    ring = np.stack([np.cos(np.linspace(0, 40, 600)), np.sin(np.linspace(0, 40, 600))], axis=1)
    chosen = ring[apart(ring)] / 2
    away = np.abs(chosen[:, None] - chosen[None]) / (0.24, 0.09)
    assert 3 < len(chosen) <= 10 and np.all(away.max(axis=-1)[~np.eye(len(chosen), dtype=bool)] > 0.99)
