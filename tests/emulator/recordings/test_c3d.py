"""C3D files: as ezc3d writes them, in the bytes of each processor, and damaged.

TRC files: read as written, and refused where they are not what they declare.
"""

import struct

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.c3d import read_c3d, read_trc
from emulator.recordings.importing import read_take
from tests.emulator.recordings.body import body, trc_text, write_c3d

TAKE = body(25, 100.0)
NAMES, MM = TAKE.names, 1000 * TAKE.positions_m


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    pytest.importorskip("ezc3d")
    holes = MM.copy()
    holes[3:6, 4] = np.nan
    return write_c3d(tmp_path_factory.mktemp("c3d") / "a.c3d", NAMES, holes)


def test_what_ezc3d_writes_is_read(written):
    take = read_c3d(written)
    expected = TAKE.positions_m.copy()
    expected[3:6, 4] = np.nan
    assert take.names == NAMES and take.rate_hz == 100.0
    assert np.allclose(take.positions_m, expected, atol=1e-6, equal_nan=True)
    assert "unit said by the file: mm" in take.notes


def test_it_is_read_as_ezc3d_reads_it(written):
    ezc3d = pytest.importorskip("ezc3d")
    theirs = ezc3d.c3d(str(written))["data"]["points"][:3].transpose(2, 1, 0) / 1000
    assert np.allclose(read_c3d(written).positions_m, theirs, atol=1e-12, equal_nan=True)


def by_hand(places, names, *, processor=84, whole=False, rate_hz=100.0, unit="mm", more=b"", labels=None, frames=None):
    """A small C3D file in the bytes of a processor (84 Intel, 85 DEC, 86 MIPS), whole numbers or floating."""
    order = ">" if processor == 86 else "<"

    def real(value):
        if processor != 85:
            return struct.pack(f"{order}f", value)
        low, high = struct.unpack("<HH", struct.pack("<f", value * 4))
        return struct.pack("<HH", high, low)

    def group(number, name):
        return struct.pack("bb", len(name), -number) + name.encode() + struct.pack(f"{order}H", 3) + b"\0"

    def parameter(number, name, kind, sizes, content):
        body = struct.pack("bB", kind, len(sizes)) + bytes(sizes) + content + b"\0"
        link = struct.pack(f"{order}H", len(body) + 2)
        return struct.pack("bb", len(name), number) + name.encode() + link + body

    scale = 0.1 if whole else -1.0
    labels = labels or names
    section = b"".join(
        [
            struct.pack("BBBB", 1, 0x50, 4, processor),
            group(1, "POINT"),
            parameter(1, "USED", 2, [], struct.pack(f"{order}H", len(names))),
            parameter(1, "SCALE", 4, [], real(scale)),
            parameter(1, "RATE", 4, [], real(rate_hz)),
            parameter(1, "UNITS", -1, [4, 1], unit.ljust(4).encode()),
            parameter(1, "LABELS", -1, [20, len(labels)], b"".join(name.ljust(20).encode() for name in labels)),
            more,
        ]
    ).ljust(2048, b"\0")
    n_frames = len(places) if frames is None else frames
    head = struct.pack(f"{order}HHHHH", len(names), 0, 1, n_frames & 0xFFFF, 0) + real(scale)
    head += struct.pack(f"{order}HH", 6, 0) + real(rate_hz)
    data = []
    for point in places.reshape(-1, 3):
        gap = np.isnan(point).any()
        point = np.nan_to_num(point)
        if whole:
            data.append(struct.pack(f"{order}hhhh", *np.rint(point / scale).astype(int).tolist(), -1 if gap else 0))
        else:
            data.append(b"".join(map(real, [*point.tolist(), -1.0 if gap else 0.0])))
    return (b"\x02\x50" + head).ljust(512, b"\0") + section + b"".join(data)


@pytest.mark.parametrize("processor", [84, 85, 86])
@pytest.mark.parametrize("whole", [False, True])
def test_the_bytes_of_each_processor_are_read(tmp_path, processor, whole):
    holes = MM.copy()
    holes[2, 1] = np.nan
    path = tmp_path / "a.c3d"
    path.write_bytes(by_hand(holes, NAMES, processor=processor, whole=whole))
    take = read_c3d(path)
    assert take.names == NAMES and take.rate_hz == 100.0
    assert np.allclose(take.positions_m, holes / 1000, atol=1e-4 if whole else 1e-6, equal_nan=True)


def test_points_without_a_name_are_left_out(tmp_path):
    path = tmp_path / "a.c3d"
    path.write_bytes(by_hand(MM, NAMES, labels=[*NAMES[:-2], "*12", ""]))
    take = read_c3d(path)
    assert take.names == NAMES[:-2] and "2 points without a name" in take.notes[0]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "found 0 bytes"),
        (b"\x02\x50" + b"\0" * 100, "found 102 bytes"),
        (b"\x02\x51" + b"\0" * 2000, "0x51 as second byte, expected 0x50"),
        (b"\xff\x50" + b"\0" * 2000, "parameters in block 255"),
        (b"\x00\x50" + b"\0" * 2000, "parameters in block 0"),
        (b"\x02\x50" + b"\0" * 2000, "processor type 0"),
        (by_hand(MM, NAMES)[:-400], "declares 25 frames of 21 points from block 6 on, and holds 23"),
        (by_hand(MM, NAMES, frames=65535), "declares 65535 frames of 21 points"),
        (by_hand(MM, NAMES, frames=0), "found 0 frames, expected 2 or more"),
        (by_hand(MM, NAMES, rate_hz=0.0), "found 0 frames a second"),
        (by_hand(MM, [*NAMES[:-1], "head"]), "found 'head' 2 times, as POINT:LABELS"),
        (by_hand(MM, NAMES, labels=["*1"] * len(NAMES)), "none of them with a label"),
        (by_hand(MM[:, :0], []), "found no points"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, content, said):
    path = tmp_path / "a.c3d"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=said):
        read_c3d(path)


