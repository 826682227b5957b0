import json

import pytest

from opsim.report.plot.animation import write_animated
from tests.browser.chromium import Watched, browser
from tests.made.cards import SKELETON, cards

pytestmark = pytest.mark.browser
PAPER = """(letter => {
  window.opsimCards.draw();
  const view = document.querySelector('#card-' + letter + ' .view'), box = view.getBoundingClientRect();
  const drawn = document.getElementById('drawn');
  const paper = document.createElement('canvas'), g = paper.getContext('2d'), dense = drawn.width / drawn.clientWidth;
  [paper.width, paper.height] = [Math.round(dense * box.width), Math.round(dense * box.height)];
  g.drawImage(drawn, -dense * box.x, -dense * box.y);
  return g.getImageData(0, 0, paper.width, paper.height);
})"""
"""Points of a card's picture: read in the same breath as they are drawn, since a browser keeps none of WebGL's."""
INK = f"""(letter => {{
  const points = {PAPER}(letter).data;
  let sum = 0;
  for (let i = 3; i < points.length; i += 4) if (points[i]) sum = (sum * 31 + i + points[i - 3]) % 1000000007;
  return sum;
}})"""
EDGE = f"""(letter => {{
  const picture = {PAPER}(letter), points = picture.data, wide = picture.width, high = picture.height;
  let most = 0;
  for (let i = 3, k = 0; i < points.length; i += 4, k++) {{
    const x = k % wide, y = (k - x) / wide;
    if (y < 2 || x < 2 || x >= wide - 2) most = Math.max(most, points[i]);
  }}
  return most;
}})"""


@pytest.fixture(scope="module")
def chromium():
    with browser() as running:
        yield running


@pytest.fixture
def page(tmp_path, chromium):
    """A page of made cards, recorded ones and emulated ones in turn, paused at its start."""

    def opened(n=2, width=1280, task="reach", **more):
        path = write_animated(cards(n, **more), SKELETON, tmp_path / "page.html", task=task, notes=[("From", "a test")])
        watched = Watched(chromium, path, width)
        watched.page.get_by_role("button", name="Pause").click()
        return watched

    return opened


def seek(watched, time_s):
    watched(f"(t => {{ t.value = {time_s}; t.dispatchEvent(new Event('input')) }})(document.getElementById('time'))")


def ink(watched, letter="A"):
    return watched(f"{INK}({json.dumps(letter)})")


def time_s(watched):
    return watched("Number(document.getElementById('time').value)")


def guess(watched, letter, word):
    watched.page.locator(f"#card-{letter}").get_by_role("button", name=word, exact=True).dispatch_event("click")


def answers(watched):
    return [text for text in watched.page.locator(".answer").all_inner_texts() if text]


def test_the_page_asks_for_nothing_and_complains_of_nothing_while_it_is_used(page):
    watched = page()
    watched.page.keyboard.press("Space")
    guess(watched, "A", "real")
    watched.page.get_by_role("button", name="Who is real?").click()
    watched.page.wait_for_timeout(200)
    assert len(watched.requests) == 1 and watched.complaints == []


def test_it_plays_by_itself_in_real_time_until_paused(page):
    """By a clock that only the test moves on: a busy machine changes nothing."""
    watched = page()
    seek(watched, 0.0)
    clock = watched.page.clock
    clock.install(time=0)
    clock.pause_at(1000)
    watched.page.get_by_role("button", name="Play").click()
    clock.run_for(100)
    at_s = time_s(watched)
    clock.run_for(400)
    assert time_s(watched) - at_s == pytest.approx(0.4, abs=0.02)
    watched.page.get_by_role("button", name="Pause").click()
    still = time_s(watched)
    clock.run_for(150)
    assert time_s(watched) == still


def test_the_body_is_somewhere_else_in_the_middle_and_back_at_the_end(page):
    watched = page()
    seen = {}
    for at_s in (0.0, 0.5, 1.0, 1.7):
        seek(watched, at_s)
        seen[at_s] = ink(watched)
    assert seen[0.0] != seen[0.5] and seen[0.0] == seen[1.0] == seen[1.7]


def test_a_body_is_seen_whole_from_everywhere(page):
    watched = page()
    for degrees in (-180, -90, 0, 45, 90):
        watched(
            f"(v => {{ v.value = {degrees}; v.dispatchEvent(new Event('input')) }})(document.getElementById('turn'))"
        )
        seek(watched, 0.5)
        assert max(watched(f"{EDGE}('{letter}')") for letter in "AD") == 0


