"""Joints of a file to canonical ones: kept, made, left out, unknown; marker sets; mapping files."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.importing import read_take
from emulator.recordings.joint_names import BLAZEPOSE_33, KINECT_20, KINECT_25, KINECT_32, joints_of
from emulator.recordings.mapping import NEEDED, mapped
from emulator.recordings.markers import PLUG_IN_GAIT
from emulator.recordings.npz import read_recording
from emulator.recordings.take import Take
from emulator.skeleton import CANONICAL, EXTRA, Skeleton, standard_skeleton
from tests.emulator.recordings.body import body, joint, points
from tests.recordings import data_folder, recording


def renamed(take, **names):
    return replace(take, names=tuple(names.get(name, name) for name in take.names))


def raw(name):
    path = data_folder() / "motion" / "raw" / name
    if not path.exists():
        pytest.skip(f"needs motion/raw/{name} in ../shared/data or in $OPSIM_DATA")
    return path


def test_canonical_joints_stay_what_they_are():
    take, report = mapped(body())
    assert (take.names, take.parents) == (standard_skeleton().names, standard_skeleton().parents)
    assert np.array_equal(take.positions_m, body().positions_m) and report.summary() == "21 kept"


def test_every_canonical_name_is_known_by_itself():
    take = body()
    for extra in EXTRA:
        here = Take(
            (*take.names, extra), None, np.concatenate([take.positions_m, joint(take, "head")[:, None] + 1], 1), 50.0
        )
        assert extra in mapped(here)[0].names


def test_the_markers_of_a_raw_file_give_the_joints_of_the_shared_recording():
    path = raw("uiprmd_vicon_m05_s01_e02_positions.csv")
    take, report = mapped(read_take(path, columns="plug-in-gait", rate_hz=100.0))
    known = next(t for t in read_recording(recording("uiprmd_sit_to_stand")).takes if t.name == "s01/e02")
    assert set(take.names) == set(known.names) and take.n_frames == 315 and known.n_frames == 158
    apart = np.linalg.norm(points(take, known.names)[::2] - known.positions_m, axis=-1).max()
    assert apart < 0.0001  # rounded to 0.1 mm there; hips use the mean over all frames here, every second there
    assert len(report.of("made")) == 21 and {row.name for row in report.of("left out")} >= {"LTHI", "RBAK", "LHEE"}


def test_the_amc_gives_the_joints_of_the_shared_recording():
    take, report = mapped(read_take(raw("HDM_bd_depositFloorR_001_120.amc")))
    known = read_recording(recording("hdm05_deposit_floor")).takes[0]
    assert set(known.names) <= set(take.names)
    assert {row.name for row in report.of("left out")} == {"lwrist", "rwrist"}


def test_a_left_out_joint_hands_its_children_to_its_parent():
    take = body()
    take = renamed(take, chest="thing")
    kept, report = mapped(take)
    assert "chest" not in kept.names
    assert kept.parents[kept.names.index("neck")] == kept.names.index("spine")
    assert [(row.name, row.became) for row in report.rows if row.name == "thing"] == [("thing", "unknown")]
    assert np.array_equal(joint(kept, "left_toe"), joint(take, "left_toe"))


def test_an_unknown_name_is_said_with_the_nearest():
    _, report = mapped(renamed(body(), left_hand="left_hnad"))
    assert report.of("unknown")[0].why == "nearest: left_hand"


def test_pelvis_neck_and_head_are_made_where_a_tracker_has_none():
    take = body()
    places = np.stack([_blaze(take, name) for name in BLAZEPOSE_33], axis=1)
    made, report = mapped(Take(BLAZEPOSE_33, None, places, 30.0))
    assert [row.joint for row in report.of("made")] == ["pelvis", "neck", "head", "left_hand", "right_hand"]
    assert np.allclose(joint(made, "pelvis"), (joint(take, "left_hip") + joint(take, "right_hip")) / 2)
    middle = (joint(take, "left_shoulder") + joint(take, "right_shoulder")) / 2
    assert np.linalg.norm(joint(made, "neck") - middle, axis=-1).max() < 0.02
    assert made.parents[made.names.index("head")] == made.names.index("neck")
    assert set(NEEDED) <= set(made.names)


def _blaze(take, name):
    side = "left" if "left" in name else "right"
    word = name.replace("left_", "").replace("right_", "").replace("_left", "").replace("_right", "")
    here = {"foot_index": f"{side}_toe", "heel": f"{side}_ankle", "index": f"{side}_hand", "pinky": f"{side}_hand"}
    off = (0.0, 0.02 if side == "left" else -0.02, -0.05 if word == "heel" else 0.0)
    if f"{side}_{word}" in take.names:
        return joint(take, f"{side}_{word}")
    return joint(take, here.get(word, "head")) + np.array(off)


def test_without_hips_there_is_no_heading_and_it_is_said():
    with pytest.raises(RecordingError) as error:
        mapped(renamed(body(), left_hip="thing", right_hip="othing"), where="a.bvh")
    assert "a.bvh: found no left_hip, right_hip" in str(error.value) and "'thing'" in str(error.value)
    assert "--map" in str(error.value)


def test_joints_at_one_place_have_no_bone_between_them():
    take = body()
    names = (*take.names, "left_clavicle")
    places = np.concatenate([take.positions_m, joint(take, "chest")[:, None]], axis=1)
    kept, report = mapped(Take(names, (*take.parents, take.names.index("chest")), places, 50.0))
    assert "left_clavicle" not in kept.names and report.of("left out")[0].why == "no bone to it"
    Skeleton(kept.names, kept.parents).directions(kept.positions_m)


def test_of_two_joints_at_one_place_the_needed_one_stays():
    take = body()
    take = replace(take, positions_m=points(take, [n if n != "spine" else "pelvis" for n in take.names]))
    kept, _ = mapped(take)
    assert "spine" not in kept.names and "pelvis" in kept.names


def test_a_mapping_file_names_what_the_rules_do_not(tmp_path):
    take = renamed(body(), left_hip="A:bone 7", right_hip="bone8", left_hand="thing")
    file = tmp_path / "names.txt"
    file.write_text("# ours\nname,joint\nA:bone 7: left_hip\nbone8,right_hip\nthing: -\n", encoding="utf-8")
    kept, report = mapped(take, file)
    assert np.array_equal(joint(kept, "left_hip"), joint(body(), "left_hip")) and "left_hand" not in kept.names
    assert [row.why for row in report.of("left out")] == ["mapping file"]


def test_a_mapping_file_overrules_the_rules(tmp_path):
    file = tmp_path / "names.txt"
    file.write_text("left_knee: right_knee\nright_knee: left_knee\n")
    kept, _ = mapped(body(), file)
    assert np.array_equal(joint(kept, "left_knee"), joint(body(), "right_knee"))


def test_all_mistakes_of_a_mapping_file_are_said_at_once(tmp_path):
    file = tmp_path / "names.txt"
    file.write_text("left_hipp: left_hip\nleft_knee: left_kne\nhead\nneck: neck\nneck: head\n")
    with pytest.raises(RecordingError) as error:
        mapped(body(), file)
    lines = str(error.value).split("\n")
    assert [line.split("names.txt:")[1].split(":")[0] for line in lines] == ["1", "2", "3", "5"]
    assert "did you mean 'left_hip'?" in lines[0] and "did you mean 'left_knee'?" in lines[1]
    assert "a second time" in lines[3]


def test_an_empty_mapping_file_is_refused(tmp_path):
    (tmp_path / "names.txt").write_text("# nothing\n")
    with pytest.raises(RecordingError, match="found no line"):
        mapped(body(), tmp_path / "names.txt")


def test_markers_on_the_inner_side_make_the_joint_their_middle():
    take = body()
    names, places = [], []
    for marker in PLUG_IN_GAIT:
        names.append(f"Ana:{marker}")
        places.append(joint(take, "pelvis") + len(names) * np.array([0.01, 0.02, 0.03]))
    names += ["Ana:LMKNE"]
    places += [places[names.index("Ana:LKNE")] + np.array([0, -0.1, 0])]
    made, _ = mapped(Take(tuple(names), None, np.stack(places, axis=1), 100.0))
    assert np.allclose(joint(made, "left_knee"), places[names.index("Ana:LKNE")] + np.array([0, -0.05, 0]))


@pytest.mark.parametrize("person", ["", "Ana:", "Ana_", "x_"])
def test_markers_of_qualisys_and_optitrack_make_the_same_joints(person):
    alike = {
        "HeadL": "LFHD", "HeadR": "RFHD", "SpineTop": "C7", "WaistLFront": "LASI", "WaistRFront": "RASI",
        "WaistLBack": "LPSI", "WaistRBack": "RPSI", "LShoulderTop": "LSHO", "RShoulderTop": "RSHO", "LElbowOut": "LELB",
        "RElbowOut": "RELB", "LWristOut": "LWRA", "LWristIn": "LWRB", "RWristOut": "RWRA", "RWristIn": "RWRB",
        "LKneeOut": "LKNE", "RKneeOut": "RKNE", "LAnkleOut": "LANK", "RAnkleOut": "RANK", "LToeTip": "LTOE",
        "RToeTip": "RTOE",
    }  # fmt: skip
    places = np.random.default_rng(1).normal(size=(3, len(alike), 3))
    ours, _ = mapped(Take(tuple(alike.values()), None, places, 100.0))
    theirs, _ = mapped(Take(tuple(person + name for name in alike), None, places, 100.0))
    assert ours.names == theirs.names and len(ours.names) > 14
    assert np.array_equal(ours.positions_m, theirs.positions_m)


def test_hips_lie_between_and_below_the_pelvis_markers_as_harrington_says():
    from emulator.recordings.markers import hip_centres

    front, back = np.array([0.1, 0.0, 1.0]), np.array([-0.1, 0.0, 1.0])
    side = np.array([0.0, 0.125, 0.0])
    markers = {"LASI": front + side, "RASI": front - side, "LPSI": back + side / 3, "RPSI": back - side / 3}
    left, right = hip_centres({name: place[None] for name, place in markers.items()})
    expected = [0.1 - 0.24 * 0.2 - 0.0099, 0.33 * 0.25 + 0.0073, 1.0 - 0.30 * 0.25 - 0.0109]
    assert np.allclose(left[0], expected) and np.allclose(right[0], expected * np.array([1, -1, 1]))


def test_two_bodies_are_not_made_one():
    take = body()
    names = tuple(f"{who}:{name}" for who in ("Ana", "Ben") for name in take.names)
    both = Take(names, None, np.concatenate([take.positions_m, take.positions_m + 1], axis=1), 50.0)
    with pytest.raises(RecordingError, match=r"a\.c3d: found points of 2 bodies \(Ana, Ben\), expected one"):
        mapped(both, where="a.c3d")


def test_gaps_stay_gaps():
    take = body()
    holes = take.positions_m.copy()
    holes[3, take.names.index("left_hip")] = np.nan
    kept, _ = mapped(replace(take, positions_m=holes))
    assert np.isnan(joint(kept, "left_hip")[3]).all() and np.isnan(kept.positions_m).sum() == 3


def test_the_joints_come_in_one_order_whatever_the_file_has():
    take = body()
    order = np.random.default_rng(2).permutation(len(take.names))
    shuffled = Take(tuple(take.names[i] for i in order), None, take.positions_m[:, order], 50.0)
    assert mapped(shuffled)[0].names == CANONICAL


KINECT = {
    "the first": KINECT_20,
    "the first, in British letters": [name.lower().replace("center", "centre") for name in KINECT_20],
    "the second": KINECT_25,
    "the second, as JointType": [f"JointType_{name}" for name in KINECT_25],
    "Azure": KINECT_32,
    "Azure, by its constants": [f"K4ABT_JOINT_{name}" for name in KINECT_32],
}


@pytest.mark.parametrize("names", KINECT.values(), ids=KINECT)
def test_every_joint_of_a_kinect_is_known(names):
    joints = joints_of(names)
    assert all(joints)
    assert set(NEEDED) - {"pelvis"} <= set(joints)
    ours = dict(zip(joints, (name.upper().replace("_", "") for name in names)))
    assert ours["left_toe"].endswith("FOOTLEFT")
    assert ours["spine"].endswith(("SPINE", "SPINEMID", "SPINENAVEL"))
    assert ours["neck"].endswith(("NECK", "SHOULDERCENTER", "SHOULDERCENTRE"))
    fingers = [joint for joint in joints if joint.endswith("_fingers")]
    assert len(fingers) == (2 if len(names) > 20 else 0)


def shrugging(trunk):
    """A body without neck whose shoulders rise and close and whose head nods; with these trunk joints."""
    take, up = body(), 0.5 - 0.5 * np.cos(np.linspace(0, 2 * np.pi, 60))[:, None]
    keep = [n for n in take.names if n != "neck" and (n in trunk or n not in ("spine", "chest"))]
    places = points(take, keep)
    for name, side in (("left_shoulder", -1.0), ("right_shoulder", 1.0)):
        places[:, keep.index(name)] += up * [0.01, 0.03 * side, 0.04]
    places[:, keep.index("head")] += up * [0.03, 0.0, -0.01]
    return Take(tuple(keep), None, places, 50.0)


@pytest.mark.parametrize(("trunk", "below"), [((), "pelvis"), (("spine",), "spine"), (("spine", "chest"), "chest")])
def test_a_made_neck_keeps_its_bone_and_breathes_less_towards_the_head_than_the_middle_of_the_shoulders(trunk, below):
    take = shrugging(trunk)
    made, report = mapped(take)
    neck, middle = joint(made, "neck"), points(take, [("left_shoulder", "right_shoulder")])[:, 0]
    assert made.names[made.parents[made.names.index("neck")]] == below
    assert np.ptp(np.linalg.norm(neck - joint(made, below), axis=-1)) < 1e-12
    ours, middles = (np.std(np.linalg.norm(joint(made, "head") - each, axis=-1)) for each in (neck, middle))
    assert ours < 0.5 * middles
    assert np.abs(np.diff(neck, 2, axis=0)).max() < 2 * np.abs(np.diff(middle, 2, axis=0)).max() + 1e-3
    assert report.of("made")[0].why == f"middle of left_shoulder and right_shoulder, at a steady way from {below}"


def test_a_made_neck_is_a_gap_where_a_shoulder_is_and_nowhere_else():
    take = shrugging(("spine", "chest"))
    places = take.positions_m.copy()
    places[5, take.names.index("left_shoulder")] = np.nan
    places[9, take.names.index("head")] = np.nan
    places[12, take.names.index("chest")] = np.nan
    neck = joint(mapped(replace(take, positions_m=places))[0], "neck")
    assert np.flatnonzero(np.isnan(neck).any(axis=-1)).tolist() == [5]
