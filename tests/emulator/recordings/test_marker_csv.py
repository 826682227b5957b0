"""CSV and TSV of points: with each writer's header, and with none."""

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.importing import read_take
from emulator.recordings.marker_csv import read_csv
from tests.emulator.recordings.body import body, joint, table_text

TAKE = body(40, 50.0)
NAMES = TAKE.names
PLACES = TAKE.positions_m
MM = 1000 * PLACES


def written(tmp_path, text, name="a.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def flat_header(form="{}_{}"):
    return ",".join(form.format(name, axis) for name in NAMES for axis in "xyz")


def check(take, places=PLACES, atol=1e-6):
    assert take.names == NAMES and take.parents is None
    assert np.allclose(take.positions_m, places, atol=atol, equal_nan=True)


@pytest.mark.parametrize("form", ["{}_{}", "{}.{}", "{} {}", "{}:{}", "{}-{}", "{}_pos_{}", '"{} {}"'])
def test_a_header_row_names_three_columns_a_point(tmp_path, form):
    take = read_csv(written(tmp_path, table_text([flat_header(form)], MM)), rate_hz=50.0)
    check(take)
    assert take.rate_hz == 50.0 and "mm" in take.notes[0]


def test_the_rate_is_that_of_the_time_column(tmp_path):
    text = table_text(["frame,time," + flat_header()], PLACES, first=np.stack([np.arange(40), np.arange(40) / 50], 1))
    assert read_csv(written(tmp_path, text)).rate_hz == pytest.approx(50.0)
    milliseconds = table_text(["timestamp," + flat_header()], PLACES, first=20.0 * np.arange(40))
    assert read_csv(written(tmp_path, milliseconds)).rate_hz == pytest.approx(50.0)


@pytest.mark.parametrize("sign", [";", "\t", " "])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_signs_and_encodings(tmp_path, sign, encoding):
    text = table_text([flat_header().replace(",", sign)], PLACES, sign)
    check(read_csv(written(tmp_path, text.replace("head", "head"), encoding=encoding), rate_hz=50.0))


def test_decimal_commas_beside_semicolons(tmp_path):
    text = table_text([flat_header().replace(",", ";")], PLACES, ";").replace(".", ",")
    check(read_csv(written(tmp_path, text), rate_hz=50.0))


def test_a_file_of_vicon_nexus(tmp_path):
    rows = table_text(
        [
            "Trajectories",
            "50",
            ",," + ",,,".join(f"Ana:{name}" for name in NAMES) + ",,",
            "Frame,Sub Frame" + ",X,Y,Z" * len(NAMES),
            "," + ",mm" * 3 * len(NAMES),
        ],
        MM,
        first=np.stack([np.arange(1, 41), np.zeros(40)], axis=1),
    )
    take = read_csv(written(tmp_path, rows))
    assert take.names == tuple(f"Ana:{name}" for name in NAMES) and take.rate_hz == 50.0
    assert np.allclose(take.positions_m, PLACES, atol=1e-6) and "unit said by the file: mm" in take.notes


def test_a_file_of_optitrack_motive_and_its_rotations(tmp_path):
    y_up = PLACES @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    cells = np.concatenate([np.full((*y_up.shape[:2], 4), 0.5), y_up], axis=-1)
    n = len(NAMES)
    header = [
        "Format Version,1.23,Take Name,reach,Export Frame Rate,50.000000,Length Units,Meters",
        "",
        "," + ",Bone" * 7 * n,
        ",Name," + ",".join(f"Ana:{name}" for name in NAMES for _ in range(7)),
        ",ID," + ",".join(f"{i}" for i in range(n) for _ in range(7)),
        ",," + ",".join((["Rotation"] * 4 + ["Position"] * 3) * n),
        "Frame,Time (Seconds)" + ",X,Y,Z,W,X,Y,Z" * n,
    ]
    text = table_text(header, cells, first=np.stack([np.arange(40), np.arange(40) / 50], axis=1))
    take = read_csv(written(tmp_path, text))
    assert take.names == tuple(f"Ana:{name}" for name in NAMES) and take.rate_hz == 50.0
    assert np.allclose(take.positions_m, PLACES, atol=1e-6)


def test_a_tsv_of_qualisys(tmp_path):
    header = [
        "NO_OF_FRAMES\t40", "NO_OF_CAMERAS\t8", f"NO_OF_MARKERS\t{len(NAMES)}", "FREQUENCY\t50",
        "DATA_INCLUDED\t3D", "MARKER_NAMES\t" + "\t".join(NAMES),
    ]  # fmt: skip
    holes = MM.copy()
    holes[3, 4] = 0.0
    text = table_text(header, holes, "\t").replace("\n", "\t\n")
    take = read_take(written(tmp_path, text, "a.tsv"))
    expected = PLACES.copy()
    expected[3, 4] = np.nan
    check(take, expected)
    assert take.rate_hz == 50.0 and any("1 points at exactly 0, 0, 0" in note for note in take.notes)


def motive(types, names, places):
    """A Motive file with a time of day beside the numbers."""
    header = [
        "Format Version,1.24,Take Name,a,Capture Frame Rate,50.0,Export Frame Rate,50.0,Rotation Type,Quaternion",
        "",
        ",Type,," + ",".join(kind for kind in types for _ in range(3)),
        ",Name,," + ",".join(f'"{name}"' for name in names for _ in range(3)),
        ",,," + ",".join(["Position"] * 3 * len(names)),
        "Frame,Time (Seconds),TimeCode" + ",X,Y,Z" * len(names),
    ]
    rows = table_text([], places).splitlines()
    lines = [f"{i},{i / 50:.6f},15:26:{i // 50:02d}:{i % 50:02d}.02,{row}" for i, row in enumerate(rows)]
    return "\n".join([*header, *lines])


def test_of_a_motive_file_with_bones_and_markers_the_bones_are_read(tmp_path):
    types = ["Bone"] * len(NAMES) + ["Bone Marker", "Marker"]
    names = [*NAMES, "head", "Unlabeled 1189"]
    places = np.concatenate([PLACES, PLACES[:, :2] + 9], axis=1)
    take = read_csv(written(tmp_path, motive(types, names, places)))
    check(take)
    assert take.rate_hz == 50.0


def test_of_measured_and_solved_markers_of_one_name_the_measured_are_read(tmp_path):
    types = ["Rigid Body Marker"] * len(NAMES) + ["Marker"] * len(NAMES)
    places = np.concatenate([PLACES + 9, PLACES], axis=1)
    check(read_csv(written(tmp_path, motive(types, [*NAMES, *NAMES], places))))


def test_names_are_told_from_other_words_above_the_coordinates(tmp_path):
    few = ["pelvis", "left_hip", "right_hip", "neck"]
    places = PLACES[:, [NAMES.index(name) for name in few]]
    header = [
        "a,b,c,d,e,f,g,h,i,j,k,l,m,n",
        "," + ",".join(f"{name},," for name in few),
        "," + ",".join(["1", "1", "1"] * 4),
        "Frame" + ",X,Y,Z" * 4,
    ]
    text = table_text(header, places, first=np.arange(40))
    assert read_csv(written(tmp_path, text), rate_hz=50.0, unit_m=1.0, up="z").names == tuple(few)


def test_the_rows_of_deeplabcut(tmp_path):
    n = len(NAMES)
    header = [
        "scorer" + ",net" * 4 * n,
        "bodyparts," + ",".join(name for name in NAMES for _ in range(4)),
        "coords" + ",x,y,z,likelihood" * n,
    ]
    scores = np.ones((*PLACES.shape[:2], 1))
    scores[5, 2] = 0.1
    text = table_text(header, np.concatenate([MM, scores], axis=-1), first=np.arange(40))
    expected = PLACES.copy()
    expected[5, 2] = np.nan
    take = read_csv(written(tmp_path, text), rate_hz=30.0)
    check(take, expected)
    assert any("1 points with a confidence below 0.3 are gaps" in note for note in take.notes)


def test_the_columns_of_anipose(tmp_path):
    header = ",".join(f"{name}_{what}" for name in NAMES for what in ("x", "y", "z", "error", "ncams", "score"))
    beside = np.stack([np.full(PLACES.shape[:2], v) for v in (2.5, 3.0, 0.9)], axis=-1)
    beside[7, 1, 2] = 0.2
    text = table_text([header + ",M_00,fnum"], np.concatenate([MM, beside], axis=-1))
    text = "\n".join(line if i == 0 else f"{line},1.0,{i}" for i, line in enumerate(text.splitlines()))
    take = read_csv(written(tmp_path, text), rate_hz=50.0, min_score=0.5)
    assert np.isnan(take.positions_m).sum() == 3 and np.isnan(joint(take, NAMES[1])[7]).all()


def test_points_in_the_plane_of_a_picture_are_refused(tmp_path):
    n = len(NAMES)
    names = ",".join(name for name in NAMES for _ in range(3))
    header = ["scorer" + ",net" * 3 * n, f"bodyparts,{names}", "coords" + ",x,y,likelihood" * n]
    text = table_text(header, MM, first=np.arange(40))
    with pytest.raises(RecordingError, match="in the plane of a picture"):
        read_csv(written(tmp_path, text), rate_hz=30.0)
    flat = ",".join(f"{name}_{axis}" for name in NAMES for axis in "xy")
    with pytest.raises(RecordingError, match="in the plane of a picture"):
        read_csv(written(tmp_path, table_text([flat], MM[..., :2])), rate_hz=30.0)


def test_bare_numbers_need_names(tmp_path):
    path = written(tmp_path, table_text([], MM))
    with pytest.raises(RecordingError, match=r"63 columns of numbers without names.*--columns"):
        read_csv(path, rate_hz=50.0)
    for text in ("\n".join(NAMES), ",".join(NAMES), " ".join(NAMES), "# ours\n" + "\n".join(NAMES)):
        check(read_csv(path, rate_hz=50.0, columns=written(tmp_path, text, "names.txt")))


def test_other_columns_are_passed_over(tmp_path):
    header = flat_header() + ",frame_index,velocity,freq_hz,force"
    text = table_text([header], np.concatenate([MM.reshape(40, -1), np.arange(160).reshape(40, 4)], axis=1))
    check(read_csv(written(tmp_path, text), rate_hz=50.0))


def test_known_columns_need_no_file(tmp_path):
    path = written(tmp_path, table_text([], np.resize(MM, (40, 39, 3))))
    assert read_csv(path, rate_hz=50.0, columns="plug-in-gait", unit_m=0.001, up="z").names[:2] == ("LFHD", "RFHD")
    with pytest.raises(RecordingError, match=r"name them with --columns \(39 points are perhaps plug-in-gait\)"):
        read_csv(path, rate_hz=50.0)
    with pytest.raises(
        RecordingError, match="no such file, expected one with the names of the points, or plug-in-gait"
    ):
        read_csv(path, rate_hz=50.0, columns="plug")


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ("a\nb", "found 63 columns, expected 6 for 2 names"),
        ("head\nhead\n", "names.txt:2: found 'head' a second time"),
        ("# nothing\n", "found no name"),
    ],
)
def test_wrong_files_of_names_are_refused(tmp_path, names, said):
    path = written(tmp_path, table_text([], MM))
    with pytest.raises(RecordingError, match=said):
        read_csv(path, rate_hz=50.0, columns=written(tmp_path, names, "names.txt"))


