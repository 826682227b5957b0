import numpy as np
import pytest

from opsim.report.page import (
    Bullets,
    Card,
    Caution,
    Chart,
    Facts,
    Folded,
    Grid,
    Heading,
    Legend,
    Panel,
    Panels,
    Picture,
    Section,
    Svg,
    Words,
)
from opsim.report.plot.plotly import layout_of
from opsim.report.render import Contents, Part, report_html, write_report
from opsim.report.sections import worker_timeline as days
from opsim.report.sections.worker_timeline import Strip, draw_day, legend
from tests.browser.axe import serious
from tests.browser.chromium import Watched, browser
from tests.made.result import NAMES, SCRIPT, hostile, material, summary

pytestmark = pytest.mark.browser
STRIP = b'<svg xmlns="http://www.w3.org/2000/svg" width="900" height="300"><circle cx="40" cy="40" r="9"/></svg>'
ALL_DRAWN = "document.documentElement.hasAttribute('data-all-drawn')"
FIGURES = "Object.keys(JSON.parse(document.getElementById('figures').textContent))"
OVER_THE_EDGE = """width => [...document.querySelectorAll('main *')].filter(e => {
    const box = e.getBoundingClientRect();
    return box.width > 0 && box.right > width + 0.5 && !e.closest('.scroll, svg, nav');
}).map(e => e.outerHTML.slice(0, 120))"""


def until(watched, script, tries=1000):
    """Waits without evaluating text within the page, which its policy forbids."""
    for _ in range(tries):
        if watched(script):
            return
        watched.page.wait_for_timeout(50)
    raise AssertionError(f"never true: {script}")


@pytest.fixture(scope="module")
def chromium():
    with browser() as running:
        yield running


@pytest.fixture
def opened(tmp_path, chromium):
    """A page that is closed again."""
    pages = []

    def open_page(path, width=1280):
        pages.append(Watched(chromium, path, width))
        until(pages[-1], ALL_DRAWN)
        return pages[-1]

    yield open_page
    for watched in pages:
        watched.page.close()


@pytest.fixture
def report(tmp_path, opened):
    def made(content, width=1280):
        return opened(write_report(material(content, strip=STRIP), tmp_path / "report.html").path, width)

    return made


@pytest.fixture(scope="module")
def plain(tmp_path_factory, chromium):
    """The report of the made summary, for tests that only look."""
    made = material(summary(), strip=STRIP)
    watched = Watched(chromium, write_report(made, tmp_path_factory.mktemp("plain") / "report.html").path)
    until(watched, ALL_DRAWN)
    return watched


def line(**axis):
    layout = layout_of(200)
    layout["xaxis"] |= axis
    return {"data": [{"type": "scatter", "x": [0, 10], "y": [1, 2]}], "layout": layout}


EVERYTHING = Section(
    "everything",
    "Everything",
    [
        *(Words("plain"), Words("small", muted=True), Caution("beware"), Bullets(["one", "two"]), Heading("More")),
        Facts([("Library", "moves.npz", "sha256 " + 64 * "a")]),
        Legend([("#0072B2", "solid", "line"), ("#0072B2", "dot", "dot"), ("#0072B2", "field")]),
        Chart("chart-zoomed", line(range=[0, 10], fixedrange=False), "a line", "Zoomed", note="below"),
        Panels([Chart("chart-small", line(), "a line", "Small"), Panel("Same", "always 3 s"), Words("beside")]),
        Panels(
            [Card("Ana", "RULA 7", "Mon", ['<svg width="210" height="300"></svg>'] * 2, [("trunk", "3", "#fff")], "")]
        ),
        Picture(STRIP, "a strip", "Strip", "as carry", "caption"),
        Svg('<svg viewBox="0 0 1200 200" width="1200" height="200"></svg>', "a map", "Map", wide=True),
        Svg('<svg viewBox="0 0 1200 200" width="1200" height="200"></svg>', "a map"),
        Grid(("A", "B", "C"), [("a", "1", "made up"), ("", "2", "")], "Table", tags=(2,), left=(2,)),
        Folded("Folded", [Chart("chart-folded", line(), "a line"), Grid(("A",), [("a",)], "Inner", folded=True)]),
        Folded("Not on paper", [Words("inside")], on_paper=False),
    ],
    "Everything",
)
PAGE = Contents([Part("part-one", "One", "Part one", [EVERYTHING, Section("other", "Other", [Words("x")], "Other")])])


@pytest.fixture
def everything(tmp_path, opened):
    """A page of every kind of block."""

    def made(width=1280):
        path = tmp_path / "everything.html"
        path.write_text(report_html(material(summary()), PAGE), encoding="utf-8")
        return opened(path, width)

    return made


def test_the_report_asks_for_nothing_and_complains_of_nothing(plain):
    watched = plain
    assert [url for url in watched.requests if not url.startswith(("file:", "data:"))] == []
    assert len([url for url in watched.requests if url.startswith("file:")]) == 1
    assert watched.complaints == []


def test_every_section_is_seen_and_every_figure_drawn(plain):
    watched = plain
    heights = watched("[...document.querySelectorAll('.section')].map(s => [s.id, s.getBoundingClientRect().height])")
    assert {"figures-table", "states", "movements", "made-up", "assumptions", "provenance", "stress-des"} <= {
        name for name, _ in heights
    }
    assert min(height for _, height in heights) > 40
    assert watched("document.querySelectorAll('.js-plotly-plot .main-svg').length") > 0
    assert watched(f"{FIGURES}.every(id => document.getElementById(id).classList.contains('js-plotly-plot'))")


