import numpy as np
import pytest
from scipy.spatial import ConvexHull

from emulator.geometry.centre_of_mass import centre_of_mass_m
from emulator.judge.feet import (
    SOLE_M,
    distance_to_polygon,
    feet,
    footing,
    planted_joints,
    runs,
    standing_m,
    unsupported,
)
from tests.emulator.judge.made_clips import FEET, NO_FEET, ONE_FOOT, SKELETON, clips, still

HIGH = [j for j, name in enumerate(SKELETON.names) if "ankle" not in name and "toe" not in name]


def slid(way_m, n_times=121, begin=0.25, end=0.75):
    """The left foot goes ``way_m`` along x, evenly between two times of the two seconds."""
    body = still(n_times)
    share = np.clip((np.linspace(0, 1, n_times) - begin) / (end - begin), 0, 1)
    body[:, FEET["left"], 0] += way_m * share[:, None]
    return body


def test_who_stands_neither_strays_nor_slides_nor_sinks():
    found = footing(clips(still()))
    assert found.planted.tolist() == [1] and found.sunk_mm.tolist() == [0]
    assert np.allclose([found.wander_cm, found.slide_cm], 0)


def test_a_foot_that_slides_by_3_cm_slides_by_3_cm():
    found = footing(clips(slid(0.03)))
    assert np.isclose(found.slide_cm[0], 1.5, atol=0.01)  # the mean of the foot that slides and the one that does not
    both = slid(0.03)
    both[:, FEET["right"], 0] += slid(0.03)[:, FEET["left"], 0] - still()[:, FEET["left"], 0]
    found = footing(clips(both))
    assert np.isclose(found.slide_cm[0], 3, atol=0.01) and np.isclose(found.wander_cm[0], 1.5, atol=0.05)


def test_a_foot_that_is_lifted_and_put_down_elsewhere_does_not_slide():
    body, share = still(), np.linspace(0, 1, 121)
    swing = np.clip((share - 0.35) / 0.3, 0, 1)
    body[:, FEET["left"], 0] += 0.6 * (swing**2 * (3 - 2 * swing))[:, None]
    body[:, FEET["left"], 2] += 0.3 * np.sin(np.pi * swing)[:, None]
    down = planted_joints(body, 2 / 120, FEET["left"])[:, 0]
    assert len(runs(down)) == 2 and not down[50:70].any()
    assert footing(clips(body)).slide_cm[0] < 1.5


def test_a_quick_touch_is_no_stance():
    body = still()
    body[:, FEET["left"], 2] += 0.3
    body[60:64, FEET["left"], 2] -= 0.3
    assert not planted_joints(body, 2 / 120, FEET["left"]).any()


def test_a_joint_below_where_it_stands_is_in_the_floor():
    deep = still()
    deep[40:80, FEET["right"][1], 2] -= 0.02
    recorded = clips(still())
    assert np.isclose(footing(clips(deep), standing_m(recorded)).sunk_mm[0], 20)
    hands = still()
    hands[:, SKELETON.index("left_hand"), 2] = 0.0  # on the floor, as low as the toes, not below
    assert footing(clips(hands), standing_m(recorded)).sunk_mm[0] == 0


def test_feet_in_the_air_all_along_are_never_planted():
    jumps = still()
    jumps[..., 2] += 0.2 * np.sin(np.linspace(0, 60, 121))[:, None]
    found = footing(clips(jumps))
    assert found.planted[0] == 0 and np.isnan(found.wander_cm[0]) and np.isnan(found.slide_cm[0])


def test_no_feet_are_not_measured_and_one_foot_is():
    assert feet(NO_FEET) == [] and feet(ONE_FOOT) == [[3]]
    nothing = footing(clips(np.random.default_rng(0).normal(size=(30, 3, 3)), skeleton=NO_FEET))
    assert all(np.isnan(getattr(nothing, part)).all() for part in ("planted", "wander_cm", "slide_cm", "sunk_mm"))
    leg = np.repeat(np.array([[[0, 0, 0.9], [0, 0.1, 0.9], [0, 0.1, 0.5], [0, 0.1, 0.1]]]), 60, axis=0)
    assert footing(clips(leg, skeleton=ONE_FOOT)).planted[0] == 1


def test_the_centre_of_mass_of_one_who_stands_is_between_the_feet_at_hip_height():
    x, y, z = centre_of_mass_m(SKELETON, still(1)[0])
    assert abs(y) < 1e-9 and 0 <= x < 0.01 and 0.9 < z < 1.1
    with pytest.raises(ValueError, match="the skeleton has no neck, head"):
        centre_of_mass_m(NO_FEET, np.zeros((3, 3)))


def test_a_body_that_leans_is_off_its_feet_for_as_long_as_it_leans():
    leaning = still()
    leaning[30:91, HIGH, 1] += 0.3  # its centre is 27 cm beside the middle, the left foot 10 cm
    found = unsupported(clips(still(), leaning))
    assert found[0] == 0 and np.isclose(found[1], 61 / 121, atol=0.01)


def test_the_distance_to_a_polygon_is_that_of_its_hull():
    rng = np.random.default_rng(1)
    corners, points, there = rng.normal(size=(200, 6, 2)), 1.5 * rng.normal(size=(200, 2)), rng.random((200, 6)) < 0.8
    there[:, :3] = True
    found = distance_to_polygon(points, corners, there)
    assert np.allclose(found, [naive_distance(p, c[t]) for p, c, t in zip(points, corners, there)])
    assert 0.1 < np.mean(found == 0) < 0.9


def test_a_foot_of_one_joint_is_a_point_and_two_are_a_line():
    at = np.array([[0.3, 0.0]])
    point, line = np.array([[[0.0, 0.0]]]), np.array([[[0.0, -1.0], [0.0, 1.0]]])
    assert np.allclose([distance_to_polygon(at, one, np.ones(one.shape[:2], bool)) for one in (point, line)], 0.3)
    assert SOLE_M < 0.3


def naive_distance(point, corners):
    """Of a point (2,) to the hull of corners (F, 2): by its edges, one after another."""
    hull = ConvexHull(corners)
    if (hull.equations[:, :2] @ point + hull.equations[:, 2] <= 0).all():
        return 0.0
    ends = [(corners[i], corners[j]) for i, j in hull.simplices]
    ways = ((a, b - a, np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)) for a, b in ends)
    return min(float(np.linalg.norm(a + along * way - point)) for a, way, along in ways)
