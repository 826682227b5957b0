"""BVH read: places worked out by hand, the naive twin, and what is said of files that are wrong."""

import re
import tracemalloc

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.bvh import bvh_positions, rate_of, read_bvh, read_bvh_file
from tests.emulator.recordings.bvh_texts import ARM, random_file, written
from tests.naive import naive_hierarchy
from tests.recordings import raw


def refused(folder, text, name="a.bvh"):
    with pytest.raises(RecordingError) as caught:
        read_bvh(written(folder, text, name), unit_m=1.0, up="y")
    return str(caught.value).replace(str(folder) + "/", "")


def test_an_arm_is_where_it_was_worked_out_by_hand(tmp_path):
    file = read_bvh_file(written(tmp_path, ARM))
    names, parents, places = bvh_positions(file)
    assert names == ("Hips", "Elbow", "Elbow_end") and parents == (-1, 0, 1)
    assert np.allclose(places[0], [[1, 2, 3], [11, 2, 3], [16, 2, 3]], atol=1e-12)
    assert np.allclose(places[1], [[0, 0, 0], [0, 10, 0], [0, 10, -5]], atol=1e-12)


def test_a_take_is_in_metres_with_z_up_and_says_what_it_did(tmp_path):
    take = read_bvh(written(tmp_path, ARM, "wave.bvh"), unit_m=0.01, up="y")
    assert np.allclose(take.positions_m[0], [[0.01, -0.03, 0.02], [0.11, -0.03, 0.02], [0.16, -0.03, 0.02]])
    assert (take.rate_hz, take.trial, take.n_frames) == (100.0, "wave", 2)


def test_position_channels_replace_the_offset_along_their_axis(tmp_path):
    text = ARM.replace("CHANNELS 3 Zrotation Xrotation Yrotation", "CHANNELS 2 Yposition Zrotation")
    text = text.replace("1 2 3 0 0 0 0 0 0\n0 0 0 90 0 0 0 0 90", "0 0 0 0 0 0 7 90\n0 0 0 0 0 0 0 0")
    take = read_bvh(written(tmp_path, text), unit_m=1.0, up="z")
    assert np.allclose(take.positions_m[0], [[0, 0, 0], [10, 7, 0], [10, 12, 0]], atol=1e-12)
    assert any("1 joints below the root have position channels" in note for note in take.notes)


@pytest.mark.parametrize("seed", range(8))
def test_any_channels_in_any_order_are_the_naive_walk(tmp_path, seed):
    text, parents, offsets, channels, values = random_file(np.random.default_rng(seed))
    file = read_bvh_file(written(tmp_path, text))
    assert file.parents == parents and list(file.channels) == channels
    assert np.array_equal(file.values, values) and np.array_equal(file.offsets, offsets)
    naive = [naive_hierarchy(parents, offsets, channels, frame) for frame in values]
    assert np.allclose(bvh_positions(file)[2], naive, atol=1e-9)


def test_end_sites_without_length_are_dropped_and_said(tmp_path):
    take = read_bvh(written(tmp_path, ARM.replace("OFFSET 5 0 0", "OFFSET 0 0 0")), unit_m=0.01, up="y")
    assert take.names == ("Hips", "Elbow") and "1 End Site without length dropped" in take.notes


def test_ends_of_one_joint_have_names_of_their_own(tmp_path):
    end = "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 5 0 0\n\t\t}\n"
    take = read_bvh(written(tmp_path, ARM.replace(end, 2 * end)), unit_m=0.01, up="y")
    assert take.names == ("Hips", "Elbow", "Elbow_end", "Elbow_end2")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "latin-1"])
@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_any_encoding_and_line_ending_reads_the_same(tmp_path, encoding, ending):
    text = ARM.replace("Elbow", "Ellenb\u00f6gen").replace("\n", ending)
    file = read_bvh_file(written(tmp_path, text.encode(encoding)))
    assert file.names == ("Hips", "Ellenb\u00f6gen")
    assert np.array_equal(file.values, read_bvh_file(written(tmp_path, ARM)).values)


