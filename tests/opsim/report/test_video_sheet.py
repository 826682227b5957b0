import numpy as np
import pytest

from opsim.report.plot.animation import (
    NARROWEST_PX,
    WIDTH_PX,
    body_width_px,
    clipped,
    columns_of,
    font,
    sheet_of,
    wrapped,
)
from tests.made_cards import video


@pytest.mark.parametrize("n, columns", [(1, 1), (2, 2), (4, 4), (5, 3), (6, 3), (8, 4), (9, 5), (15, 5), (21, 7)])
def test_rows_are_as_full_as_can_be(n, columns):
    assert columns_of(n) == columns


@pytest.mark.parametrize("n", [1, 2, 4, 9, 21])
def test_bodies_lie_side_by_side_inside_the_sheet_and_do_not_overlap(n):
    wide = body_width_px(n)
    sheet = sheet_of(video(n - 1), (wide, 200), "said")
    assert len(sheet.places) == n and NARROWEST_PX <= sheet.picture.size[0] <= WIDTH_PX + 1
    boxes = np.array([(x, y, x + wide, y + 200) for x, y in sheet.places])
    assert boxes.min() > 0 and np.all(boxes[:, 2:].max(axis=0) < np.array(sheet.picture.size))
    for i, a in enumerate(boxes):
        assert not any(np.all(a[:2] < b[2:]) and np.all(b[:2] < a[2:]) for b in boxes[i + 1 :])


def test_both_sides_are_even_as_films_need_them():
    for high in (200, 201):
        assert not any(side % 2 for side in sheet_of(video(1), (150, high), "said").picture.size)


def test_the_place_of_a_body_is_white():
    sheet = sheet_of(video(2), (200, 150), "said")
    for x, y in sheet.places:
        assert np.all(np.asarray(sheet.picture.crop((x + 2, y, x + 198, y + 150))) == 255)


def test_long_words_are_wrapped_and_a_longer_one_is_cut():
    text = "a sentence that is longer than the room there is, with one " + "very" * 60
    lines = wrapped(text, 12, 200)
    assert len(lines) > 2 and all(font(12).getlength(line) <= 200 for line in lines) and lines[-1].endswith("…")
    assert " ".join(lines[:-1]) == text.rpartition(" ")[0]


def test_what_does_not_print_becomes_a_space():
    assert clipped("a\nb\tc\x1b", 12, 200) == "a b c "


def test_a_hostile_name_fits_on_the_sheet():
    made = video(1, task="x\n" * 500, notes=(("\x00", "\u202e" + "y" * 3000),))
    assert sheet_of(made, (150, 200), "said").picture.size[0] == NARROWEST_PX
