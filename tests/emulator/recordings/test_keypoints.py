"""Keypoints of markerless trackers as JSON."""

import json

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.joint_names import BLAZEPOSE_33, BODY_25, COCO_17
from emulator.recordings.keypoints import read_json
from tests.emulator.recordings.body import body, joint, json_text
from tests.emulator.recordings.test_mapping import _blaze

TAKE = body(20, 30.0)
PLACES, NAMES = TAKE.positions_m, TAKE.names
CAMERA = PLACES @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
"""x to the right, y down, z away: as trackers have it."""


def written(tmp_path, document, name="a.json"):
    path = tmp_path / name
    path.write_text(document if isinstance(document, str) else json_text(document), encoding="utf-8")
    return path


def scored(places, score=0.9):
    return np.concatenate([places, np.full((*places.shape[:2], 1), score)], axis=-1)


@pytest.mark.parametrize(
    "document",
    [
        {"names": list(NAMES), "fps": 30, "frames": PLACES},
        {"names": list(NAMES), "fps": 30, "frames": scored(PLACES)},
        {"keypoint_names": list(NAMES), "frame_rate": 30.0, "keypoints": PLACES},
        {"fps": 30, "frames": [dict(zip(NAMES, frame)) for frame in PLACES.tolist()]},
        {"fps": 30} | {name: PLACES[:, i] for i, name in enumerate(NAMES)},
        {"fps": 30, "names": list(NAMES), "frames": [{"keypoints_3d": frame} for frame in PLACES.tolist()]},
        {"fps": 30, "names": list(NAMES), "frames": [{"people": [{"positions": f}]} for f in PLACES.tolist()]},
        {"fps": 30, "names": list(NAMES), "frames": [f.ravel() for f in PLACES]},
    ],
    ids=["lists", "scores", "keypoints", "by name", "columns", "objects", "people", "flat"],
)
def test_the_forms_are_read_alike(tmp_path, document):
    take = read_json(written(tmp_path, document))
    assert take.names == NAMES and take.rate_hz == 30.0
    assert np.allclose(take.positions_m, PLACES)


def test_world_landmarks_of_mediapipe(tmp_path):
    places = np.stack([_blaze(TAKE, name) for name in BLAZEPOSE_33], axis=1)
    camera = places @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    seen = [0.1 if name == "left_wrist" else 0.99 for name in BLAZEPOSE_33]
    frames = [
        {"poseWorldLandmarks": [dict(zip("xyz", p)) | {"visibility": score} for p, score in zip(frame, seen)]}
        for frame in camera.tolist()
    ]
    take = read_json(written(tmp_path, frames), rate_hz=30.0)
    assert take.names == BLAZEPOSE_33 and np.isnan(joint(take, "left_wrist")).all()
    assert np.allclose(np.delete(take.positions_m, 15, axis=1), np.delete(places, 15, axis=1))
    assert any("up axis found from the body: -y" in note for note in take.notes)


def test_frames_of_openpose_with_nobody_in_one(tmp_path):
    places = np.random.default_rng(0).normal(size=(5, 25, 3)) + np.array([0, 0, 1])
    frames = [{"version": 1.3, "people": [{"pose_keypoints_3d": scored(f[None])[0].ravel()}]} for f in places]
    frames[2] = {"version": 1.3, "people": []}
    take = read_json(written(tmp_path, frames), rate_hz=30.0, unit_m=1.0, up="z")
    assert take.names == BODY_25 and np.isnan(take.positions_m[2]).all()
    assert np.allclose(np.delete(take.positions_m, 2, axis=0), np.delete(places, 2, axis=0))


def test_a_known_set_is_named_by_its_number_or_by_name(tmp_path):
    path = written(tmp_path, {"fps": 30, "frames": np.ones((4, 17, 3)) * np.arange(17)[:, None]})
    take = read_json(path, unit_m=1.0, up="z")
    assert take.names == COCO_17 and "names by their number: coco-17" in take.notes
    assert read_json(path, unit_m=1.0, up="z", columns="coco-17").names == COCO_17


def test_missing_points_and_low_scores_are_gaps(tmp_path):
    frames = scored(PLACES).tolist()
    frames[1][2], frames[3][4][3], frames[5][6][0] = None, 0.05, None
    take = read_json(written(tmp_path, {"names": list(NAMES), "fps": 30, "frames": frames}))
    gaps = np.argwhere(np.isnan(take.positions_m).any(axis=-1))
    assert gaps.tolist() == [[1, 2], [3, 4], [5, 6]]


