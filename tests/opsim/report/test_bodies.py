import json
import re
from types import SimpleNamespace

import numpy as np
import pytest
from plans import ran

from opsim.ergonomics.shift.ledger import Regions, timeline
from opsim.ergonomics.shift.worst import worst_frames
from opsim.log import BREAK, NAMED, WAIT, event_log
from opsim.report.plot.body import COLOURS, body, body_parts, outer_tangents
from opsim.report.plot.body import TORSO_PART as TORSO
from opsim.report.plot.posture import load_box
from opsim.report.sections.exposure import bodies_of, day_of, pauses, regions_said, write_postures
from opsim.report.sections.postures import pair, posture_cards
from opsim.report.sections.worker_timeline import Strip, draw_day, legend
from tests.opsim.ergonomics.bodies import standing
from tests.opsim.ergonomics.shift.test_movement import CELL
from tests.opsim.kpi.made_logs import row
from tests.opsim.report.test_posture import SKELETON, without
from tests.opsim.report.test_strips import NAMES, PARENTS, Skeleton


@pytest.fixture(scope="module")
def cell():
    log, plan = ran(CELL)
    return log, plan, worst_frames(log, plan, 2)


def test_a_strip_is_filled_by_the_share_of_each_minute_at_a_high_score(cell):
    log, plan, _ = cell
    day = timeline(log, plan)
    section = day_of(day, plan, "Mon 06:30")
    assert section["minutes"] == 1 and b"ana" in section["picture"] and b"06:40" in section["picture"]
    share = day.from_5_s[0].sum() / (60 * day.from_5_s.shape[1])
    assert f"{100 * share:.2f}"[:4] in section["alt"] and "RULA 5 or more" in section["alt"]
    words = [words for _, words in section["legend"]]
    assert "RULA 5 or more" in words and "at work, posture not known" in words


def test_breaks_that_follow_each_other_are_one_stretch_of_the_strip():
    names = dict.fromkeys(NAMED, ())
    rows = [row(BREAK, 0, 60, worker=0), row(BREAK, 60, 90, worker=0), row(BREAK, 500, 900, worker=0)]
    log = event_log([*rows, row(BREAK, 10, 20, worker=1), row(WAIT, 200, 300, worker=0)], 1000.0, names)
    assert pauses(log, 0, 0.0, 600.0) == [pytest.approx((0.0, 0.15)), pytest.approx((500 / 600, 1.0))]
    assert pauses(log, 2, 0.0, 600.0) == []


def test_breaks_are_hatched_and_in_the_legend():
    paused = [Strip("ana", {"rula_from_5": np.array([0.5, 0.5])}, pauses=((0.2, 0.4),))]
    assert b"url(#pause)" in draw_day(paused, "Mon 06:00", 0.0, 600.0) and "hatched" in legend(paused)[-1][1]
    plain = [Strip("ana", {"rula_from_5": np.array([0.5, 0.5])})]
    assert b"pause" not in draw_day(plain, "Mon 06:00", 0.0, 600.0) and len(legend(plain)) == 1


def test_a_card_says_who_when_and_what_drives_the_score_and_draws_two_views(cell):
    *_, worst = cell
    first, _ = posture_cards(worst)
    assert worst[0].worker in first["title"] and worst[0].task in first["title"] and worst[0].clock in first["when"]
    assert "RULA" in first["scores"] and first["drives"].startswith("Points of the score come from")
    assert len(first["pictures"]) == 2 and all(svg.startswith("<svg") for svg in first["pictures"])
    assert [name for name, *_ in first["parts"]][:2] == ["trunk", "neck"]


def test_the_regions_of_one_replication_are_said_in_shares(cell):
    _, plan, _ = cell
    regions = Regions(plan)
    regions.seconds[0] = [[60.0, 60.0], *[[0.0, 0.0]] * 4, [180.0, 0.0], [0.0, 0.0]]
    assert regions_said(regions) == [
        "What brings people to RULA 5 or more: the load (75 %) and the trunk (25 %).",
        "What brings them to RULA 7: the trunk (100 %).",
    ]


def test_a_score_is_one_number_or_an_interval():
    assert pair((7, 7)) == "7" and pair((5, 7)) == "5 to 7"


def test_the_postures_are_kept_for_whoever_opens_the_folder(cell, tmp_path):
    *_, worst = cell
    write_postures(worst, tmp_path / "postures.json")
    found = json.loads((tmp_path / "postures.json").read_text())["worst"]
    assert [one["worker"] for one in found] == [one.worker for one in worst]
    assert len(found[0]["joints_m"]) == len(found[0]["joints"]) and found[0]["why"]["rula"]["drives"]


def test_where_nobody_asked_for_postures_there_is_nothing():
    assert bodies_of(SimpleNamespace(summary={"kpis": [{"kpi": "throughput_per_h"}]}, log="there")) is None


def test_every_bone_but_the_ties_of_the_torso_is_a_limb():
    ties = {NAMES.index(f"{side}_{joint}") for side in ("left", "right") for joint in ("shoulder", "hip")}
    drawn = [(parent, joint) for parent, joint, *_ in body(Skeleton())["bones"]]
    assert drawn == [(parent, j) for j, parent in enumerate(PARENTS) if parent >= 0 and j not in ties]


def test_limbs_have_the_colour_of_their_side():
    colour = {NAMES[joint]: COLOURS[number] for _, joint, _, _, number in body(Skeleton())["bones"]}
    assert colour["left_knee"] != colour["right_knee"] and colour["neck"] not in (
        colour["left_knee"],
        colour["right_knee"],
    )


