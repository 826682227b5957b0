"""ASF/AMC: an arm worked out by hand, a recording whose answer is known, and what is said of wrong files."""

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.acclaim import read_asf
from emulator.recordings.amc import read_amc, read_amc_values
from tests.naive import naive_turn
from tests.recordings import raw, recording

ASF = """# a comment
:version 1.10
:name arm
:units
  mass 1.0
  length 0.0254
  angle deg
:documentation
  two bones
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name upper
    direction 1 0 0
    length 10
    axis 0 0 0 XYZ
    dof rx ry rz
    limits (-180 180)
           (-180 180)
           (-180 180)
  end
  begin
    id 2
    name fore
    direction 1 0 0
    length 5
    axis 90 0 0 XYZ
    dof rz
  end
:hierarchy
  begin
    root upper
    upper fore
  end
"""
AMC = """#!OML:ASF arm.ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
upper 0 0 0
fore 0
2
root 0 0 0 0 0 0
upper 0 0 90
fore 90
"""


def files(folder, asf=ASF, amc=AMC):
    (folder / "arm.asf").write_bytes(asf if isinstance(asf, bytes) else asf.encode())
    (folder / "arm_wave.amc").write_bytes(amc if isinstance(amc, bytes) else amc.encode())
    return folder / "arm_wave.amc"


def refused(folder, **texts):
    with pytest.raises(RecordingError) as caught:
        read_amc(files(folder, **texts), unit_m=1.0)
    return str(caught.value).replace(str(folder) + "/", "")


def test_an_arm_is_where_it_was_worked_out_by_hand(tmp_path):
    """Raised by 90 degrees about z; the forearm bends about its own z, which is -y of the upper arm."""
    take = read_amc(files(tmp_path), unit_m=1.0, up="z")
    assert take.names == ("root", "upper", "fore") and take.parents == (-1, 0, 1)
    assert np.allclose(take.positions_m[0], [[1, 2, 3], [11, 2, 3], [16, 2, 3]], atol=1e-12)
    assert np.allclose(take.positions_m[1], [[0, 0, 0], [0, 10, 0], [0, 10, 5]], atol=1e-12)


def test_units_rate_and_skeleton_are_assumed_aloud(tmp_path):
    take = read_amc(files(tmp_path))
    assert np.allclose(take.positions_m[0, 0], [1, -3, 2]) and take.rate_hz == 120
    notes = " | ".join(take.notes)
    for said in (
        "skeleton from arm.asf",
        "unit of length 1/0.0254 inch",
        "y taken as up",
        "120 frames a second assumed",
    ):
        assert said in notes
    assert read_amc(files(tmp_path), rate_hz=60.0).rate_hz == 60
    timed = AMC.replace(":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 100")
    assert read_amc(files(tmp_path, amc=timed)).rate_hz == 100


def test_turns_go_about_x_first(tmp_path):
    take = read_amc(files(tmp_path, amc=AMC.replace("upper 0 0 0", "upper 20 30 40")), unit_m=1.0, up="z")
    turned = naive_turn("z", 40) @ naive_turn("y", 30) @ naive_turn("x", 20) @ [10, 0, 0]
    assert np.allclose(take.positions_m[0, 1] - take.positions_m[0, 0], turned)


def test_radians_are_the_same_as_degrees(tmp_path):
    degrees = read_amc(files(tmp_path)).positions_m
    radians = AMC.replace(":DEGREES", ":RADIANS").replace("90", repr(np.pi / 2))
    axis = ASF.replace("angle deg", "angle rad").replace("axis 90 0 0", f"axis {np.pi / 2!r} 0 0")
    assert np.allclose(read_amc(files(tmp_path, amc=radians, asf=axis)).positions_m, degrees, atol=1e-12)


def test_orders_of_freedoms_and_bones_do_not_matter(tmp_path):
    asf = ASF.replace("order TX TY TZ RX RY RZ", "order RZ TY RY TX RX TZ").replace("dof rx ry rz", "dof rz rx ry")
    amc = AMC.replace("root 1 2 3 0 0 0", "root 30 2 20 1 10 3").replace("upper 0 0 90", "upper 90 0 0")
    moved = read_amc(files(tmp_path, asf=asf, amc=amc)).positions_m
    plain = read_amc(files(tmp_path, amc=AMC.replace("root 1 2 3 0 0 0", "root 1 2 3 10 20 30"))).positions_m
    assert np.allclose(moved, plain, atol=1e-12)


