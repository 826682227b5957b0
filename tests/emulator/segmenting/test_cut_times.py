"""Cut times as text: written, read again, mistakes with file and line."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.recordings.take import Take
from emulator.segmenting.segment import Cut, cut_times_text, parse_cut_times, was_edited


def a_take(name="ana", n=1000, rate_hz=50.0):
    return Take(("pelvis", "neck"), (-1, 0), np.zeros((n, 2, 3)), rate_hz, name, "long")


TAKES = (a_take(), a_take("ben", 700))
NAMES = st.text("abc123.-_äß", min_size=1, max_size=6)


@st.composite
def cuts_of(draw, n_frames):
    frames = sorted(draw(st.sets(st.integers(0, n_frames - 1), max_size=12)))
    pairs = list(zip(frames[::2], frames[1::2], strict=False))
    names = draw(st.lists(NAMES, min_size=len(pairs), max_size=len(pairs), unique=True))
    return tuple(Cut(start, stop, name) for (start, stop), name in zip(pairs, names, strict=True))


@given(cuts_of(1000), cuts_of(700), st.sampled_from([24.0, 29.97, 50.0, 120.0, 1000.0, 0.5]))
def test_what_is_written_is_read_again(first, second, rate_hz):
    takes = (a_take(rate_hz=rate_hz), a_take("ben", 700, rate_hz))
    cuts = {"ana/long": first, "ben/long": second}
    text = cut_times_text(takes, cuts)
    assert not was_edited(text)
    if first or second:
        assert parse_cut_times(text, takes, "x.txt") == cuts


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_with_its_name(text):
    try:
        found = parse_cut_times(text, TAKES, "x.txt")
    except ValueError as error:
        assert all(line.startswith("x.txt") for line in str(error).split("\n"))
    else:
        assert found


def test_a_line_that_was_changed_is_seen():
    text = cut_times_text(TAKES[:1], {"ana/long": (Cut(50, 100, "1"),)})
    assert was_edited(text.replace("1.000", "1.020")) and was_edited(text + "9 10 z\n") and was_edited("")
    assert "1.000 2.000 1" in text


def test_one_take_needs_no_name_and_comments_and_blank_lines_are_passed_over():
    text = "# by hand\n\n 1.0  2.0 up   # the first\r\n2.0 2.5 down\n"
    assert parse_cut_times(text, TAKES[:1], "x") == {"ana/long": (Cut(50, 100, "up"), Cut(100, 125, "down"))}


def test_a_take_whose_name_holds_brackets_and_a_hash_is_found():
    takes = (a_take("a#1"), a_take("[b]"))
    cuts = {take.name: (Cut(5, 9, "1"),) for take in takes}
    assert parse_cut_times(cut_times_text(takes, cuts), takes, "x") == cuts


def test_the_end_of_the_take_is_within():
    assert parse_cut_times("0 19.98 all", TAKES[:1], "x")["ana/long"] == (Cut(0, 999, "all"),)


def test_every_mistake_is_said_at_once_with_file_and_line():
    text = "\n".join(
        [
            "1 2 early",
            "[ana/lng]",
            "1 2 passed over",
            "[ana/long]",
            "1.0 2.0",
            "1.0 two 1",
            "3.0 2.0 2",
            "1.0 99 3",
            "4.0 5.0 4",
            "4.5 6.0 5",
            "7.0 8.0 4",
            "nan inf 6",
            "8.0 9.0 a/b",
            "[ana/long]",
        ]
    )
    with pytest.raises(ValueError) as caught:
        parse_cut_times(text, TAKES, "cuts.txt")
    said = str(caught.value).split("\n")
    expected = [
        "cuts.txt:1: found a time before any [worker/trial]",
        "cuts.txt:2: no take 'ana/lng'; did you mean 'ana/long'?",
        "cuts.txt:5: found 2 words, expected three",
        "cuts.txt:6: found 'two', expected seconds",
        "cuts.txt:7: found the end 2.0 s",
        "cuts.txt:8: found 99 s, expected 0 to 19.980 s",
        "cuts.txt:10: found the start 4.500 s, expected 5.000 s or later, where 4 ends",
        "cuts.txt:11: found the name '4' again, first in line 9",
        "cuts.txt:12: found 'nan', expected seconds",
        "cuts.txt:12: found 'inf', expected seconds",
        "cuts.txt:13: found the name 'a/b'",
        "cuts.txt:14: found a second [ana/long]",
    ]
    assert len(said) == len(expected)
    for line, start in zip(said, expected, strict=True):
        assert line.startswith(start), line


def test_a_file_without_times_is_refused():
    with pytest.raises(ValueError, match=r"cuts.txt: found no cut times, expected lines such as"):
        parse_cut_times("# nothing\n[ana/long]\n", TAKES, "cuts.txt")


def test_a_name_is_told_as_a_second_one_even_where_its_times_are_wrong():
    with pytest.raises(ValueError) as caught:
        parse_cut_times("[ana/long]\n1 two a\n3 4 a\n", TAKES, "cuts.txt")
    said = str(caught.value).split("\n")
    assert [line[:11] for line in said] == ["cuts.txt:2:", "cuts.txt:3:"]
    assert "found the name 'a' again, first in line 2" in said[1]