@pytest.mark.parametrize(
    ("document", "said"),
    [
        ('{"fps": 30, "frames": [', r"a.json:1:\d+: not JSON"),
        ("", r"a.json:1:1: not JSON"),
        ("[" * 100_000, "not JSON"),
        ("{}", "found no list of frames"),
        ("[]", "found no list of frames"),
        ("7", "found no list of frames"),
        ({"fps": 30, "frames": [1, 2]}, "frame 0|found nobody"),
        ({"fps": 30, "frames": PLACES[:1]}, "found 1 frame, expected 2 or more"),
        ({"frames": PLACES, "names": list(NAMES)}, "found no frame rate"),
        ({"fps": "fast", "frames": PLACES, "names": list(NAMES)}, "found 'fast' frames a second"),
        ({"fps": 30, "frames": PLACES, "names": list(NAMES[:-1])}, "found 21 points a frame, expected 20"),
        ({"fps": 30, "frames": PLACES, "names": [*NAMES[:-1], "head"]}, "found 'head' 2 times, as point "),
        ({"fps": 30, "frames": PLACES[..., :2], "names": list(NAMES)}, "frame 0: found two numbers a point"),
        ({"fps": 30, "frames": PLACES * [1, 1, 0], "names": list(NAMES)}, "found 0 in every z"),
        ({"fps": 30, "frames": [{"people": [{"pose_keypoints_2d": [1, 2, 1]}]}] * 2}, "in the plane of a picture"),
        ({"fps": 30, "frames": [{"pose_landmarks": [{"x": 0, "y": 0, "z": 0}]}] * 2}, "in the plane of a picture"),
        ({"fps": 30, "frames": [[{"x": 0, "y": 0}]] * 2}, "in the plane of a picture"),
        ({"fps": 30, "frames": [{"people": [{}, {}]}] * 2}, "frame 0: found 2 people, expected one"),
        ({"fps": 30, "frames": [{"people": []}] * 2}, "found nobody"),
        ({"fps": 30, "frames": [[["a", 1, 2]]] * 2}, "frame 0: found .* expected numbers"),
        ({"fps": 30, "frames": [[[1e99, 1, 2]]] * 2}, "expected finite numbers"),
        (
            {"fps": 30, "frames": [[[1, 1, 2]], [[1, 2, 3], [2, 3, 4]], [[1, 1, 2]]]},
            "frame 1: found 2 points, expected 1",
        ),
    ],
)
def test_what_is_wrong_is_said(tmp_path, document, said):
    with pytest.raises(RecordingError, match=said):
        read_json(written(tmp_path, document))


def test_numbers_that_json_does_not_know_are_gaps_and_no_crash(tmp_path):
    document = json.dumps({"names": list(NAMES), "fps": 30, "frames": PLACES.tolist()})
    path = written(tmp_path, document.replace(str(PLACES[0, 0, 0]), "NaN", 1))
    assert np.isnan(read_json(path).positions_m[0, 0]).any()
    path = written(tmp_path, document.replace(str(PLACES[0, 0, 0]), "Infinity", 1))
    assert np.isnan(read_json(path).positions_m[0, 0]).any()


def test_a_folder_of_frames_is_read_in_the_order_of_its_numbers(tmp_path):
    from emulator.recordings.importing import format_of, read_take

    places = np.random.default_rng(0).normal(size=(12, 25, 3)) + np.array([0, 0, 1])
    for i, points in enumerate(places):
        person = {"people": [{"pose_keypoints_3d": scored(points[None])[0].ravel().tolist()}]}
        (tmp_path / f"take_{i}_keypoints.json").write_text(json.dumps(person))
    take = read_take(tmp_path, rate_hz=30.0, unit_m=1.0, up="z")
    assert format_of(tmp_path) == "keypoint JSON" and np.allclose(take.positions_m, places)
    (tmp_path / "take_7_keypoints.json").write_text("{")
    with pytest.raises(RecordingError, match=r"take_7_keypoints.json:1:\d+: not JSON"):
        read_take(tmp_path, rate_hz=30.0)


def test_a_unit_that_nobody_knows_is_said_to_be_unknown(tmp_path):
    document = {"names": list(NAMES), "fps": 30, "unit": "furlong", "frames": PLACES}
    notes = read_json(written(tmp_path, document)).notes
    assert "the file's unit, 'furlong', is not known" in notes and not any("unit said" in note for note in notes)
    assert "unit said by the file: m" in read_json(written(tmp_path, {**document, "unit": "m"})).notes