def test_bones_may_come_before_their_parents(tmp_path):
    first, second = ASF.index("  begin\n    id 1"), ASF.index("  begin\n    id 2")
    end = ASF.index(":hierarchy")
    take = read_amc(files(tmp_path, asf=ASF[:first] + ASF[second:end] + ASF[first:second] + ASF[end:]), unit_m=1.0)
    assert take.names == ("root", "fore", "upper") and take.parents == (-1, 2, 0)
    assert np.allclose(take.positions_m[:, [0, 2, 1]], read_amc(files(tmp_path), unit_m=1.0).positions_m)


def test_a_skeleton_is_found_by_name_or_alone(tmp_path):
    amc = files(tmp_path)
    (tmp_path / "arm_wave.asf").write_text(ASF.replace("length 10", "length 20"))
    (tmp_path / "other.asf").write_text("")
    assert np.allclose(read_amc(amc, unit_m=1.0, up="z").positions_m[0, 1], [21, 2, 3])
    assert np.allclose(read_amc(amc, unit_m=1.0, up="z", asf=tmp_path / "arm.asf").positions_m[0, 1], [11, 2, 3])
    alone = amc.rename(tmp_path / "x.amc")
    with pytest.raises(RecordingError, match=r"x\.amc: found arm\.asf, arm_wave\.asf, other\.asf beside it"):
        read_amc(alone)


@pytest.mark.parametrize("encoding", ["latin-1", "utf-8-sig", "utf-16"])
def test_any_encoding_reads_the_same(tmp_path, encoding):
    texts = {
        "asf": ASF.replace("two", "zw\u00f6lf"),
        "amc": AMC.replace("arm.ASF", "f\u00fcr.ASF").replace("\n", "\r\n"),
    }
    read = read_amc(files(tmp_path, **{key: text.encode(encoding) for key, text in texts.items()})).positions_m
    assert np.array_equal(read, read_amc(files(tmp_path)).positions_m)


def test_a_known_recording_is_read_to_its_rounding():
    take = read_amc(raw("HDM_bd_depositFloorR_001_120.amc"))
    known = np.load(recording("hdm05_deposit_floor"))
    assert (known["subject"][0], known["trial"][0]) == ("bd", "001") and known["fps"] == take.rate_hz / 2
    assert take.names == tuple(known["names"]) and take.parents == tuple(known["parents"])
    assert np.abs(take.positions_m[::2] - known["positions"][: known["offsets"][1]]).max() < 0.0001
    assert take.n_frames == 301


def test_bones_of_a_skeleton_never_change_their_length():
    take = read_amc(raw("HDM_bd_depositFloorR_001_120.amc"))
    bones = np.linalg.norm(take.positions_m[:, 1:] - take.positions_m[:, list(take.parents[1:])], axis=2)
    assert np.ptp(bones, axis=0).max() < 1e-12
    wanted = [bone.length * 0.0254 / 0.45 for bone in read_asf(raw("HDM_bd.asf")).bones[1:]]
    assert np.allclose(bones[0], wanted, rtol=2e-6)  # directions have six digits


