import base64
import json
import re

import numpy as np
import pytest

from opsim.report.plot.animation import animated_html, write_animated
from opsim.report.sections.motions import Card
from tests.made_cards import SKELETON, cards

NOTES = [("Fitted to", "recordings of <i>nobody</i>")]


def film_of(page):
    return json.loads(re.search(r'id="film">(.*?)</script>', page, re.DOTALL).group(1))


def test_the_positions_come_back_to_a_millimetre():
    shown = cards(2)
    film = film_of(animated_html(shown, SKELETON, task="reach"))
    for card, packed in zip(shown, film["cards"]):
        back = np.frombuffer(base64.b64decode(packed), "<i2").reshape(card.positions_m.shape) / 1000
        assert np.abs(back - card.positions_m).max() <= 0.0005 + 1e-9


def test_the_page_does_not_say_who_is_who_but_in_its_packed_answers():
    page = animated_html(cards(3), SKELETON, task="reach", notes=NOTES)
    answers = json.loads(base64.b64decode(film_of(page)["answers"]))
    assert [is_real for is_real, _ in answers] == [1, 0, 1, 0, 1, 0]
    assert answers[0][1] == "person 0, 1.0 s"
    assert "person 0" not in page and "3 recorded, 3 emulated" in page


def test_the_same_cards_give_the_same_bytes(tmp_path):
    first, again = (write_animated(cards(2), SKELETON, tmp_path / f"{i}.html", task="reach") for i in (0, 1))
    assert first.read_bytes() == again.read_bytes()


def test_eight_performances_of_six_seconds_cost_little_beside_the_script_that_draws_people():
    pages = [len(animated_html(cards(4, seconds=seconds), SKELETON, task="reach").encode()) for seconds in (1.0, 6.0)]
    assert pages[1] - pages[0] < 300_000 and pages[1] < 1_500_000


def test_names_cannot_break_out_of_the_page():
    evil = "</script><script>window.harmed = 1</script>"
    shown = [Card(card.positions_m, card.is_real, evil) for card in cards(1)]
    page = animated_html(shown, SKELETON, task=evil, notes=[(evil, evil)])
    assert "<script>window" not in page and page.count("</script>") == 3


def test_a_movement_on_the_spot_is_not_followed_and_a_walk_is():
    still, walk = cards(1), cards(1, travel_m=2.0)
    assert film_of(animated_html(still, SKELETON, task="x"))["camera"]["follow"] is False
    assert film_of(animated_html(walk, SKELETON, task="x"))["camera"]["follow"] is True


def test_more_cards_than_letters_are_refused():
    with pytest.raises(ValueError, match="found 28, expected 1 to 26"):
        animated_html(cards(14), SKELETON, task="x")


def test_a_body_that_leaves_the_stage_is_refused():
    with pytest.raises(ValueError, match=r"41\.6 m from the start, expected under 32 m"):
        animated_html([Card(cards(1)[0].positions_m + 40.0, True, "")], SKELETON, task="x")
