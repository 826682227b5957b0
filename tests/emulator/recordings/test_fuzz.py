"""Damaged BVH, ASF and AMC files: either a take of finite places, or a message with the file; never anything else.

Damaged CSV, TRC, C3D and JSON files, and wild names: a take of finite places, or a message with the file.
"""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from emulator.recordings import RecordingError
from emulator.recordings.amc import read_amc
from emulator.recordings.bvh import read_bvh, read_bvh_file
from emulator.recordings.bvh_write import write_bvh_file
from emulator.recordings.c3d import read_c3d, read_trc
from emulator.recordings.joint_names import joints_of
from emulator.recordings.keypoints import read_json
from emulator.recordings.mapping import mapped, read_mapping
from emulator.recordings.marker_csv import read_csv
from emulator.recordings.take import Take
from emulator.skeleton import CANONICAL, EXTRA
from tests.emulator.recordings.body import body, json_text, table_text, trc_text
from tests.emulator.recordings.bvh_texts import ARM, random_file, written
from tests.emulator.recordings.mutations import damaged
from tests.emulator.recordings.test_asf_amc import AMC, ASF, files
from tests.emulator.recordings.test_c3d import by_hand

MANY = settings(max_examples=250, suppress_health_check=[HealthCheck.function_scoped_fixture])
TREE = random_file(np.random.default_rng(5), n_joints=5)[0]


def held(path, read):
    """Reads, or refuses in the way that is promised."""
    try:
        take = read(path)
    except RecordingError as error:
        assert str(error).startswith(str(path.parent)) and len(str(error)) < 20_000
        return None
    assert np.all(np.isfinite(take.positions_m)) and take.n_frames > 0 and len(set(take.names)) == len(take.names)
    return take


@MANY
@given(text=damaged(ARM.encode()) | damaged(TREE.encode()) | damaged(ARM.encode("utf-16")))
def test_a_damaged_bvh_file_is_read_or_refused(tmp_path, text):
    path = written(tmp_path, text)
    held(path, read_bvh)
    if held(path, lambda path: read_bvh(path, unit_m=0.01, up="y")):
        file = read_bvh_file(path)
        write_bvh_file(file, tmp_path / "b.bvh")
        assert np.array_equal(read_bvh_file(tmp_path / "b.bvh").values, file.values)


@MANY
@given(text=damaged(ASF.encode()))
def test_a_damaged_skeleton_is_read_or_refused(tmp_path, text):
    held(files(tmp_path, asf=text), read_amc)


@MANY
@given(text=damaged(AMC.encode()))
def test_a_damaged_amc_file_is_read_or_refused(tmp_path, text):
    held(files(tmp_path, amc=text), read_amc)


def test_a_flood_of_mistakes_is_told_in_twenty_lines(tmp_path):
    """Fuzzing found 200 numbers among the bones of a skeleton, and a message of 44 kB."""
    path = files(tmp_path, asf=ASF.replace("upper fore", "upper " + "1 " * 300_000))
    with pytest.raises(RecordingError) as caught:
        read_amc(path)
    assert len(str(caught.value).splitlines()) == 20
    path = written(tmp_path, ARM.replace("OFFSET 10 0 0", "CHANNELS 1 no\n" * 30_000))
    with pytest.raises(RecordingError) as caught:
        read_bvh(path)
    assert len(str(caught.value).splitlines()) == 20


MANY_POINTS = settings(max_examples=100, suppress_health_check=[HealthCheck.function_scoped_fixture])
TAKE = body(4, 50.0)
MM = 1000 * TAKE.positions_m
CSV = table_text(["frame,time," + ",".join(f"{n}_{a}" for n in TAKE.names for a in "xyz")], MM,
                 first=np.stack([np.arange(4), np.arange(4) / 50], 1)).encode()  # fmt: skip
VICON = table_text(["Trajectories", "50", ",," + ",,,".join(TAKE.names) + ",,", "Frame,Sub Frame" + ",X,Y,Z" * 21,
                    "," + ",mm" * 63], MM, first=np.ones((4, 2)) * np.arange(4)[:, None]).encode()  # fmt: skip
TRC = trc_text(TAKE.names, MM).encode()
JSON = json_text(
    {"names": list(TAKE.names), "fps": 30, "frames": np.concatenate([MM, np.ones((4, 21, 1))], -1)}
).encode()
C3D = {
    kind: by_hand(MM, TAKE.names, processor=kind, whole=whole) for kind, whole in ((84, False), (85, True), (86, False))
}


