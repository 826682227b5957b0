"""The picture and the page of a cleaned recording, from arrays and words alone.

The picture of what was imported.

The picture of a cut take.
"""

import base64
import json
import re
import warnings
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from emulator.skeleton import Skeleton, standard_skeleton
from opsim.ergonomics.options import USUAL
from opsim.ergonomics.scores.scoring import bounds_of
from opsim.ergonomics.shift.movement import scored_movements
from opsim.report.motion.cleaning import VERDICTS, CleanedView, Finding, Mended, TakeCard, _liveliest, _moments
from opsim.report.motion.cleaning_charts import MOST_ROWS, cleaned_bytes, ink_on, rows_of, shade, write_cleaned
from opsim.report.motion.importing import Shown, _apart, _clear_frames, draw_import, drawable
from opsim.report.motion.scoring import LEVELS, Said, _badge, page, write_scored
from opsim.report.motion.segmentation import CutTake, apart, draw_cuts, spread
from opsim.report.plot.animation import animated_html, write_animated
from opsim.report.sections.motions import Card
from opsim.subjects.exposure.plan import Handling
from tests.emulator.recordings.body import body
from tests.emulator.segmenting.made_movements import walking
from tests.made.cards import SKELETON as SKELETON_of_animated
from tests.made.cards import cards
from tests.opsim.ergonomics.shift.test_movement import movement

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


def shown(positions=None, title="a.bvh: ana/1"):
    take = body(40, 50.0)
    bones = len(take.names) - 1
    positions = take.positions_m if positions is None else positions
    return Shown(
        title, "BVH, 40 frames", take.names, take.parents, positions, 50.0, np.full(bones, 0.3), np.full(bones, 0.01)
    )


@pytest.fixture(scope="module")
def imported():
    """The picture of a take, as SVG."""
    return draw_import([shown()], "svg")


def test_the_same_take_gives_the_same_picture(imported):
    assert imported.startswith(b"<?xml") and imported == draw_import([shown()], "svg")


def test_the_picture_of_a_take_comes_as_png_too():
    assert draw_import([shown()], "png").startswith(b"\x89PNG")


def test_every_joint_is_named_once_and_no_name_lies_on_another():
    heights = _apart([1.0, 1.0, 0.99, 0.2, 0.2, 0.19], 0.1, 0.1, 1.0)
    assert all(a - b >= 0.1 - 1e-9 for a, b in pairwise(heights)) and max(heights) <= 1.0
    assert min(heights) >= 0.1 - 1e-9


def test_moments_are_those_that_show_the_body():
    positions = body(40, 50.0).positions_m.copy()
    positions[:10, 4] = np.nan
    frames = _clear_frames(shown(positions), 8)
    assert frames[0] == 10 and frames[-1] == 39 and len(frames) == 8


def test_a_take_with_nothing_but_gaps_is_drawn_too():
    positions = body(40, 50.0).positions_m.copy()
    positions[:, [0, 13]] = np.nan
    assert draw_import([shown(positions)], "svg")
    positions[:] = np.nan
    assert draw_import([shown(positions)], "svg")


def test_more_takes_than_rows_are_drawn_as_far_as_there_is_room(imported, monkeypatch):
    monkeypatch.setattr("opsim.report.motion.importing.MOST_ROWS", 2)
    many = [replace(shown(), title=f"take {k}") for k in range(3)]
    picture = draw_import(many, "svg")
    assert len(picture) > len(imported) and b"and 2 more" in picture
    assert b"take 1" in picture and b"take 2" not in picture


def test_characters_without_a_glyph_become_question_marks_and_names_of_files_are_no_formulas():
    assert drawable("日本_é.bvh\nµ") == "??_é.bvh\nµ" and drawable("日本.bvh\t\x1b") == "??.bvh??"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert draw_import([shown(title="日本$a_b$ ^{ \\frac.bvh\t\x1b")], "svg").startswith(b"<?xml")


@pytest.fixture(scope="module")
def cut_take():
    take = walking(3.0, 30.0)
    time_s = np.arange(take.n_frames) / take.rate_hz
    return CutTake(
        title="w1/1: 2 cycles <b>",
        time_s=time_s,
        curve=np.sin(2 * np.pi * time_s),
        says="coordinate on the manifold",
        pieces=[(0.2, 1.2, "first"), (1.2, 2.2, "second")],
        skeleton=Skeleton(take.names, take.parents),
        positions_m=take.positions_m,
        posture_s=np.array([0.2, 0.7, 1.2, 2.2]),
        units=[("initial", 0.0, 0.2), ("cyclic", 0.2, 2.2), ("final", 2.2, 3.0)],
        manifold=np.stack([np.cos(6 * time_s), np.sin(6 * time_s)], axis=1),
        manifold_s=time_s,
    )