def celled(line, column, text):
    cells = line.split(",")
    return ",".join([*cells[:column], text, *cells[column + 1 :]])


def lines_of(change):
    lines = table_text([flat_header()], MM).splitlines()
    return "\n".join(change(lines))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda lines: [*lines[:5], celled(lines[5], 7, "12a4"), *lines[6:]], r"a.csv:6: column 8: found '12a4'"),
        (lambda lines: [*lines[:5], lines[5].rsplit(",", 3)[0], *lines[6:]], "a.csv:6: found 60 values, expected 63"),
        (lambda lines: [*lines[:-1], lines[-1][:40]], "a.csv:41: found .* values, expected 63"),
        (lambda lines: [*lines[:9], lines[9] + ",1", *lines[10:]], "a.csv:10: found 64 values, expected 63"),
        (lambda lines: [lines[0], celled(lines[1], 0, "inf"), *lines[2:]], "a.csv:2: column 1: found 'inf'"),
        (lambda lines: lines[:1], "found no row of numbers"),
        (lambda lines: [lines[0], "1.0,2.0,"], "a.csv:1: found names of 63 columns, expected 3 as in the rows below"),
        (lambda lines: lines[:2], "found 1 frame, expected 2 or more"),
        (lambda lines: [], "found no row of numbers"),
        (lambda lines: [lines[0].replace("head_y", "head_x"), *lines[1:]], "a.csv:1: found 'head' twice, its x"),
        (lambda lines: [lines[0].replace("head_z", "head_w"), *lines[1:]], "a.csv:1: 'head': found x, y, expected x"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_line(tmp_path, change, said):
    with pytest.raises(RecordingError, match=said):
        read_csv(written(tmp_path, lines_of(change)), rate_hz=50.0)


def test_several_wrong_lines_are_said_at_once(tmp_path):
    text = lines_of(lambda lines: [lines[0], *(f"x{line}" for line in lines[1:])])
    with pytest.raises(RecordingError) as error:
        read_csv(written(tmp_path, text), rate_hz=50.0)
    assert 1 <= str(error.value).count("a.csv:") <= 12


def test_without_any_rate_it_is_asked_for(tmp_path):
    with pytest.raises(RecordingError, match=r"found no frame rate and no column of time.*--rate"):
        read_csv(written(tmp_path, table_text([flat_header()], MM)))


@pytest.mark.parametrize("rate_hz", [0.0, -5.0, 1e9])
def test_rates_that_no_camera_has_are_refused(tmp_path, rate_hz):
    with pytest.raises(RecordingError, match="frames a second, expected 1 to 10000"):
        read_csv(written(tmp_path, table_text([flat_header()], MM)), rate_hz=rate_hz)


def test_time_must_rise_evenly(tmp_path):
    time = np.arange(40) / 50
    back = time.copy()
    back[20] = back[18]
    with pytest.raises(RecordingError, match=r"a.csv:22: found time .* expected it to rise"):
        read_csv(written(tmp_path, table_text(["time," + flat_header()], MM, first=back)))
    slower = np.concatenate([time[:20], time[20] + np.arange(20) / 25])
    with pytest.raises(RecordingError, match=r"found a step of 0.04 in time, expected"):
        read_csv(written(tmp_path, table_text(["time," + flat_header()], MM, first=slower)))


def test_frames_left_out_become_gaps(tmp_path):
    kept = np.delete(np.arange(40), [10, 11, 12])
    take = read_csv(written(tmp_path, table_text(["frame," + flat_header()], MM[kept], first=kept)), rate_hz=50.0)
    expected = PLACES.copy()
    expected[10:13] = np.nan
    check(take, expected)
    far = np.arange(40) * 1.0
    far[-1] = 1e9
    with pytest.raises(RecordingError, match="found 40 rows for frames 0 to 1e"):
        read_csv(written(tmp_path, table_text(["frame," + flat_header()], MM, first=far)), rate_hz=50.0)


def test_empty_cells_are_gaps(tmp_path):
    holes = MM.copy()
    holes[4:9, 3] = np.nan
    expected = PLACES.copy()
    expected[4:9, 3] = np.nan
    check(read_csv(written(tmp_path, table_text([flat_header()], holes)), rate_hz=50.0), expected)


def test_what_a_table_without_header_lacks_is_asked_for_at_once(tmp_path):
    with pytest.raises(RecordingError, match=r"name them with --columns, and give the frames a second with --rate"):
        read_csv(written(tmp_path, table_text([], MM)))
    with pytest.raises(RecordingError, match=r"name them with --columns$"):
        read_csv(written(tmp_path, table_text([], MM)), rate_hz=50.0)
