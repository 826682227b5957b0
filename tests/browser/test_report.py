import numpy as np
import pytest

from opsim.report.day_picture import Strip, draw_day, legend
from opsim.report.write import write_report
from tests.browser.chromium import Watched, browser
from tests.made_result import NAMES, MadeResult, hostile, summary

pytestmark = pytest.mark.browser
SECTIONS = ("summary", "figures-table", "states", "times", "movements", "made-up", "assumptions", "provenance")
STRIP = b'<svg xmlns="http://www.w3.org/2000/svg" width="900" height="300"><circle cx="40" cy="40" r="9"/></svg>'


@pytest.fixture(scope="module")
def chromium():
    with browser() as running:
        yield running


@pytest.fixture
def report(tmp_path, chromium):
    def opened(content, width=1280):
        return Watched(chromium, write_report(MadeResult(content), tmp_path / "report.html", {"lift": STRIP}), width)

    return opened


def test_the_report_asks_for_nothing_and_complains_of_nothing(report):
    watched = report(summary())
    assert [url for url in watched.requests if not url.startswith(("file:", "data:"))] == []
    assert len([url for url in watched.requests if url.startswith("file:")]) == 1
    assert watched.complaints == []


def test_every_section_is_seen_and_every_figure_drawn(report):
    watched = report(summary())
    heights = watched(f"{list(SECTIONS)}.map(id => document.getElementById(id).getBoundingClientRect().height)")
    assert min(heights) > 40
    figures = watched("Object.keys(JSON.parse(document.getElementById('figures').textContent)).length")
    assert watched("document.querySelectorAll('.js-plotly-plot .main-svg .bars path').length") > 0
    assert watched("document.querySelectorAll('.js-plotly-plot').length") == figures == 5


def test_a_strip_is_a_picture_that_loads(report):
    assert report(summary())("document.querySelector('.strip img').naturalWidth") == 900


def test_a_walk_is_a_picture_that_loads_and_is_found_from_the_top(chromium, tmp_path):
    walk = {"worker": "ana", "picture": STRIP, "words": "1.20 m/s"}
    source = {"source": "made", "licence": "", "n_sequences": 3, "n_workers": 2, "model": "w/walk", "library": "w.npz"}
    page = write_report(
        MadeResult(summary()), tmp_path / "report.html", {}, {"source": source, "walks": [walk], "more": 0}
    )
    watched = Watched(chromium, page)
    assert watched("document.querySelector('#walking img').naturalWidth") == 900
    assert watched("document.querySelector('nav a[href=\"#walking\"]').textContent") == "Walking"
    assert watched.complaints == []


def test_a_hostile_name_does_no_harm_and_is_shown_as_it_is(report):
    watched = report(hostile())
    assert watched("window.harmed") is None
    assert watched("document.querySelectorAll('img').length") == 0
    shown = watched("document.body.textContent")
    assert all(name in shown for name in NAMES)
    assert watched.complaints == []
    labels = watched("[...document.querySelectorAll('#worker_states .ytick text')].map(t => t.textContent)")
    assert labels == ["<script>window.harmed…"]


def test_even_a_script_that_got_in_would_not_run(report):
    watched = report(summary())
    watched(
        "{ const s = document.createElement('script'); s.textContent = 'window.harmed = 1'; document.body.append(s) }"
    )
    assert watched("window.harmed") is None
    assert any("Content Security Policy" in said for said in watched.complaints)


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_sticks_out_to_the_side(report, width):
    watched = report(summary(), width)
    assert watched("document.documentElement.scrollWidth") <= width
    assert (
        watched(
            "Math.max(...[...document.querySelectorAll('.js-plotly-plot')].map(p => p.getBoundingClientRect().right))"
        )
        <= width
    )


def test_figures_follow_the_width_of_the_window(report):
    watched = report(summary())
    watched.page.set_viewport_size({"width": 390, "height": 800})
    watched.page.wait_for_timeout(800)
    assert watched("document.querySelector('#worker_states .main-svg').getBoundingClientRect().width") < 390
    assert watched.complaints == []


def test_the_sections_are_reached_by_keyboard(report):
    watched = report(summary())
    watched.page.keyboard.press("Tab")
    watched.page.keyboard.press("Tab")
    watched.page.keyboard.press("Enter")
    assert watched("location.hash") == "#figures-table"


def test_people_through_the_day_are_a_picture_that_loads_and_is_found_from_the_top(chromium, tmp_path):
    strips = [Strip(name, {"work": np.full(4, 0.5), "wait": np.full(4, 0.5)}) for name in NAMES]
    picture = draw_day(strips, "Mon 06:00", 0.0, 28800.0)
    days = {"picture": picture, "legend": legend(strips), "stretch": "2 h", "alt": NAMES[1]}
    days |= {"cut": False, "shifts": False, "more": 0}
    page = write_report(MadeResult(summary()), tmp_path / "report.html", {}, None, days)
    watched = Watched(chromium, page)
    assert watched("document.querySelector('#days img').naturalWidth") == 1180
    assert watched("document.querySelector('nav a[href=\"#days\"]').textContent") == "People"
    assert watched("window.harmed") is None and watched.complaints == []