def test_the_picture_names_pieces_units_and_take_and_is_the_same_every_time(cut_take, tmp_path):
    one, other = (draw_cuts([cut_take], tmp_path / name).read_bytes() for name in ("a.svg", "b.svg"))
    assert one == other
    for word in ("first", "second", "cyclic", "w1/1: 2 cycles &lt;b&gt;", "coordinate on the manifold"):
        assert word in one.decode()


def test_several_takes_stand_below_each_other_as_png(cut_take, tmp_path):
    assert draw_cuts([cut_take, cut_take], tmp_path / "two.png").read_bytes().startswith(b"\x89PNG")


def test_figures_stand_near_their_time_but_never_in_each_other():
    wanted = np.array([0.1, 0.15, 0.2, 5.0, 9.9, 9.95])
    places = spread(wanted, 10.0, 0.8)
    assert np.all(np.diff(places) > 0.8 - 1e-12) and places.min() >= 0 and places.max() <= 10
    assert places[3] == 5.0
    assert np.array_equal(spread(np.array([2.0, 4.0]), 10.0, 1.0), [2.0, 4.0])


def test_the_colours_of_units_are_explained_and_a_heading_stands_above(cut_take, tmp_path):
    drawn = draw_cuts([cut_take], tmp_path / "a.svg", heading="the first 1 of 9 takes").read_text(encoding="utf-8")
    assert "initial and final" in drawn and "the first 1 of 9 takes" in drawn


def test_times_on_the_manifold_do_not_stand_in_one_another():
    ring = np.stack([np.cos(np.linspace(0, 40, 600)), np.sin(np.linspace(0, 40, 600))], axis=1)
    chosen = ring[apart(ring)] / 2
    away = np.abs(chosen[:, None] - chosen[None]) / (0.24, 0.09)
    assert 3 < len(chosen) <= 10 and np.all(away.max(axis=-1)[~np.eye(len(chosen), dtype=bool)] > 0.99)


HANDLING = Handling(
    load_kg=8.0,
    grip="fair",
    force="repeated",
    forearm="mid",
    arms_supported=False,
    sitting=False,
    legs="balanced",
    rapid=False,
)


def told(*movements, handling=HANDLING, title="made", notes=("taken",)):
    scored = scored_movements(movements, bounds_of(handling))
    return page(Said(title, standard_skeleton(), handling, USUAL, False, notes), scored)


@pytest.fixture(scope="module")
def bends():
    return told(movement(0.0, 70.0, name="one"), movement(0.0, 20.0, -15.0, name="<other>"))


def test_the_worst_posture_is_drawn_from_two_sides_with_its_sub_scores(bends):
    """RULA of a trunk at 70 degrees, arms along it, elbows straight: trunk 4, neck 1, upper arm 1, lower arm 2."""
    first = bends.split('<article class="posture">')[1]
    assert "A. one, at 0.75 s" in first and first.count("<svg") == 2
    assert "Trunk flexed 70°" in first and '<td>trunk</td><td class="number">4</td>' in first
    assert '<td>lower arm</td><td class="number">2</td>' in first


def test_postures_behind_upright_are_said_to_be_bent_back():
    assert "Trunk bent back 15°" in told(movement(-15.0))


def test_names_are_escaped_and_nothing_is_fetched(bends):
    assert "&lt;other&gt;" in bends and "<other>" not in bends
    assert "default-src 'none'" in bends and 'src="http' not in bends and "<script" not in bends


def test_intervals_are_said_as_such():
    open_ = told(movement(0.0, 70.0), handling=Handling(load_kg=8.0))
    assert " to " in open_.split('<article class="posture">')[1] and "at most" in open_.split("The worst postures")[1]


def test_a_chip_has_the_colours_and_words_of_both_ends(bends):
    """REBA of 70 degrees with a load of which nothing else is said spans levels; of a task all said, it has one."""
    chip = _badge("reba", {"score": (3, 9)})
    assert chip["colours"] == [LEVELS[1], LEVELS[3]] and chip["score"] == "3 to 9"
    assert chip["text"].startswith("at least: low risk") and "at most: high risk" in chip["text"]
    one = _badge("reba", {"score": (4, 7)})
    assert one["colours"] == [LEVELS[2]] * 2 and one["text"] == "medium risk, action necessary"
    assert "at least:" not in bends.split('<article class="posture">')[1].split("</p>")[0]


