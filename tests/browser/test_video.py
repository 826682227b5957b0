import io

import numpy as np
import pytest
from PIL import Image

from opsim.report.plot.video import Film, posture, write_video
from tests.browser.chromium import Watched, browser
from tests.browser.test_animated import ink, seek
from tests.made.cards import video

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def chromium():
    with browser() as running:
        yield running


@pytest.fixture
def page(tmp_path, chromium):
    """A page of a mean and simulated ones, the longest last, paused at its start."""

    def opened(n=2, width=1280, **more):
        watched = Watched(chromium, write_video(video(n, **more), tmp_path / "page.html"), width)
        watched.page.get_by_role("button", name="Pause").click()
        return watched

    return opened


def test_it_asks_for_nothing_and_complains_of_nothing(page):
    watched = page()
    watched.page.keyboard.press("Space")
    watched.page.wait_for_timeout(200)
    assert len(watched.requests) == 1 and watched.complaints == []


def test_the_shorter_mean_waits_in_its_last_posture_for_the_longest(page):
    watched = page()
    seen = {}
    for at_s in (0.25, 0.5, 0.6):
        seek(watched, at_s)
        seen[at_s] = ink(watched, "mean"), ink(watched, "2")
    assert seen[0.25][0] != seen[0.5][0] == seen[0.6][0] and seen[0.5][1] != seen[0.6][1]


def test_the_mean_stands_to_the_left_and_all_bodies_on_one_line(page):
    watched = page(3)
    of_all = "[...document.querySelectorAll('.view')].map(c => c.getBoundingClientRect()).map(b => [b.x, b.bottom])"
    boxes = watched(of_all)
    assert [x for x, _ in boxes] == sorted(x for x, _ in boxes) and len({round(bottom) for _, bottom in boxes}) == 1
    assert watched("document.querySelector('.card').id") == "card-mean"


@pytest.mark.parametrize("width", [360, 1280])
def test_nothing_sticks_out_to_the_side(page, width):
    watched = page(5, width, notes=(("Fitted to", "x" * 300),))
    assert watched("document.documentElement.scrollWidth") <= width


def test_the_page_shows_the_posture_of_the_gif_from_the_same_side(page):
    """Bodies in three dimensions and the painter's flat ones: the same limbs at the same places, in other shades."""
    shown, at_s = video(1), 0.25
    film = Film(shown, 20.0)
    watched = page(1)
    seek(watched, at_s)
    watched.page.wait_for_timeout(100)
    drawn = watched.page.locator("#card-mean .view").screenshot()
    python = np.asarray(film.painter.picture(posture(shown.mean, at_s), film.usual[0])).astype(int)
    size = python.shape[1::-1]
    javascript = np.asarray(Image.open(io.BytesIO(drawn)).convert("RGB").resize(size)).astype(int)
    for limb in (is_blue, is_orange):
        flat, round_ = limb(python), limb(javascript)
        assert np.sum(flat & round_) > 0.6 * np.sum(flat | round_) > 100


def is_blue(picture):
    """Points of left limbs."""
    return (picture[..., 2] - picture[..., 0] > 40) & (picture[..., 2] > picture[..., 1])


def is_orange(picture):
    """Points of right limbs."""
    return picture[..., 0] - picture[..., 2] > 60