def test_a_thigh_is_thicker_than_a_forearm_and_both_taper():
    radii = {NAMES[joint]: (at, to) for _, joint, at, to, _ in body(Skeleton())["bones"]}
    assert radii["left_knee"][0] > radii["left_wrist"][0] > radii["left_wrist"][1] > 0
    assert radii["left_knee"][1] == radii["left_ankle"][0]


def test_a_skeleton_of_other_joints_is_drawn_whole():
    class Arm:
        names, parents = ("root", "upper", "tip"), (-1, 0, 1)

    drawn = body(Arm())
    assert len(drawn["bones"]) == 2 and drawn["torso"] == [] and drawn["head"] == -1 and drawn["feet"] == []


def seen(turn_deg):
    """A standing body as seen from an angle about the vertical, 0 from straight ahead: pixels of 10 mm."""
    angle = np.deg2rad(turn_deg)
    x, y, z = standing().T
    near, across = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    return np.stack([100 * across, 200 - 100 * z, near], axis=1)


def order(turn_deg):
    table = body(SKELETON)
    return [part.joint for part in body_parts(table, seen(turn_deg), seen(turn_deg), 0.1)]


def test_all_parts_are_there_once_and_the_head_twice():
    """Of 20 bones 4 tie the torso; its shape and the disc of the head come besides, and the neck's bone ends there."""
    joints = order(30)
    assert len(joints) == 20 - 4 + 2 and joints.count(TORSO) == 1
    assert joints.count(SKELETON.names.index("head")) == 2


def test_the_near_arm_is_drawn_after_the_torso_and_the_far_one_before():
    left, right = (SKELETON.names.index(f"{side}_elbow") for side in ("left", "right"))
    for turn_deg, near, far in ((90, left, right), (-90, right, left)):
        joints = order(turn_deg)
        assert joints.index(far) < joints.index(TORSO) < joints.index(near)


def test_tangents_touch_both_discs_square_to_their_radii():
    a, b = np.array([0.0, 0.0]), np.array([5.0, 1.0])
    on_a, on_b, from_b, back = outer_tangents(a, b, 2.0, 1.0)
    for start, end in ((on_a, on_b), (back, from_b)):
        assert np.linalg.norm(start - a) == pytest.approx(2.0) and np.linalg.norm(end - b) == pytest.approx(1.0)
        assert (
            (end - start) @ (start - a)
            == pytest.approx(0, abs=1e-12)
            == pytest.approx((end - start) @ (end - b), abs=1e-12)
        )


def test_a_disc_inside_another_has_no_tangents():
    assert outer_tangents(np.zeros(2), np.array([0.5, 0.0]), 2.0, 1.0).shape == (0, 2)


def load_box_seen(points):
    """From straight ahead, a pixel a centimetre."""
    points = np.asarray(points, float)
    return np.stack([100 * points[..., 1], 100 - 100 * points[..., 2], points[..., 0]], axis=-1)


def edges_px(load_kg, body=None, skeleton=SKELETON):
    """Left, right, upper and lower edge of the box."""
    ((_, svg),) = load_box(standing() if body is None else body, skeleton, load_kg, load_box_seen)
    x, y = np.array(re.findall(r"(-?\d+\.\d) (-?\d+\.\d)", svg), float).T
    return x.min(), x.max(), y.min(), y.max()


def test_a_box_of_its_mass_is_held_between_the_hands():
    """8.1 kg at 300 kg/m3: 0.027 m3, 0.3 m long; the hands' middle lies at y = 0, z = 0.76 m."""
    assert edges_px(8.1) == pytest.approx((-15, 15, 24 - 15, 24 + 15), abs=0.11)


def test_boxes_are_never_too_small_or_too_large_to_be_seen():
    assert np.ptp(edges_px(0.001)[2:]) == pytest.approx(12, abs=0.11)
    assert np.ptp(edges_px(900.0)[2:]) == pytest.approx(45, abs=0.11)


def test_nothing_is_drawn_of_no_load():
    assert load_box(standing(), SKELETON, 0.0, load_box_seen) == []


def hands_at(left, right):
    body = standing().copy()
    for hand, place in (("left_hand", left), ("right_hand", right)):
        body[SKELETON.names.index(hand)] = place
    return body


def test_a_box_reaches_from_hand_to_hand_where_both_are_level():
    """Hands at y = 0.3 and -0.3: 0.6 m between them; as high as its mass says, 0.3 m."""
    assert edges_px(8.1, hands_at((0.3, 0.3, 1.0), (0.3, -0.3, 1.0))) == pytest.approx((-30, 30, -15, 15), abs=0.11)


@pytest.mark.parametrize("other", [(0.3, -0.3, 1.6), (0.3, -0.9, 1.1), (-0.4, -0.3, 1.0001)])
def test_a_box_never_floats_between_hands_that_cannot_hold_it_both(other):
    """The left hand is lower, at y = 0.3: the box, 0.3 m long, hangs in it, its top at 1 m."""
    assert edges_px(8.1, hands_at((0.3, 0.3, 1.0), other)) == pytest.approx((15, 45, 0, 30), abs=0.11)
    mirrored = hands_at((other[0], -other[1], other[2]), (0.3, -0.3, 1.0))
    assert edges_px(8.1, mirrored) == pytest.approx((-45, -15, 0, 30), abs=0.11)


def test_wrists_hold_it_where_there_are_no_hands_and_nobody_without():
    names, body = without("hand")
    assert np.mean(edges_px(8.1, body, names)[2:]) == pytest.approx(15, abs=0.11)
    names, body = without("hand", "wrist")
    assert load_box(body, names, 8.1, load_box_seen) == []
