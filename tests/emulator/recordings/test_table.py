"""Tables of numbers under header lines."""

import numpy as np
import pytest

from emulator.recordings.text import cells_of, number_of, read_table


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
