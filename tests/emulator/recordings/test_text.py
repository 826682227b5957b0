"""Text of any encoding: lines with their numbers, and no more memory than a block."""

import pytest

from emulator.recordings import RecordingError
from emulator.recordings.text import finite, quoted, text_blocks, text_lines

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
