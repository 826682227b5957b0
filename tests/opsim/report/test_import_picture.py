"""The picture of what was imported."""

import warnings
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from opsim.report.motion.importing import Shown, _apart, _clear_frames, draw_import, drawable
from tests.emulator.recordings.body import body


def shown(positions=None, title="a.bvh: ana/1"):
    take = body(40, 50.0)
    bones = len(take.names) - 1
    positions = take.positions_m if positions is None else positions
    return Shown(
        title, "BVH, 40 frames", take.names, take.parents, positions, 50.0, np.full(bones, 0.3), np.full(bones, 0.01)
    )


@pytest.mark.parametrize(("ending", "first"), [("png", b"\x89PNG"), ("svg", b"<?xml")])
def test_the_same_take_gives_the_same_picture(ending, first):
    picture = draw_import([shown()], ending)
    assert picture.startswith(first) and picture == draw_import([shown()], ending)


def test_every_joint_is_named_once_and_no_name_lies_on_another():
    heights = _apart([1.0, 1.0, 0.99, 0.2, 0.2, 0.19], 0.1, 0.1, 1.0)
    assert all(a - b >= 0.1 - 1e-9 for a, b in pairwise(heights)) and max(heights) <= 1.0
    assert min(heights) >= 0.1 - 1e-9


def test_moments_are_those_that_show_the_body():
    positions = body(40, 50.0).positions_m.copy()
    positions[:10, 4] = np.nan
    frames = _clear_frames(shown(positions), 8)
    assert frames[0] == 10 and frames[-1] == 39 and len(frames) == 8


def test_a_take_with_nothing_but_gaps_is_drawn_too():
    positions = body(40, 50.0).positions_m.copy()
    positions[:, [0, 13]] = np.nan
    assert draw_import([shown(positions)], "svg")
    positions[:] = np.nan
    assert draw_import([shown(positions)], "svg")


def test_names_of_files_are_no_formulas():
    assert draw_import([shown(title="$a_b$ ^{ \\frac.bvh")], "svg")


def test_more_takes_than_rows_are_drawn_as_far_as_there_is_room():
    many = [replace(shown(), title=f"{k}") for k in range(14)]
    assert len(draw_import(many, "svg")) > len(draw_import(many[:1], "svg"))


def test_characters_without_a_glyph_become_question_marks():
    assert drawable("日本_é.bvh\nµ") == "??_é.bvh\nµ"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert draw_import([shown(title="日本.bvh\t\x1b")], "svg") == draw_import([shown(title="??.bvh??")], "svg")