def points_held(path, content, read):
    """Reads, or refuses in the way that is promised."""
    path.write_bytes(content)
    try:
        take = read(path)
    except RecordingError as error:
        assert str(error).startswith(str(path.parent)) and len(str(error)) < 20_000
        return
    seen = take.positions_m[np.isfinite(take.positions_m)]
    assert len(seen) and np.all(np.abs(seen) < 1e13) and len(set(take.names)) == len(take.names)
    assert take.positions_m.size < 2_000_000 and 1 <= take.rate_hz <= 10_000


@MANY_POINTS
@given(content=damaged(CSV))
def test_a_damaged_csv(tmp_path, content):
    points_held(tmp_path / "a.csv", content, lambda path: read_csv(path, unit_m=0.001, up="z"))


@MANY_POINTS
@given(content=damaged(VICON))
def test_a_damaged_csv_of_several_header_lines(tmp_path, content):
    points_held(tmp_path / "a.csv", content, read_csv)


@MANY_POINTS
@given(content=damaged(TRC))
def test_a_damaged_trc(tmp_path, content):
    points_held(tmp_path / "a.trc", content, lambda path: read_trc(path, up="z"))


@MANY_POINTS
@given(content=damaged(JSON))
def test_a_damaged_json(tmp_path, content):
    points_held(tmp_path / "a.json", content, lambda path: read_json(path, unit_m=0.001, up="z"))


@MANY_POINTS
@given(content=st.sampled_from(list(C3D.values())).flatmap(damaged))
def test_a_damaged_c3d(tmp_path, content):
    points_held(tmp_path / "a.c3d", content, lambda path: read_c3d(path, unit_m=0.001, up="z"))


@MANY_POINTS
@given(
    kind=st.sampled_from(list(C3D)), places=st.lists(st.tuples(st.integers(0, 2600), st.integers(0, 255)), max_size=16)
)
def test_a_c3d_with_other_bytes_in_its_head(tmp_path, kind, places):
    content = bytearray(C3D[kind])
    for at, value in places:
        content[at] = value
    points_held(tmp_path / "a.c3d", bytes(content), lambda path: read_c3d(path, unit_m=0.001, up="z"))


@MANY_POINTS
@given(content=st.binary(max_size=300) | damaged(b"a: left_hip\nb, right_hip\n# c\nd\thead\n"))
def test_a_damaged_mapping_file(tmp_path, content):
    path = tmp_path / "names.txt"
    path.write_bytes(content)
    try:
        mapping = read_mapping(path, ("a", "b", "d"))
    except RecordingError as error:
        assert str(error).startswith(str(path))
        return
    assert set(mapping) <= {"a", "b", "d"} and set(mapping.values()) <= {*CANONICAL, *EXTRA, "-"}


KNOWN = st.sampled_from(
    [*CANONICAL, *EXTRA, "Hips", "LeftArm", "LASI", "Bip01", "Spine1", "mixamorig:Neck", "nose", "x_end"]
)
WORDS = KNOWN | st.text(min_size=1, max_size=12)


@MANY_POINTS
@given(names=st.lists(WORDS, min_size=1, max_size=30, unique=True), tree=st.randoms())
def test_any_names_are_mapped_or_refused(names, tree):
    joints = joints_of(names)
    kept = [joint for joint in joints if joint in (*CANONICAL, *EXTRA)]
    assert len(joints) == len(names) and len(set(kept)) == len(kept)
    parents = tuple(tree.randrange(i) if i else -1 for i in range(len(names)))
    places = np.random.default_rng(len(names)).normal(size=(3, len(names), 3))
    try:
        take, report = mapped(Take(tuple(names), parents, places, 30.0), where="a.bvh")
    except RecordingError as error:
        assert str(error).startswith("a.bvh: found ")
        return
    assert take.names[0] == "pelvis" and take.parents[0] == -1 and take.parents.count(-1) == 1
    assert {row.name for row in report.rows if row.name} == set(names)


@pytest.mark.parametrize("content", [b"", b"\0" * 5000, b"\xff" * 5000, b"\xff\xfe", b"1" * 3_000_000, b",\n" * 5000])
@pytest.mark.parametrize("read", [read_csv, read_trc, read_json, read_c3d])
def test_nonsense_is_refused(tmp_path, content, read):
    path = tmp_path / "a.dat"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=r"a\.dat"):
        read(path)
