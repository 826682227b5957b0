"""TRC files: read as written, and refused where they are not what they declare."""

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.c3d import read_trc
from emulator.recordings.importing import read_take
from tests.emulator.recordings.body import body, trc_text

TAKE = body(30, 100.0)
Y_UP_MM = 1000 * TAKE.positions_m @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])


def written(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "a.trc"
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_trc_is_read_as_it_was_written(tmp_path, encoding):
    take = read_take(written(tmp_path, trc_text(TAKE.names, Y_UP_MM), encoding))
    assert take.names == TAKE.names and take.rate_hz == 100.0 and take.parents is None
    assert np.allclose(take.positions_m, TAKE.positions_m, atol=1e-7)
    assert "unit said by the file: mm" in take.notes


def test_windows_line_ends_and_a_tab_at_the_end(tmp_path):
    text = trc_text(TAKE.names, Y_UP_MM).replace("\n", "\t\r\n")
    assert np.allclose(read_trc(written(tmp_path, text)).positions_m, TAKE.positions_m, atol=1e-7)


def test_empty_cells_are_gaps_also_at_the_end_of_a_row(tmp_path):
    holes = Y_UP_MM.copy()
    holes[3:5, 2] = holes[7, -1] = np.nan
    text = "\n".join(line.rstrip("\t") for line in trc_text(TAKE.names, holes).split("\n"))
    take = read_trc(written(tmp_path, text))
    assert np.isnan(take.positions_m).sum() == 9 and np.isnan(take.positions_m[7, -1]).all()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (trc_text(TAKE.names, Y_UP_MM, n_frames=1000000000), "a.trc:3: NumFrames says '1000000000', found 30"),
        (trc_text(TAKE.names, Y_UP_MM, n_markers=4), "a.trc:3: NumMarkers says '4', found 21"),
        (trc_text([*TAKE.names[:-1], "head"], Y_UP_MM), "a.trc:4: found 'head' 2 times, as column"),
        (trc_text(TAKE.names, Y_UP_MM).replace("PathFileType", "Path"), "a.trc:1: found 'Path', expected"),
        (trc_text(TAKE.names, Y_UP_MM).replace("NumMarkers", "Markers"), "a.trc:2: found no NumMarkers"),
        (trc_text(TAKE.names, Y_UP_MM).replace("Frame#", "Nr"), "found no line of names"),
        (trc_text(TAKE.names, Y_UP_MM, rate_hz=0.01), "frames a second, expected 1 to 10000"),
        (trc_text(TAKE.names, Y_UP_MM[:1]), "found 1 frame, expected 2 or more"),
        (trc_text(TAKE.names, Y_UP_MM)[:6000], "a.trc:"),
        ("", "found '', expected 'PathFileType'"),
        ("HIERARCHY\nROOT Hips\n", "a.trc:1: found 'HIERARCHY', expected 'PathFileType'.*it looks like a BVH"),
        ("1,2,3\n4,5,6\n", "expected 'PathFileType'"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path, text, said):
    with pytest.raises(RecordingError, match=said):
        read_trc(written(tmp_path, text))


def test_text_in_numbers_is_said_with_line_and_column(tmp_path):
    lines = trc_text(TAKE.names, Y_UP_MM).split("\n")
    cells = lines[8].split("\t")
    lines[8] = "\t".join([*cells[:5], "abc", *cells[6:]])
    with pytest.raises(RecordingError, match=r"a.trc:9: column 6: found 'abc'"):
        read_trc(written(tmp_path, "\n".join(lines)))


def test_a_unit_that_nobody_knows_is_said_to_be_unknown(tmp_path):
    notes = read_trc(written(tmp_path, trc_text(TAKE.names, Y_UP_MM, unit="furlong"))).notes
    assert "the file's unit, 'furlong', is not known" in notes and not any("unit said" in note for note in notes)
