from dataclasses import replace

import numpy as np
import pytest

from emulator.skeleton import standard_skeleton
from opsim.ergonomics.options import USUAL
from opsim.ergonomics.scores.scoring import bounds_of
from opsim.ergonomics.shift.movement import scored_movements
from opsim.plan.tasks import Handling
from opsim.report.motion.scoring import LEVELS, Said, _badge, page, write_scored
from tests.opsim.ergonomics.shift.test_movement import movement

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