def test_a_strip_is_a_picture_that_loads(plain):
    assert plain("document.querySelector('.strip img').naturalWidth") == 900


def test_a_hostile_name_does_no_harm_and_is_shown_as_it_is(report):
    watched = report(hostile())
    assert watched("window.harmed") is None
    assert watched("document.querySelectorAll('img').length") == 1
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
def test_nothing_sticks_out_to_the_side(everything, report, width):
    for watched in (everything(width), report(hostile(), width)):
        assert watched("document.documentElement.scrollWidth") <= width
        assert watched.page.evaluate(OVER_THE_EDGE, width) == []


def test_figures_follow_the_width_of_the_window(report):
    watched = report(summary())
    watched.page.set_viewport_size({"width": 390, "height": 800})
    until(watched, "document.querySelector('#worker_states .main-svg').getBoundingClientRect().width < 390")
    assert watched.complaints == []


def test_the_first_key_leads_past_the_links_and_the_next_to_the_parts(report):
    watched = report(summary())
    watched.page.keyboard.press("Tab")
    assert watched("document.activeElement.textContent") == "Skip to the report"
    watched.page.keyboard.press("Enter")
    assert watched("location.hash") == "#summary"
    watched = report(summary())
    for key in ("Tab", "Tab", "Tab", "Enter"):
        watched.page.keyboard.press(key)
    assert watched("location.hash") == "#part-figures"


def test_everything_that_opens_moves_or_scrolls_is_reached_by_keyboard(everything):
    watched = everything(390)
    reached = set()
    for _ in range(60):
        watched.page.keyboard.press("Tab")
        reached.add(watched("document.activeElement.tagName + '.' + document.activeElement.className"))
    assert {"A.skip", "SUMMARY.", "BUTTON.", "DIV.scroll wide"} <= reached


def test_a_figure_that_is_folded_away_is_drawn_as_it_is_opened(everything):
    watched = everything()
    drawn = "document.getElementById('chart-folded').classList.contains('js-plotly-plot')"
    assert not watched(drawn)
    watched.page.click("summary")
    until(watched, drawn)
    assert watched.complaints == []


def test_the_room_of_a_figure_is_kept_until_it_is_drawn_so_that_nothing_jumps(everything):
    assert everything()("document.getElementById('chart-small').style.minHeight") == "200px"


def test_buttons_move_the_clock_of_a_figure_and_stay_within_it(everything):
    watched = everything()
    at = "document.getElementById('chart-zoomed').layout.xaxis.range.map(v => Math.round(v * 100) / 100)"
    press = "name => [...document.querySelectorAll('.zoom button')].find(b => b.textContent.includes(name)).click()"
    watched.page.evaluate(press, "closer")
    until(watched, f"JSON.stringify({at}) === '[2.5,7.5]'")
    for _ in range(3):
        watched.page.evaluate(press, "later")
    until(watched, f"JSON.stringify({at}) === '[5,10]'")
    watched.page.evaluate(press, "all")
    until(watched, f"JSON.stringify({at}) === '[0,10]'")
    assert watched("document.querySelectorAll('.zoom').length") == 1 and watched.complaints == []


def test_on_paper_all_is_unfolded_and_drawn_and_the_links_are_gone(everything):
    watched = everything()
    watched.page.emulate_media(media="print")
    watched("window.dispatchEvent(new Event('beforeprint'))")
    assert watched("[...document.querySelectorAll('details')].map(d => d.open)") == [True, True, False]
    assert watched(f"{FIGURES}.every(id => document.getElementById(id).classList.contains('js-plotly-plot'))")
    assert watched("[...document.querySelectorAll('nav, .skip, .zoom')].every(e => e.offsetHeight === 0)")
    assert len(watched.page.pdf(format="A4")) > 20_000
    watched("window.dispatchEvent(new Event('afterprint'))")
    assert watched("[...document.querySelectorAll('details')].every(d => !d.open)")


def test_every_kind_of_block_is_fit_for_who_cannot_see_or_has_no_mouse(everything):
    watched = everything(390)
    watched("document.querySelectorAll('details').forEach(part => part.open = true)")
    assert serious(watched.page) == []


def test_people_through_the_day_are_a_picture_that_loads_and_is_found_from_the_top(monkeypatch, report):
    strips = [Strip(name, {"work": np.full(4, 0.5), "wait": np.full(4, 0.5)}) for name in NAMES]
    picture = draw_day(strips, "Mon 06:00", 0.0, 28800.0)
    day = {"picture": picture, "legend": legend(strips), "stretch": "2 h", "alt": SCRIPT}
    day |= {"cut": False, "shifts": False, "more": 0}
    monkeypatch.setattr(days, "worker_timeline_section", lambda material: days.section_of(day))
    watched = report(summary())
    assert watched("document.querySelector('#days img').naturalWidth") == 1180
    assert watched("document.querySelector('nav a[href=\"#part-people\"]').textContent") == "People"
    assert watched("window.harmed") is None and watched.complaints == []
