import numpy as np
import pytest
from PIL import ImageColor

from opsim.report.plot.animation import (
    NARROWEST_PX,
    WIDTH_PX,
    body_width_px,
    clipped,
    columns_of,
    font,
    sheet_of,
    wrapped,
)
from opsim.report.plot.body import COLOURS, FLOOR_M, LIFT_RAD, Camera, camera_of
from opsim.report.plot.video import BodyPainter
from opsim.report.sections.motions import CARD_RATE_HZ as RATE_HZ
from opsim.report.sections.motions import Card, resampled, staged
from tests.made.cards import SKELETON, cards, video
from tests.opsim.report.test_strips import NAMES, STANDING, Skeleton

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


@pytest.mark.parametrize("n, columns", [(1, 1), (2, 2), (4, 4), (5, 3), (6, 3), (8, 4), (9, 5), (15, 5), (21, 7)])
def test_rows_are_as_full_as_can_be(n, columns):
    assert columns_of(n) == columns


@pytest.mark.parametrize("n", [1, 2, 4, 9, 21])
def test_bodies_lie_side_by_side_inside_the_sheet_and_do_not_overlap(n):
    wide = body_width_px(n)
    sheet = sheet_of(video(n - 1), (wide, 200), "said")
    assert len(sheet.places) == n and NARROWEST_PX <= sheet.picture.size[0] <= WIDTH_PX + 1
    boxes = np.array([(x, y, x + wide, y + 200) for x, y in sheet.places])
    assert boxes.min() > 0 and np.all(boxes[:, 2:].max(axis=0) < np.array(sheet.picture.size))
    for i, a in enumerate(boxes):
        assert not any(np.all(a[:2] < b[2:]) and np.all(b[:2] < a[2:]) for b in boxes[i + 1 :])


def test_both_sides_are_even_as_films_need_them():
    for high in (200, 201):
        assert not any(side % 2 for side in sheet_of(video(1), (150, high), "said").picture.size)


def test_the_place_of_a_body_is_white():
    sheet = sheet_of(video(2), (200, 150), "said")
    for x, y in sheet.places:
        assert np.all(np.asarray(sheet.picture.crop((x + 2, y, x + 198, y + 150))) == 255)


def test_long_words_are_wrapped_and_a_longer_one_is_cut():
    text = "a sentence that is longer than the room there is, with one " + "very" * 60
    lines = wrapped(text, 12, 200)
    assert len(lines) > 2 and all(font(12).getlength(line) <= 200 for line in lines) and lines[-1].endswith("…")
    assert " ".join(lines[:-1]) == text.rpartition(" ")[0]


def test_what_does_not_print_becomes_a_space():
    assert clipped("a\nb\tc\x1b", 12, 200) == "a b c "


def test_a_hostile_name_fits_on_the_sheet():
    made = video(1, task="x\n" * 500, notes=(("\x00", "\u202e" + "y" * 3000),))
    assert sheet_of(made, (150, 200), "said").picture.size[0] == NARROWEST_PX


FRONT = Camera(0, False, (0.0, 0.0), 1.0, 2.0)


def bodies(**more):
    return [card.positions_m for card in cards(2, **more)]


