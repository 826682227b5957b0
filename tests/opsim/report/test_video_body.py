import numpy as np
import pytest
from PIL import ImageColor

from opsim.report.plot.body import COLOURS, camera_of
from opsim.report.plot.video import BodyPainter
from tests.made_cards import SKELETON, cards
from tests.opsim.report.test_strips import NAMES

WIDE_PX = 160


def painter(**more):
    shown = [card.positions_m for card in cards(1, **more)]
    return BodyPainter(SKELETON, camera_of(shown, SKELETON), WIDE_PX), shown[0]


def drawn(frame=0, **more):
    paints, joints = painter(**more)
    return np.asarray(paints.picture(joints[frame], joints.mean(axis=0))).astype(int)


def of_colour(picture, colour):
    """Where (rows, columns) the picture has exactly this colour."""
    return np.argwhere(np.all(picture == ImageColor.getrgb(colour), axis=-1))


def test_a_body_is_drawn_in_its_three_colours_on_white():
    picture = drawn()
    assert all(len(of_colour(picture, colour)) > 100 for colour in COLOURS)
    assert np.all(picture[0] == 255) and len(of_colour(picture, "white")) > 0.5 * picture[..., 0].size


def test_the_picture_is_as_wide_as_asked_and_as_high_as_the_camera_says():
    paints, _ = painter()
    high = round(WIDE_PX * paints.camera.height_per_width)
    assert drawn().shape == (high, WIDE_PX, 3) and paints.size_px == (WIDE_PX, high)


@pytest.mark.parametrize("travel_m", [0.0, 3.0])
def test_nothing_of_a_body_touches_the_edge(travel_m):
    for frame in (0, 15, 30):
        picture = drawn(frame, travel_m=travel_m)
        ink = np.concatenate([of_colour(picture, colour) for colour in COLOURS])
        assert ink.min() > 1 and np.all(ink.max(axis=0) < np.array(picture.shape[:2]) - 2)


def test_a_hand_is_drawn_where_the_camera_sees_it():
    paints, joints = painter()
    rows = []
    for frame in (0, 15):
        wrist = joints[frame, NAMES.index("right_wrist")]
        across, high, _ = (
            paints.camera.see(wrist, np.array(paints.camera.middle_m)) * WIDE_PX / (2 * paints.camera.wide_m)
        )
        rows.append(round(paints.size_px[1] - high))
        assert tuple(drawn(frame)[rows[-1], round(WIDE_PX / 2 + across)]) == ImageColor.getrgb(COLOURS[2])
    assert rows[1] < rows[0] - 10


def test_a_limb_near_the_viewer_hides_the_one_behind_it():
    paints, joints = painter()
    left, right = (len(of_colour(drawn(), colour)) for colour in COLOURS[1:])
    mirrored = joints[0] * [1, -1, 1]
    turned = np.asarray(paints.picture(mirrored, mirrored))
    assert (len(of_colour(turned, COLOURS[1])) > len(of_colour(turned, COLOURS[2]))) != (left > right)


def test_a_shadow_fades_as_the_foot_leaves_the_floor():
    paints, joints = painter()
    darkest = []
    for lifted_m in (0.0, 0.3):
        body = joints[0] + [0.0, 0.0, lifted_m]
        picture = np.asarray(paints.picture(body, body)).astype(int)
        floor = picture[int(0.85 * len(picture)) :]
        grey = np.ptp(floor, axis=-1) < 25
        darkest.append(floor[grey].mean(axis=-1).min())
    assert darkest[0] < darkest[1]
