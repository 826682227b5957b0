import json
import re

import pytest

from opsim.report.plot.animation import Video
from opsim.report.plot.video import video_html, write_video
from opsim.report.sections.motions import Card
from tests.made_cards import SKELETON, cards, video


def film_of(page):
    return json.loads(re.search(r'id="film">(.*?)</script>', page, re.DOTALL).group(1))


def test_the_mean_comes_first_then_the_simulated_ones_in_order():
    labels = re.findall(r"<figcaption><b>(.*?)</b>", video_html(video(3)))
    assert labels == ["mean performance", "simulated 1", "simulated 2", "simulated 3"]


def test_who_it_is_stands_below_each_label():
    assert re.findall(r'small">(.*?)</span></figcaption>', video_html(video(1))) == ["person 0", "person 1"]


def test_there_is_no_guessing_on_the_page():
    page = video_html(video(2))
    assert "data-guess" not in page and "answers" not in film_of(page) and 'id="reveal"' not in page


def test_only_the_mean_is_framed():
    assert video_html(video(3)).count('class="card first"') == 1


def test_the_same_video_gives_the_same_page(tmp_path):
    first, again = (write_video(video(2), tmp_path / f"{i}.html") for i in (0, 1))
    assert first.read_bytes() == again.read_bytes()


def test_another_ending_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"found the ending '\.avi', expected \.html or \.gif or \.mp4"):
        write_video(video(1), tmp_path / "x.avi")


@pytest.mark.parametrize("ending", [".html", ".GIF"])
def test_the_ending_decides_whatever_its_case(tmp_path, ending):
    begins = {".html": b"<!doctype html>", ".GIF": b"GIF89a"}[ending]
    assert write_video(video(0, seconds=0.1), tmp_path / f"x{ending}").read_bytes().startswith(begins)


def test_names_cannot_break_out_of_the_page():
    evil = "</script><script>window.harmed = 1</script>"
    mean = Card(cards(1)[0].positions_m, False, evil)
    page = video_html(Video(evil, evil, mean, (), SKELETON, ((evil, evil),)))
    assert "<script>window" not in page and page.count("</script>") == 2