def test_analog_channels_and_angles_beside_the_points_are_passed_over(tmp_path):
    ezc3d = pytest.importorskip("ezc3d")
    file = ezc3d.c3d()
    point, analog = file["parameters"]["POINT"], file["parameters"]["ANALOG"]
    point["RATE"]["value"], point["UNITS"]["value"] = [100.0], ["mm"]
    point["LABELS"]["value"] = [*NAMES, "LHipAngles"]
    file.add_parameter("POINT", "ANGLES", ["LHipAngles"])
    held = np.ones((4, len(NAMES) + 1, len(MM)))
    held[:3, :-1] = MM.transpose(2, 1, 0)
    file["data"]["points"] = held
    analog["RATE"]["value"], analog["LABELS"]["value"] = [1000.0], ["Fx", "Fy"]
    file["data"]["analogs"] = np.random.default_rng(0).normal(size=(1, 2, 10 * len(MM)))
    file.write(str(tmp_path / "a.c3d"))
    take = read_c3d(tmp_path / "a.c3d")
    assert take.names == NAMES and np.allclose(take.positions_m, TAKE.positions_m, atol=1e-6)


def test_more_labels_than_one_parameter_holds(tmp_path):
    ezc3d = pytest.importorskip("ezc3d")
    names = [*NAMES, *(f"more{i}" for i in range(280))]
    places = np.concatenate([MM, np.ones((len(MM), 280, 3)) * np.arange(280)[:, None]], axis=1)
    path = write_c3d(tmp_path / "a.c3d", names, places)
    labels = ezc3d.c3d(str(path))["parameters"]["POINT"]
    assert "LABELS2" in labels
    assert read_c3d(path, unit_m=0.001, up="z").names == tuple(names)


TRACKED = body(30, 100.0)
Y_UP_MM = 1000 * TRACKED.positions_m @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])


def trc_written(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "a.trc"
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_trc_is_read_as_it_was_written(tmp_path, encoding):
    take = read_take(trc_written(tmp_path, trc_text(TRACKED.names, Y_UP_MM), encoding))
    assert take.names == TRACKED.names and take.rate_hz == 100.0 and take.parents is None
    assert np.allclose(take.positions_m, TRACKED.positions_m, atol=1e-7)
    assert "unit said by the file: mm" in take.notes


def test_windows_line_ends_and_a_tab_at_the_end(tmp_path):
    text = trc_text(TRACKED.names, Y_UP_MM).replace("\n", "\t\r\n")
    assert np.allclose(read_trc(trc_written(tmp_path, text)).positions_m, TRACKED.positions_m, atol=1e-7)


def test_empty_cells_are_gaps_also_at_the_end_of_a_row(tmp_path):
    holes = Y_UP_MM.copy()
    holes[3:5, 2] = holes[7, -1] = np.nan
    text = "\n".join(line.rstrip("\t") for line in trc_text(TRACKED.names, holes).split("\n"))
    take = read_trc(trc_written(tmp_path, text))
    assert np.isnan(take.positions_m).sum() == 9 and np.isnan(take.positions_m[7, -1]).all()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (trc_text(TRACKED.names, Y_UP_MM, n_frames=1000000000), "a.trc:3: NumFrames says '1000000000', found 30"),
        (trc_text(TRACKED.names, Y_UP_MM, n_markers=4), "a.trc:3: NumMarkers says '4', found 21"),
        (trc_text([*TRACKED.names[:-1], "head"], Y_UP_MM), "a.trc:4: found 'head' 2 times, as column"),
        (trc_text(TRACKED.names, Y_UP_MM).replace("PathFileType", "Path"), "a.trc:1: found 'Path', expected"),
        (trc_text(TRACKED.names, Y_UP_MM).replace("NumMarkers", "Markers"), "a.trc:2: found no NumMarkers"),
        (trc_text(TRACKED.names, Y_UP_MM).replace("Frame#", "Nr"), "found no line of names"),
        (trc_text(TRACKED.names, Y_UP_MM, rate_hz=0.01), "frames a second, expected 1 to 10000"),
        (trc_text(TRACKED.names, Y_UP_MM[:1]), "found 1 frame, expected 2 or more"),
        (trc_text(TRACKED.names, Y_UP_MM)[:6000], "a.trc:"),
        ("", "found '', expected 'PathFileType'"),
        ("HIERARCHY\nROOT Hips\n", "a.trc:1: found 'HIERARCHY', expected 'PathFileType'.*it looks like a BVH"),
        ("1,2,3\n4,5,6\n", "expected 'PathFileType'"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path, text, said):
    with pytest.raises(RecordingError, match=said):
        read_trc(trc_written(tmp_path, text))


def test_text_in_numbers_is_said_with_line_and_column(tmp_path):
    lines = trc_text(TRACKED.names, Y_UP_MM).split("\n")
    cells = lines[8].split("\t")
    lines[8] = "\t".join([*cells[:5], "abc", *cells[6:]])
    with pytest.raises(RecordingError, match=r"a.trc:9: column 6: found 'abc'"):
        read_trc(trc_written(tmp_path, "\n".join(lines)))


def test_a_unit_that_nobody_knows_is_said_to_be_unknown(tmp_path):
    notes = read_trc(trc_written(tmp_path, trc_text(TRACKED.names, Y_UP_MM, unit="furlong"))).notes
    assert "the file's unit, 'furlong', is not known" in notes and not any("unit said" in note for note in notes)