def test_copies_of_a_posture_are_one_card_with_their_time():
    text = told(movement(*[70.0] * 8, name="one"), movement(70.0, 70.0, name="two"))
    assert text.count('<article class="posture">') == 1
    assert "Postures like it (angles within 20°): 5.0 s, in 2 of 2 movements" in text


def test_a_load_is_drawn_only_while_it_is_held():
    held = replace(movement(0.0, 70.0, seconds=2.0), carrying=np.array([True, False]))
    cards = told(held).split('<article class="posture">')[1:]
    drawn = sorted(("nothing in the hands" in card, "#dcc298" in card) for card in cards)
    assert drawn == [(False, True), (True, False)]


def test_telephones_have_a_picture_of_their_own(bends):
    assert 'class="course slim"' in bends and 'class="course broad"' in bends


def test_where_nothing_is_known_it_says_so():
    text = told(movement(np.nan, np.nan))
    assert "Nothing is known of any posture" in text and "not known" in text


def test_the_page_says_how_it_was_scored(bends):
    assert "<dt>arm reference</dt><dd>trunk</dd>" in bends and "<dt>threshold twist</dt><dd>10</dd>" in bends


def test_the_page_is_written_whole(tmp_path):
    scored = scored_movements([movement(0.0, 40.0)], bounds_of(HANDLING))
    write_scored(tmp_path / "a.html", Said("made", standard_skeleton(), HANDLING, USUAL, False, ()), scored)
    assert (tmp_path / "a.html").read_text().rstrip().endswith("</html>")
    assert [path.name for path in tmp_path.iterdir()] == ["a.html"]


NOTES = [("Fitted to", "recordings of <i>nobody</i>")]


def film_of(page):
    return json.loads(re.search(r'id="film">(.*?)</script>', page, re.DOTALL).group(1))


def test_the_positions_come_back_to_a_millimetre():
    shown = cards(2)
    film = film_of(animated_html(shown, SKELETON_of_animated, task="reach"))
    for card, packed in zip(shown, film["cards"]):
        back = np.frombuffer(base64.b64decode(packed), "<i2").reshape(card.positions_m.shape) / 1000
        assert np.abs(back - card.positions_m).max() <= 0.0005 + 1e-9


def test_the_page_does_not_say_who_is_who_but_in_its_packed_answers():
    page = animated_html(cards(3), SKELETON_of_animated, task="reach", notes=NOTES)
    answers = json.loads(base64.b64decode(film_of(page)["answers"]))
    assert [is_real for is_real, _ in answers] == [1, 0, 1, 0, 1, 0]
    assert answers[0][1] == "person 0, 1.0 s"
    assert "person 0" not in page and "3 recorded, 3 emulated" in page


def test_the_same_cards_give_the_same_bytes(tmp_path):
    first, again = (
        write_animated(cards(2), SKELETON_of_animated, tmp_path / f"{i}.html", task="reach") for i in (0, 1)
    )
    assert first.read_bytes() == again.read_bytes()


def test_eight_performances_of_six_seconds_cost_little_beside_the_script_that_draws_people():
    pages = [
        len(animated_html(cards(4, seconds=seconds), SKELETON_of_animated, task="reach").encode())
        for seconds in (1.0, 6.0)
    ]
    assert pages[1] - pages[0] < 300_000 and pages[1] < 1_500_000


def test_names_cannot_break_out_of_the_page():
    evil = "</script><script>window.harmed = 1</script>"
    shown = [Card(card.positions_m, card.is_real, evil) for card in cards(1)]
    page = animated_html(shown, SKELETON_of_animated, task=evil, notes=[(evil, evil)])
    assert "<script>window" not in page and page.count("</script>") == 3


def test_a_movement_on_the_spot_is_not_followed_and_a_walk_is():
    still, walk = cards(1), cards(1, travel_m=2.0)
    assert film_of(animated_html(still, SKELETON_of_animated, task="x"))["camera"]["follow"] is False
    assert film_of(animated_html(walk, SKELETON_of_animated, task="x"))["camera"]["follow"] is True


def test_more_cards_than_letters_are_refused():
    with pytest.raises(ValueError, match="found 28, expected 1 to 26"):
        animated_html(cards(14), SKELETON_of_animated, task="x")


def test_a_body_that_leaves_the_stage_is_refused():
    with pytest.raises(ValueError, match=r"41\.6 m from the start, expected under 32 m"):
        animated_html([Card(cards(1)[0].positions_m + 40.0, True, "")], SKELETON_of_animated, task="x")