def test_a_picture_lies_over_its_card_wherever_the_page_is_scrolled_to(page):
    watched = page(8, 390)
    seek(watched, 0.5)
    watched("document.querySelector('#card-P').scrollIntoView({ behavior: 'instant', block: 'center' })")
    watched.page.wait_for_timeout(200)
    assert watched("scrollY") > 0 and ink(watched, "P") != 0 and watched(f"{EDGE}('P')") == 0


def test_dragging_a_body_turns_all_of_them(page):
    watched = page()
    before = ink(watched, "B")
    box = watched.page.locator("#card-A .view").bounding_box()
    watched.page.mouse.move(box["x"] + 40, box["y"] + 60)
    watched.page.mouse.down()
    watched.page.mouse.move(box["x"] + 120, box["y"] + 60)
    watched.page.mouse.up()
    assert ink(watched, "B") != before


def test_keys_play_step_and_choose_the_speed(page):
    watched = page()
    watched("document.activeElement.blur()")
    seek(watched, 0.5)
    watched.page.keyboard.press("ArrowRight")
    assert time_s(watched) == pytest.approx(0.5 + 1 / 30)
    watched.page.keyboard.press("ArrowLeft")
    assert time_s(watched) == pytest.approx(0.5)
    watched.page.keyboard.press("1")
    assert watched("document.getElementById('speed').value") == "0.25"
    watched.page.keyboard.press("Space")
    assert watched("document.getElementById('play').textContent") == "Pause"


def test_nothing_is_told_before_the_reveal_and_all_after_it(page):
    watched = page()
    assert answers(watched) == []
    watched.page.get_by_role("button", name="Who is real?").click()
    assert answers(watched) == [
        "real: person 0, 1.0 s",
        "emulated: person 1, 1.0 s",
        "real: person 2, 1.0 s",
        "emulated: person 3, 1.0 s",
    ]
    assert watched.page.locator("#score").inner_text() == "You did not guess."


def test_guesses_are_scored_beside_luck(page):
    watched = page()
    for letter, word in zip("ABCD", ("real", "emulated", "emulated", "real")):
        guess(watched, letter, word)
    watched.page.get_by_role("button", name="Who is real?").click()
    # of the six ways to call two of four real, one finds all four and four find two
    assert (
        "2 of 4 right. By luck alone as many or more are right in 83 %" in watched.page.locator("#score").inner_text()
    )
    assert answers(watched)[0].endswith("(right)") and answers(watched)[2].endswith("(wrong)")


def test_a_guess_can_be_taken_back_and_the_game_played_again(page):
    watched = page()
    guess(watched, "A", "real")
    guess(watched, "A", "real")
    guess(watched, "B", "emulated")
    watched.page.get_by_role("button", name="Who is real?").click()
    assert watched.page.locator("#score").inner_text() == "1 of 1 right; 3 not guessed."
    watched.page.get_by_role("button", name="Hide and guess again").click()
    assert answers(watched) == [] and watched.page.locator("[data-guess][aria-pressed=true]").count() == 0


@pytest.mark.parametrize("width", [360, 1280])
def test_nothing_sticks_out_to_the_side(page, width):
    watched = page(4, width)
    assert watched("document.documentElement.scrollWidth") <= width
    widths = watched("[...document.querySelectorAll('.view')].map(c => c.getBoundingClientRect().width)")
    assert min(widths) > 120


def test_who_walks_is_followed_and_stays_in_the_picture(page):
    watched = page(1, travel_m=3.0)
    seek(watched, 1.0)
    assert watched("[...document.querySelectorAll('.view')].every(v => v.clientWidth < 2 * v.clientHeight)")
    assert ink(watched) != 0


def test_who_wants_less_motion_sees_a_still_page_first(tmp_path, chromium):
    path = write_animated(cards(1), SKELETON, tmp_path / "page.html", task="reach")
    calm = chromium.new_page(reduced_motion="reduce")
    calm.goto(path.as_uri())
    calm.wait_for_selector("html[data-drawn]")
    assert calm.locator("#play").inner_text() == "Play"


def test_without_webgl_the_page_says_what_is_missing(tmp_path, chromium):
    path = write_animated(cards(1), SKELETON, tmp_path / "page.html", task="reach")
    bare = chromium.new_page()
    bare.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    bare.goto(path.as_uri())
    bare.wait_for_selector("#wrong:visible")
    assert "cannot draw in three dimensions (WebGL)" in bare.locator("#wrong").inner_text()


def test_a_hostile_name_does_no_harm_and_is_shown_as_it_is(page):
    watched = page(1, task="<img src=x onerror='window.harmed = 1'>")
    assert watched("window.harmed") is None and watched("document.querySelectorAll('img').length") == 0
    assert "<img src=x" in watched("document.body.textContent") and watched.complaints == []
