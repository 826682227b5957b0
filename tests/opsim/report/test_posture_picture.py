import re
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
import pytest

from emulator.skeleton import standard_skeleton
from opsim.report.plot.body import COLOURS
from opsim.report.plot.posture import VIEWS, posture_svg, room_of, warm
from tests.opsim.ergonomics.bodies import bent, standing, turn

SKELETON = standard_skeleton()
SVG = "{http://www.w3.org/2000/svg}"


class Few(NamedTuple):
    names: tuple
    parents: tuple


def without(*ends):
    """The skeleton without some joints at the ends of limbs, and a standing body of it."""
    kept = [j for j, name in enumerate(SKELETON.names) if not name.endswith(ends)]
    names = tuple(SKELETON.names[j] for j in kept)
    parents = tuple(kept.index(SKELETON.parents[j]) if SKELETON.parents[j] >= 0 else -1 for j in kept)
    return Few(names, parents), standing()[kept]


def colours(svg):
    """The fills of the limbs, torso and head."""
    root = ElementTree.fromstring(svg)
    return [path.get("fill") for path in root.iter("path") if path.get("paint-order")]


def test_every_part_is_drawn_in_the_colour_of_its_side():
    drawn = colours(posture_svg(standing(), SKELETON))
    assert len(drawn) == 18 and set(drawn) == set(COLOURS)


def test_parts_are_as_warm_as_the_points_they_bring():
    drawn = colours(posture_svg(bent(60), SKELETON, drives={"trunk": 2.0, "arms": 0.75}, side="left"))
    assert warm(2.0) == "#b0410b" == warm(9.0) and warm(0.0) == "#a9b0ba" == warm(-1.0)
    assert drawn.count(warm(2.0)) == 3 + 1 and drawn.count(warm(0.75)) == 2
    both = colours(posture_svg(bent(60), SKELETON, drives={"arms": 0.75}))
    assert both.count(warm(0.75)) == 4


def test_the_back_of_owas_is_the_trunk():
    assert colours(posture_svg(standing(), SKELETON, drives={"back": 2.0})).count(warm(2.0)) == 4


@pytest.mark.parametrize("view", VIEWS)
def test_place_and_heading_do_not_matter(view):
    body = bent(40, 10, 15)
    elsewhere = body @ turn([0, 0, 1], 130).T + np.array([5.0, -3.0, 1.0])
    here, there = (
        np.array(re.findall(r"-?\d+\.\d", posture_svg(body, SKELETON, view=view)), float) for body in (body, elsewhere)
    )
    assert np.allclose(here, there, atol=0.11)


def test_the_worse_arm_is_nearer_to_the_viewer():
    """From its own side a body that is bent forward looks right where that is the right one, else left."""
    heads = {}
    for side in ("left", "right"):
        svg = posture_svg(bent(80), SKELETON, view="side", side=side, drives={"neck": 2.0})
        disc = [path for path in ElementTree.fromstring(svg).iter("path") if path.get("fill") == warm(2.0)][-1]
        heads[side] = float(disc.get("d").split()[0][1:])
    assert heads["right"] > 130 > 90 > heads["left"]


def test_several_postures_have_one_scale():
    room = room_of([standing(), bent(90)], SKELETON)
    sizes = {posture_svg(body, SKELETON, room=room).partition(">")[0] for body in (standing(), bent(90))}
    assert len(sizes) == 1 and room.tall_m == pytest.approx(1.65 - 0.02 + 0.16)


def test_what_is_not_known_is_left_out():
    body = standing()
    body[SKELETON.names.index("left_hand")] = np.nan
    assert len(colours(posture_svg(body, SKELETON))) == 17 and "nan" not in posture_svg(body, SKELETON)
    few, joints = without("hand", "wrist", "head")
    assert len(colours(posture_svg(joints, few))) == 18 - 2 - 2 - 2


def test_a_body_without_hips_keeps_its_heading():
    few, joints = without("hip", "knee", "ankle", "toe")
    assert len(colours(posture_svg(joints, few))) > 5


def test_words_for_who_cannot_see_are_escaped():
    assert 'aria-label="a &lt;b&gt; &quot;c&quot;"' in posture_svg(standing(), SKELETON, label='a <b> "c"')


def test_a_load_is_in_the_hands():
    assert posture_svg(standing(), SKELETON, load_kg=8.0).count("#8a6b3d") == 5
    assert "#8a6b3d" not in posture_svg(standing(), SKELETON, load_kg=0.0)
