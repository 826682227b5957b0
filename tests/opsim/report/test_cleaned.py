"""The picture and the page of a cleaned recording, from arrays and words alone."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from opsim.report.motion.cleaning import VERDICTS, CleanedView, Finding, Mended, TakeCard, _liveliest, _moments
from opsim.report.motion.cleaning_charts import MOST_ROWS, cleaned_bytes, ink_on, rows_of, shade, write_cleaned

SKELETON = SimpleNamespace(names=("pelvis", "left_hip", "right_hip", "head", "right_knee"), parents=(-1, 0, 0, 0, 2))
STANDING = np.array([[0, 0, 1.0], [0, 0.1, 0.9], [0, -0.1, 0.9], [0, 0, 1.6], [0.1, -0.1, 0.5]])


def mended(n=40, **changes):
    before = np.repeat(STANDING[None], n, axis=0)
    after = before.copy()
    before[20:22, 4] += [0.0, 0.0, 0.3]
    words, time_s = "jumps; bridged", np.arange(n) / 50
    usual = Mended("a/1", "repaired", "right_knee", words, time_s, before, after, 0.4, 0.42, 0.4, SKELETON)
    return replace(usual, **changes)


def view(cards=None, worst=None):
    found = Finding("jump", 0.4, 0.42, "30.0 cm", 1.0, True, "right_knee: jumps <b>; bridged")
    cards = [TakeCard("a/1", 0.78, "repaired", (found,)), TakeCard("a/2", 1.0, "good", ())] if cards is None else cards
    return CleanedView("two takes", cards, [("jump", "leaves")], [mended()] if worst is None else worst, ["a", "b"])


def test_the_page_holds_the_picture_and_every_finding_with_names_escaped(tmp_path):
    write_cleaned(view(), tmp_path / "a.svg", tmp_path / "a.html")
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "right_knee: jumps &lt;b&gt;; bridged" in page and "<link" not in page and " src=" not in page
    picture = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert picture[picture.index("<svg") :] in page


def test_the_picture_is_the_same_each_time_and_comes_as_png_too():
    assert cleaned_bytes(view()) == cleaned_bytes(view())
    assert cleaned_bytes(view(worst=[]), "png").startswith(b"\x89PNG")


@pytest.mark.parametrize(
    "worst",
    [
        mended(skeleton=SimpleNamespace(names=("a", "b", "c", "d", "right_knee"), parents=(-1, 0, 1, 2, 3))),
        mended(after_m=np.full((40, 5, 3), np.nan)),
        mended(before_m=np.where(np.arange(40)[:, None, None] < 30, np.nan, mended().before_m)),
    ],
    ids=["no hips", "nothing left", "a long gap"],
)
def test_what_cannot_be_drawn_is_left_empty(worst):
    assert cleaned_bytes(view(worst=[worst])).startswith(b"<?xml")


def test_a_recording_without_findings_is_drawn():
    cards = [TakeCard("a/1", 1.0, "good", ())]
    assert cleaned_bytes(CleanedView("one", cards, [], [], ["nothing was found"])).startswith(b"<?xml")


def test_of_many_takes_the_worst_are_drawn_in_their_order():
    cards = [TakeCard(f"a/{i}", 1.0, "bad" if i in (50, 90) else "good", ()) for i in range(100)]
    rows, hidden = rows_of(cards)
    assert len(rows) == MOST_ROWS and hidden == 60
    assert [card.name for card in rows][-2:] == ["a/50", "a/90"]


def test_colours_grow_darker_with_size_and_stay_readable():
    light = [sum(int(shade(share, True)[i : i + 2], 16) for i in (1, 3, 5)) for share in (0, 0.5, 1, 7)]
    assert light[0] > light[1] > light[2] == light[3]
    assert ink_on(shade(0, True)) == "#111111" and ink_on(shade(1, True)) == "#ffffff"
    assert set(VERDICTS) == {"left out", "bad", "shortened", "repaired", "told", "good"}


def test_the_coordinate_that_changed_most_is_drawn():
    assert _liveliest(mended().before_m[:, 4], mended().after_m[:, 4]) == 2


def test_bodies_stand_at_moments_within_the_take():
    times = _moments(mended(at_s=0.0, first_s=0.0, last_s=0.02))
    assert len(times) == 5 and times[0] >= 0 and np.all(np.diff(times) > 0)
    assert _moments(mended(at_s=0.78, first_s=0.76, last_s=0.78))[-1] <= 0.78
