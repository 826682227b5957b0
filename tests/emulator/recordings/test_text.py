"""Text of any encoding: lines with their numbers, and no more memory than a block.

Tables of numbers under header lines.

Names of columns: a name and an axis, however they are written, in time that grows with their length.
"""

import numpy as np
import pytest

from emulator.recordings import RecordingError
from emulator.recordings.columns import _split
from emulator.recordings.text import cells_of, finite, number_of, quoted, read_table, text_blocks, text_lines

LINES = ["f\u00fcr", "", "zwei\tdrei", "  4"]


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-32", "latin-1"])
@pytest.mark.parametrize("block", [1, 2, 3, 1000])
def test_blocks_of_any_size_hold_the_same_text(tmp_path, ending, encoding, block):
    path = tmp_path / "a.txt"
    path.write_bytes(ending.join(LINES).encode(encoding))
    if block < 4 and encoding in ("utf-16", "utf-32", "utf-8-sig"):
        block = 4  # the mark of the encoding is looked for in the first block
    text = b"".join(text_blocks(path, block))
    assert text == "\n".join(LINES).encode("latin-1" if encoding == "latin-1" else "utf-8")
    assert list(text_lines(path)) == list(enumerate(LINES, 1))


def test_utf_16_without_a_mark_is_known_by_its_zero_bytes(tmp_path):
    for encoding in ("utf-16-le", "utf-16-be"):
        (tmp_path / "a.txt").write_bytes("HIERARCHY\n1".encode(encoding))
        assert list(text_lines(tmp_path / "a.txt")) == [(1, "HIERARCHY"), (2, "1")]


def test_an_empty_file_has_no_lines(tmp_path):
    (tmp_path / "a.txt").touch()
    assert list(text_lines(tmp_path / "a.txt")) == []


def test_a_line_of_more_than_a_megabyte_is_refused_with_its_number(tmp_path):
    (tmp_path / "a.txt").write_bytes(b"1\n" + b"2" * 5_000_000)
    with pytest.raises(RecordingError, match=r"a\.txt:2: found a line of more than 1 MB, expected text"):
        list(text_lines(tmp_path / "a.txt"))


def test_only_plain_numbers_are_numbers():
    words = ("1", "-2.5e3", ".5", "nan", "inf", "-Infinity", "1e999", "1_0", "0x1", "\u0663", "", "one")
    assert [finite(word) for word in words] == [1.0, -2500.0, 0.5, *[None] * 9]


def test_a_quotation_is_one_short_line():
    assert quoted("a\nb") == "'a\\nb'" and len(quoted("x" * 1000)) == 42


def table(tmp_path, text, **how):
    path = tmp_path / "a.csv"
    path.write_text(text)
    return read_table(path, **how)


def test_header_and_rows_are_told_apart(tmp_path):
    found = table(tmp_path, "made by us\n50\na,b,c\n1,2,3\n\n4,,6\n")
    assert found.header == (("made by us",), ("50",), ("a", "b", "c")) and found.header_line == (1, 2, 3)
    assert np.array_equal(found.values, [[1, 2, 3], [4, np.nan, 6]], equal_nan=True) and found.line.tolist() == [4, 6]


def test_a_wrong_cell_in_the_first_row_does_not_make_it_a_header(tmp_path):
    from emulator.recordings import RecordingError

    with pytest.raises(RecordingError, match=r"a\.csv:2: column 2: found 'x'"):
        table(tmp_path, "a,b,c,d,e\n1,x,3,4,5,6,7\n1,2,3,4,5,6,7\n")


@pytest.mark.parametrize("word", ["", "NaN", "null", "NA", "-", "None"])
def test_words_for_nothing_are_gaps(word):
    assert np.isnan(number_of(word))


@pytest.mark.parametrize("word", ["inf", "-Infinity", "1e31", "1_0", "0x1F", "a", "1,5"])
def test_what_is_no_number_is_none(word):
    assert number_of(word) is None


def test_decimal_commas_beside_semicolons():
    assert number_of("1,5", ";") == 1.5


def test_quotation_marks_hold_a_cell_together():
    assert cells_of('"a, b",c', ",") == ["a, b", "c"] and cells_of('"a', ",") == ["a"]


def test_memory_is_eight_bytes_a_number(tmp_path):
    import tracemalloc

    rows = "\n".join(",".join(["1.5"] * 50) for _ in range(4000))
    tracemalloc.start()
    values = table(tmp_path, rows).values
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4 * values.nbytes + 4e6


@pytest.mark.parametrize(
    ("label", "found"),
    [
        ("LKNE_x", ("LKNE", "x")),
        ("LKNE X (mm)", ("LKNE", "x")),
        ("LKNE.pos.Y", ("LKNE", "y")),
        ("left knee position z", ("left knee", "z")),
        ("ana:LKNE-z [m]", ("ana:LKNE", "z")),
        ("LKNEx", ("LKNE", "x")),
        ("nose_score", ("nose", "score")),
        ("nose_p", ("nose", "score")),
        ("hip", ("hip", "")),
        ("x", ("x", "")),
        ("pos_x", ("pos", "x")),
        ("time", ("time", "")),
        ("Frame#", ("Frame#", "")),
    ],
)
def test_a_label_is_a_name_and_an_axis(label, found):
    assert _split(label) == found


@pytest.mark.parametrize("label", ["a" + "_" * 50_000 + "k", "a" + "_p" * 25_000, "x(" * 25_000, "pos_" * 12_000])
def test_a_hostile_label_is_split(label):
    """Where time grows with the square or the cube of the length, as it did once, this takes minutes to hours."""
    name, _ = _split(label)
    assert label.startswith(name)