WRONG_SKELETONS = {
    "empty": ("", "arm.asf:1: found the end without :root"),
    "another file": ("HIERARCHY\nROOT", "arm.asf:1: found 'HIERARCHY', expected an ASF skeleton"),
    "a number": (ASF.replace("length 10", "length ten"), "arm.asf:20: length: found 'ten', expected 1 number"),
    "a length below none": (ASF.replace("length 10", "length -1"), "arm.asf:20: length: found -1, expected 0 or more"),
    "nan": (
        ASF.replace("direction 1 0 0", "direction nan 0 0", 1),
        "arm.asf:19: direction: found 'nan 0 0', expected 3",
    ),
    "no length": (ASF.replace("    length 5\n", ""), "arm.asf:33: found no length of bone 'fore', expected one"),
    "a freedom": (ASF.replace("dof rz", "dof tq"), "arm.asf:33: found freedoms 'tq', expected some of rx, ry, rz"),
    "an order": (ASF.replace("axis 90 0 0 XYZ", "axis 90 0 0 XXZ"), "arm.asf:32: axis: found 'XXZ', expected an order"),
    "a bone twice": (ASF.replace("name fore", "name upper"), "arm.asf:34: found bone 'upper' again"),
    "an unknown bone": (
        ASF.replace("upper fore", "upper four"),
        "arm.asf:38: found no bone 'four'; did you mean 'fore'?",
    ),
    "two parents": (
        ASF.replace("root upper", "root upper fore"),
        "arm.asf:38: found 'fore' below 'upper', expected it once",
    ),
    "a cycle": (
        ASF.replace("root upper\n", "root\n").replace("upper fore", "upper fore\n    fore upper"),
        "arm.asf:39: found 'upper' to be its own ancestor, expected a tree below the root",
    ),
    "a bone below itself": (
        ASF.replace("root upper\n", "root\n").replace("upper fore", "upper upper\n root fore"),
        "arm.asf:38: found 'upper' to be its own ancestor",
    ),
    "left out": (ASF.replace("    upper fore\n", ""), "found 'fore' below no bone, expected it in :hierarchy"),
    "the root below": (ASF.replace("upper fore", "upper root"), "arm.asf:38: found 'root' below 'upper'"),
    "cut": (ASF[: ASF.index("  end\n:hier")], "found no end of bone 'fore', expected 'end'"),
    "cut before": (ASF[: ASF.index(":hierarchy")], "found the end without :hierarchy, expected an ASF skeleton"),
    "a unit of nothing": (ASF.replace("length 0.0254", "length 0"), "arm.asf:6: length: found 0, expected a positive"),
}  # fmt: skip
WRONG_MOTIONS = {
    "empty": ("", "arm_wave.amc:1: found no frame, expected a line with its number"),
    "no frames": (AMC[: AMC.index("1\n")], "found no frame"),
    "text": (AMC.replace("upper 0 0 90", "upper 0 x 90"), "arm_wave.amc:10: found 'x', expected a number"),
    "nan": (AMC.replace("upper 0 0 90", "upper 0 nan 90"), "arm_wave.amc:10: found 'nan', expected a number"),
    "too few": (AMC.replace("upper 0 0 90", "upper 0 0"), "arm_wave.amc:10: found 2 values of 'upper', expected 3"),
    "an unknown bone": (AMC.replace("fore 90", "four 90"), "arm_wave.amc:11: found 'four', did you mean 'fore'?"),
    "a bone twice": (AMC.replace("fore 90", "upper 1 1 1"), "arm_wave.amc:11: found 'upper' again in frame 2"),
    "cut": (AMC[: AMC.index("fore 90")], "arm_wave.amc:10: found the end of frame 2 without fore, expected all"),
    "a frame left out": (AMC.replace("\n2\n", "\n3\n"), "arm_wave.amc:8: found frame '3' after 1, expected 2"),
    "values first": (AMC.replace("\n1\n", "\n"), "arm_wave.amc:4: found 'root 1 2 3 0 0 0', expected a frame's number"),
    "a rate": (":SAMPLES-PER-SECOND fast\n" + AMC, "arm_wave.amc:1: found 'fast' samples a second, expected a"),
    "frames beyond numbers": (AMC.replace("\n2\n", "\n" + "9" * 5000 + "\n"), "arm_wave.amc:8: found frame '999"),
    "a huge line": (AMC + "fore " + "1" * 3_000_000, "arm_wave.amc:12: found a line of more than 1 MB"),
}  # fmt: skip


@pytest.mark.parametrize("what", WRONG_SKELETONS)
def test_a_wrong_skeleton_is_told_with_its_line(tmp_path, what):
    asf, said = WRONG_SKELETONS[what]
    assert said in refused(tmp_path, asf=asf)


@pytest.mark.parametrize("what", WRONG_MOTIONS)
def test_a_wrong_motion_is_told_with_its_line(tmp_path, what):
    amc, said = WRONG_MOTIONS[what]
    assert said in refused(tmp_path, amc=amc)


def test_all_mistakes_of_a_skeleton_are_told_at_once(tmp_path):
    asf = ASF.replace("length 10", "length ten").replace("dof rz\n", "dof tq\n").replace("name fore", "name upper")
    assert [line.split(":")[1] for line in refused(tmp_path, asf=asf).splitlines()] == ["20", "33", "34", "38"]


def test_a_bone_without_freedoms_has_no_values(tmp_path):
    asf = ASF.replace("    dof rz\n", "")
    assert "expected no values: the skeleton gives this bone no dof" in refused(tmp_path, asf=asf)
    skeleton = read_asf(files(tmp_path, asf=asf).with_name("arm.asf"))
    plain = AMC.replace("fore 0\n", "").replace("fore 90\n", "")
    assert read_amc_values(files(tmp_path, amc=plain), skeleton).values.shape == (2, 9)


def test_depth_of_nesting_costs_nothing(tmp_path):
    n = 1500
    bones = "".join(f"begin\nname b{i}\ndirection 0 1 0\nlength 1\nend\n" for i in range(n))
    below = "".join(f"b{i - 1} b{i}\n" for i in range(1, n))
    asf = ASF[: ASF.index("  begin")] + bones + ":hierarchy\nbegin\nroot b0\n" + below + "end\n"
    take = read_amc(files(tmp_path, asf=asf, amc=":DEGREES\n1\nroot 0 0 0 0 0 0\n"), unit_m=0.001, up="y")
    assert take.positions_m[0, -1, 2] == pytest.approx(n / 1000)