def test_who_looks_along_x_sees_y_to_the_right_and_z_up():
    across, high, _ = FRONT.see(np.array([[0.0, 0.5, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]), np.zeros(2)).T
    assert across == pytest.approx([0.5, 0.0, 0.0])
    assert high[1] - high[2] == pytest.approx(np.cos(LIFT_RAD)) and high[0] == high[2]


def test_what_comes_nearer_is_nearer_and_lower():
    near, far = FRONT.see(np.array([[0.5, 0.0, 1.0], [-0.5, 0.0, 1.0]]), np.zeros(2))
    assert near[2] > far[2] and near[1] < far[1]


@pytest.mark.parametrize("travel_m", [0.0, 3.0])
@pytest.mark.parametrize("turn_deg", [-180, -90, 0, 45])
def test_every_joint_and_the_floor_below_it_is_in_the_picture_from_everywhere(travel_m, turn_deg):
    shown = bodies(travel_m=travel_m)
    seen_by = camera_of(shown, SKELETON)
    camera = Camera(turn_deg, seen_by.follow, seen_by.middle_m, seen_by.wide_m, seen_by.tall_m)
    top_m = 2 * camera.wide_m * camera.height_per_width
    for joints in np.concatenate(shown):
        middle = joints[SKELETON.parents.index(-1), :2] if camera.follow else np.array(camera.middle_m)
        below = np.concatenate([joints[:, :2], np.full((len(joints), 1), FLOOR_M)], axis=1)
        seen = camera.see(np.concatenate([joints, below]), middle)
        assert np.abs(seen[:, 0]).max() < camera.wide_m and seen[:, 1].min() > 0 and seen[:, 1].max() < top_m


def test_who_walks_is_followed_and_who_does_not_is_not():
    assert camera_of(bodies(travel_m=2.0), SKELETON).follow and not camera_of(bodies(), SKELETON).follow


def test_the_view_is_one_for_all_and_does_not_depend_on_their_order():
    shown = bodies()
    assert camera_of(shown, SKELETON).as_dict() == camera_of(shown[::-1], SKELETON).as_dict()


def test_a_skeleton_without_hips_is_looked_at_from_a_side():
    handle = type("Handle", (), {"names": ("grip", "tip"), "parents": (-1, 0)})
    assert camera_of([np.zeros((4, 2, 3))], handle).turn_deg == 30


STAGED_SKELETON = Skeleton()
LEFT_HIP, RIGHT_HIP, TOE = (NAMES.index(name) for name in ("left_hip", "right_hip", "left_ankle"))


def walked(n=51, rate_hz=50.0):
    """A body that goes 0.5 m forward while it lifts its left hand."""
    positions = np.tile(STANDING, (n, 1, 1))
    positions[:, :, 0] += np.linspace(0, 0.5, n)[:, None]
    positions[:, NAMES.index("left_wrist"), 2] += np.sin(np.linspace(0, np.pi, n)) * 0.4
    return positions, rate_hz


def elsewhere(positions, turn_rad=2.1, by=(3.0, -4.0, 0.2)):
    """The same movement at another place of the room, in another heading, on a higher floor."""
    cosine, sine = np.cos(turn_rad), np.sin(turn_rad)
    return positions @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]]) + by


def test_place_heading_and_floor_of_the_room_leave_no_trace():
    positions, rate_hz = walked()
    assert np.allclose(
        staged(elsewhere(positions), rate_hz, STAGED_SKELETON), staged(positions, rate_hz, STAGED_SKELETON)
    )


def test_the_first_frame_stands_at_the_origin_on_the_floor_and_looks_along_x():
    shown = staged(elsewhere(walked()[0]), 50.0, STAGED_SKELETON)
    assert np.allclose(shown[0, 0, :2], 0)
    across = shown[0, LEFT_HIP] - shown[0, RIGHT_HIP]
    assert across[0] == pytest.approx(0, abs=1e-12) and across[1] > 0
    assert shown[..., 2].min(axis=1) == pytest.approx(0, abs=1e-9)


def test_a_jump_of_one_frame_does_not_move_the_floor():
    positions, rate_hz = walked()
    positions[10, TOE, 2] = -0.5
    assert staged(positions, rate_hz, STAGED_SKELETON)[0, :, 2].min() == pytest.approx(0, abs=1e-9)


def test_the_way_is_kept_as_the_body_went():
    shown = staged(elsewhere(walked()[0]), 50.0, STAGED_SKELETON)
    assert shown[-1, 0, :2] == pytest.approx([0.5, 0.0])


@pytest.mark.parametrize("rate_hz", [25.0, 50.0, 60.0, 120.0])
def test_frames_lie_on_the_straight_lines_between_recorded_ones(rate_hz):
    time_s = np.arange(round(2 * rate_hz) + 1) / rate_hz
    positions = np.sin(time_s)[:, None, None] * np.ones((1, 2, 3))
    shown = resampled(positions, rate_hz)
    expected = np.interp(np.arange(len(shown)) / RATE_HZ, time_s, np.sin(time_s))
    assert len(shown) == 61 and np.allclose(shown[:, 1, 2], expected)


def test_the_end_is_the_last_recorded_posture_and_never_beyond():
    positions, _ = walked(n=48)
    assert len(resampled(positions, 50.0)) == round(47 / 50 * RATE_HZ) + 1
    assert np.allclose(resampled(positions, 50.0)[-1], positions[-1], atol=0.5 / 30)


def test_a_body_without_hips_keeps_its_heading():
    class Arm:
        names, parents = ("pelvis", "left_elbow"), (-1, 0)

    positions = np.zeros((5, 2, 3))
    positions[:, 1] = [0.3, 0.4, 0.0]
    assert np.allclose(staged(positions, 30.0, Arm())[:, 1], [0.3, 0.4, 0.0])


def test_a_card_knows_how_long_it_lasts():
    assert Card(np.zeros((61, 2, 3)), True, "s1").duration_s == pytest.approx(2.0)