def test_numbers_are_read_to_the_last_bit(tmp_path):
    rng = np.random.default_rng(0)
    numbers = [
        *map(repr, (rng.normal(size=400) * 10.0 ** rng.integers(-12, 12, 400)).tolist()),
        *(f"{v:.6f}" for v in rng.normal(size=400) * 100),
        *("0", "-0.0", "+5", ".5", "5.", "1e5", "1E-5", "-2.50000000000000000000000", "9007199254740993", "1e-320"),
    ]
    numbers = numbers[: len(numbers) // 9 * 9]
    rows = "\n".join(" ".join(numbers[i : i + 9]) for i in range(0, len(numbers), 9))
    text = ARM[: ARM.index("1 2 3")].replace("Frames: 2", f"Frames: {len(numbers) // 9}") + rows
    values = read_bvh_file(written(tmp_path, text)).values.ravel()
    assert np.array_equal(values, [float(word) for word in numbers])
    assert np.array_equal(np.signbit(values), [word.startswith("-") for word in numbers])


@pytest.mark.parametrize("block", [1, 2, 7, 64, 1000])
def test_blocks_may_end_anywhere(tmp_path, block):
    from emulator.recordings.bvh import opened, read_values

    for ending in ("\n", "\r\n"):
        path = written(tmp_path, ARM.replace("\n", ending))
        head, blocks = opened(path, block)
        assert np.array_equal(read_values(path, head, blocks, 9), read_bvh_file(path).values)


@pytest.mark.parametrize(
    ("frame_time_s", "rate_hz"),
    [(0.0333333, 30), (0.033333, 30), (0.00833333, 120), (0.0083333, 120), (0.01, 100), (0.04, 25), (1 / 29.97, 29.97),
     (0.0333667, 30000 / 1001), (0.5, 2), (0.0416667, 24)],
)  # fmt: skip
def test_a_rounded_frame_time_is_the_usual_rate(frame_time_s, rate_hz):
    assert rate_of(frame_time_s) == pytest.approx(rate_hz, rel=1e-12)


MISTAKES = {
    "an empty file": ("", "a.bvh:1: found no MOTION, expected HIERARCHY and MOTION; the file is empty"),
    "another file": ("PK\x03\x04 what\n", "a.bvh:1: found no MOTION"),
    "cut in the hierarchy": (ARM[:200], "a.bvh:11: found no MOTION"),
    "cut in a frame": (ARM[:-8], "a.bvh:20: found 6 values, expected 9, one for each channel"),
    "cut between frames": (ARM[: ARM.index("0 0 0 90")], "a.bvh:20: found the end after 1 frames, line 17 declares 2"),
    "a frame too many": (ARM + "0 0 0 0 0 0 0 0 0\n", "a.bvh:21: found another frame, expected 2 as line 17 says"),
    "a value too many": (ARM.replace("1 2 3 0", "1 2 3 0 0"), "a.bvh:19: found more than 9 values, expected 9"),
    "text in numbers": (ARM.replace("1 2 3", "1 two 3"), "a.bvh:19: found 'two', expected a number"),
    "a decimal comma": (ARM.replace("1 2 3", "1 2,5 3"), "a.bvh:19: found '2,5', expected a decimal point"),
    "nan": (ARM.replace("0 0 0 90", "0 nan 0 90"), "a.bvh:20: found 'nan', expected a number"),
    "infinity": (ARM.replace("0 0 0 90", "0 -1e999 0 90"), "a.bvh:20: found '-1e999', expected a number"),
    "an underscore": (ARM.replace("0 0 0 90", "0 1_0 0 90"), "a.bvh:20: found '1_0', expected a number"),
    "Microsoft's nan": (ARM.replace("0 0 0 90", "0 -1.#IND 0 90"), "a.bvh:20: found '-1.#IND', expected a number"),
    "no frames": (ARM.replace("Frames: 2", "Frames: 0"), "a.bvh:17: found '0' frames, expected a whole number from 1"),
    "frames below none": (ARM.replace("Frames: 2", "Frames: -5"), "a.bvh:17: found '-5' frames"),
    "frames in words": (ARM.replace("Frames: 2", "Frames: two"), "a.bvh:17: found 'two' frames"),
    "a thousand million frames": (
        ARM.replace("Frames: 2", "Frames: 1000000000"),
        "a.bvh:17: found 1,000,000,000 frames of 9 values declared, expected at most 16 in a file of",
    ),
    "frames beyond numbers": (ARM.replace("Frames: 2", "Frames: " + "9" * 5000), "a.bvh:17: found '999"),
    "no frame time": (ARM.replace("Frame Time: 0.01\n", ""), "a.bvh:18: found '1 2 3 0 0 0 0 0 0', expected 'Frames:'"),
    "no time": (ARM.replace("0.01", "0"), "a.bvh:18: found frame time '0', expected 1e-05 to 10 seconds"),
    "time of nan": (ARM.replace("0.01", "nan"), "a.bvh:18: found frame time 'nan'"),
    "a joint named twice": (
        ARM.replace("JOINT Elbow", "JOINT Hips"),
        "a.bvh:6: found joint 'Hips' again, expected each name once (line 2 has one)",
    ),
    "a joint without a name": (ARM.replace("JOINT Elbow", "JOINT"), "a.bvh:6: found a joint without a name"),
    "a count of channels": (
        ARM.replace("CHANNELS 3 Z", "CHANNELS 4 Z"),
        "a.bvh:9: found 3 channels of 'Elbow', expected '4'",
    ),
    "an unknown channel": (
        ARM.replace("3 Zrotation", "3 Zrotatoin"),
        "a.bvh:9: found channel 'Zrotatoin'; did you mean Zrotation?",
    ),
    "a channel twice": (
        ARM.replace("6 Xposition Yposition", "6 Xposition Xposition"),
        "a.bvh:5: found a position channel of 'Hips' twice",
    ),
    "no offset": (ARM.replace("\t\tOFFSET 10 0 0\n", ""), "a.bvh:6: found no OFFSET of 'Elbow', expected one"),
    "a short offset": (
        ARM.replace("OFFSET 10 0 0", "OFFSET 10 0"),
        "a.bvh:9: found 'CHANNELS', expected three numbers after OFFSET",
    ),
    "a word in an offset": (
        ARM.replace("OFFSET 10 0 0", "OFFSET 10 O 0"),
        "a.bvh:8: OFFSET: found 'O', expected a number",
    ),
    "a brace missing": (
        ARM.replace("\t}\n}\nMOTION", "\t}\nMOTION"),
        "found the end of the hierarchy, expected '}' of joint 'Hips'",
    ),
    "a second body": (ARM.replace("MOTION\n", "ROOT Other\n{\n}\nMOTION\n"), "found a second ROOT after the hierarchy"),
    "channels in an end": (
        ARM.replace("OFFSET 5 0 0", "OFFSET 5 0 0\nCHANNELS 0"),
        "a.bvh:13: found CHANNELS in an End Site, expected OFFSET only",
    ),
    "a mistyped word": (ARM.replace("\tJOINT", "\tJONT"), "a.bvh:6: found 'JONT', expected OFFSET, CHANNELS, JOINT"),
    "nothing that moves": (
        re.sub(r"CHANNELS.*", "", ARM),
        "a.bvh:1: found no CHANNELS, expected those of ROOT at least",
    ),
    "zero bytes": (ARM.replace("1 2 3", "1 \0 3"), "a.bvh:19: found '\\x00', expected a number"),
}  # fmt: skip


@pytest.mark.parametrize("what", MISTAKES)
def test_a_mistake_is_told_with_its_line(tmp_path, what):
    text, said = MISTAKES[what]
    assert said in refused(tmp_path, text)


def test_all_mistakes_of_a_hierarchy_are_told_at_once(tmp_path):
    text = ARM.replace("JOINT Elbow", "JOINT Hips").replace("3 Zrotation", "2 Zrotation").replace("6 Xpos", "6 Wpos")
    assert [line.split(":")[1] for line in refused(tmp_path, text).splitlines()] == ["5", "6", "9"]


def test_damaged_utf_16_is_told(tmp_path):
    assert "damaged text" in refused(tmp_path, ARM.encode("utf-16")[:-1])


def test_what_is_no_file_is_told(tmp_path):
    with pytest.raises(RecordingError, match="no such file"):
        read_bvh(tmp_path / "none.bvh")
    with pytest.raises(RecordingError, match="is no file"):
        read_bvh(tmp_path)


def nested(depth):
    """A hierarchy so many joints deep."""
    opened = "".join(f"JOINT j{d} {{ OFFSET 0 1 0 CHANNELS 1 Xrotation\n" for d in range(depth))
    head = "HIERARCHY\nROOT r { OFFSET 0 0 0 CHANNELS 1 Xrotation\n" + opened + "}" * (depth + 1)
    return head + f"\nMOTION\nFrames: 1\nFrame Time: 0.1\n{'0 ' * (depth + 1)}\n"


def test_depth_of_nesting_costs_nothing(tmp_path):
    places = bvh_positions(read_bvh_file(written(tmp_path, nested(1500))))[2]
    assert np.allclose(places[0, -1], [0, 1500, 0])


def test_more_joints_than_a_body_has_are_refused(tmp_path):
    assert "found more than 2,000 joints, expected a body" in refused(tmp_path, nested(3000))


@pytest.mark.parametrize(
    "text",
    [
        ARM.replace("1 2 3", "1" * 5_000_000 + " 2 3"),
        ARM.replace("1 2 3", "x" * 5_000_000),
        ARM[: ARM.index("MOTION")] + "x" * 20_000_000,
        "HIERARCHY\nROOT " + "a " * 1_000_000,
    ],
)
def test_huge_words_and_lines_are_refused_in_little_memory(tmp_path, text):
    path = written(tmp_path, text)
    tracemalloc.start()
    with pytest.raises(RecordingError) as caught:
        read_bvh(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(str(caught.value)) < 1000 and peak < 120e6


def test_memory_is_the_values_and_a_few_blocks(tmp_path):
    rows = "1 2 3 0 0 0 0 0 0\n" * 200_000
    text = ARM[: ARM.index("1 2 3")].replace("Frames: 2", "Frames: 200000") + rows
    path = written(tmp_path, text)
    read_bvh_file(written(tmp_path, ARM, "warm.bvh"))
    tracemalloc.start()
    values = read_bvh_file(path).values
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < values.nbytes + 6e6


def test_the_bandai_file_is_read_as_recorded():
    path = raw("bandai_raise_up_right_hand_normal_001.bvh")
    file, take = read_bvh_file(path), read_bvh(path)
    text = path.read_text().split("0.0333333\n")[1]
    assert np.array_equal(file.values, [[float(word) for word in line.split()] for line in text.splitlines()])
    naive = [naive_hierarchy(file.parents, file.offsets, file.channels, frame) for frame in file.values]
    naive = np.array(naive)[..., [0, 2, 1]] * [0.01, -0.01, 0.01]
    assert np.allclose(take.positions_m, naive, atol=1e-12)
    assert take.rate_hz == 30 and take.n_frames == 59 and len(take.names) == 22
    head, foot = (take.positions_m[:, take.names.index(name), 2] for name in ("Head", "Toes_L"))
    assert np.all((head > 1.3) & (head < 1.5)) and np.all(np.abs(foot) < 0.05)


def test_only_the_bandai_files_trunk_breathes():
    """Six channels a joint: the format does not guarantee bone lengths; this file keeps them to the digits it has."""
    take = read_bvh(raw("bandai_raise_up_right_hand_normal_001.bvh"))
    bones = np.linalg.norm(take.positions_m[:, 1:] - take.positions_m[:, list(take.parents[1:])], axis=2)
    spread = dict(zip(take.names[1:], np.ptp(bones, axis=0)))
    assert max(v for name, v in spread.items() if name != "Hips") < 2e-6
    assert spread["Hips"] > 1e-3  # from a root on the floor: the way of the body, not a bone


def test_a_small_file_that_asks_for_gigabytes_is_refused(tmp_path):
    joints = "".join(f"JOINT j{i}\n{{\nOFFSET 0 1 0\nCHANNELS 0\n}}\n" for i in range(1500))
    frames = "\n".join(["0 0 0"] * 30_000)
    path = tmp_path / "swelling.bvh"
    path.write_text(
        f"HIERARCHY\nROOT hips\n{{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n{joints}}}\n"
        f"MOTION\nFrames: 30000\nFrame Time: 0.01\n{frames}\n"
    )
    with pytest.raises(RecordingError, match="30,000 frames of 1,501 joints in"):
        read_bvh(path)


def test_a_mistyped_channel_is_the_only_mistake(tmp_path):
    with pytest.raises(RecordingError) as error:
        read_bvh_file(written(tmp_path, ARM.replace("Xrotation", "Xrotatoin", 1)))
    assert str(error.value).endswith("a.bvh:5: found channel 'Xrotatoin'; did you mean Xrotation?")
    with pytest.raises(RecordingError, match="found a position channel of 'Hips' twice"):
        read_bvh_file(written(tmp_path, ARM.replace("Yposition", "Xposition", 1)))
