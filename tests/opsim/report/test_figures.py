"""Figures sorted by what they are of."""

import base64
import hashlib
import xml.etree.ElementTree as ElementTree

import jinja2
import pytest

from opsim.kpi.catalogue import BODIES, EXPOSURE, FLOW, KINDS, KPIS, MATERIAL, PEOPLE, POSTURE, STATIONS, kind_of
from opsim.report.material import Same
from opsim.report.page import Card, Chart, Folded, Grid, Panels, Picture, Section, Svg, asset, flat, policy, template
from opsim.report.plot import plotly as figures
from opsim.report.plot.plotly import STATE_COLOURS as STATES
from opsim.report.plot.plotly import in_order, label, legend, states, wrong_sums
from opsim.report.render import Contents, Part, figures_of, safe, write_figures
from opsim.report.sections.summary import MOST, in_front
from opsim.report.sections.summary import kpi_section as section
from tests.made.result import NAMES, SCRIPT, kpi, material, summary
from tests.made.result import states as state_rows
from tests.made.result import states as states_of_figure_files


def test_the_bars_of_each_subject_sum_to_one():
    rows = state_rows("worker_states", "ana", work=0.6, wait=0.4) + state_rows(
        "worker_states", "ben", walk=0.3, work=0.7
    )
    figure = states(rows)
    assert [sum(bar["x"][i] for bar in figure["data"]) for i in (0, 1)] == pytest.approx([1.0, 1.0])
    assert wrong_sums(rows) == []


def test_shares_that_do_not_sum_to_one_are_named():
    assert wrong_sums(state_rows("worker_states", "ana", work=0.6, wait=0.3)) == [("ana", pytest.approx(0.9))]


def test_states_that_take_no_time_have_no_legend():
    rows = state_rows("station_states", "weld", work=0.9, blocked=0.0, starved=0.1)
    assert [words for _, words in legend(rows)] == ["work", "no job"]


def test_an_unknown_state_is_drawn_last():
    assert in_order(["juggling", "wait", "work"]) == ["work", "wait", "juggling"]


def test_no_two_states_have_one_colour():
    colours = [fill for fill, _ in STATES.values()]
    assert len(set(colours)) == len(colours)


def test_labels_cannot_be_read_as_markup():
    assert label(SCRIPT[:15]) == "&lt;script&gt;window."
    assert "<" not in label(SCRIPT) and label("x" * 40).endswith("…")


pytest.importorskip("matplotlib")
CHART = figures.states(states_of_figure_files("worker_states", "ana", work=1.0))
SECTION = Section(
    "day",
    "Day",
    [
        Picture(b"<svg xmlns='http://www.w3.org/2000/svg'/>", "a"),
        Panels([Chart("one", CHART, "said"), Svg('<svg viewBox="0 0 1 1"></svg>', "b")]),
        Folded("more", [Chart("two", CHART, "said"), Card("t", "", "", ["<svg></svg>", "<svg></svg>"], [], "")]),
    ],
)


def test_every_figure_of_a_section_has_a_file_those_within_others_too(tmp_path):
    paths = write_figures(Contents([Part("p", "P", "P", [SECTION])]), tmp_path / "deep" / "svg")
    assert [path.name for path in paths] == ["one.svg", "two.svg", "day-1.svg", "day-2.svg", "day-3.svg", "day-4.svg"]
    for path in paths:
        assert ElementTree.parse(path).getroot().tag == "{http://www.w3.org/2000/svg}svg"


def test_a_picture_that_says_what_it_is_stays_as_it_is():
    assert dict(figures_of(SECTION))["day-1"] == b"<svg xmlns='http://www.w3.org/2000/svg'/>"


@pytest.mark.parametrize("name", [*NAMES, "../../out", "..", "", "a/b\\c", "x" * 500, "con\n"])
def test_no_name_leads_out_of_the_folder(name):
    made = safe(name)
    assert made and "/" not in made and "\\" not in made and "." not in made and len(made) <= 80


def test_only_the_scripts_as_they_stand_may_run():
    digest = base64.b64encode(hashlib.sha256(b"1 + 1").digest()).decode()
    assert f"script-src 'sha256-{digest}';" in policy("1 + 1") and "default-src 'none'" in policy("1 + 1")
    assert policy("1 + 1").endswith("base-uri 'none'; form-action 'none'")
    assert "unsafe-inline" not in policy("1 + 1").partition("script-src")[2].partition(";")[0]


def test_a_name_that_the_page_needs_and_nobody_gives_is_an_error():
    with pytest.raises(jinja2.UndefinedError):
        template("animated.html.jinja").render()


@pytest.mark.parametrize("name", ["report.css", "report.js", "animated.css", "guess.js"])
def test_our_scripts_and_styles_fetch_nothing(name):
    text = asset(name)
    assert "</script" not in text and "</style" not in text
    assert not any(word in text for word in ("http:", "https:", "//cdn", "fetch(", "XMLHttpRequest", "@import", "url("))


def test_only_the_very_same_is_the_same():
    one, other = {"a": 1}, {"a": 1}
    assert Same(one) == Same(one) and hash(Same(one)) == hash(Same(one)) and Same(one) != Same(other)


def test_every_kind_has_figures():
    assert {kind_of(kpi) for kpi in KPIS} == set(KINDS)


def test_what_is_named_of_each_is_of_it():
    assert all(kind_of(kpi) == BODIES for kpi in (*POSTURE, *EXPOSURE))
    found = [kind_of(kpi) for kpi in ("throughput_per_h", "station_states", "stock", "fatigue_mean", "unheard_of")]
    assert found == [FLOW, STATIONS, MATERIAL, PEOPLE, FLOW]


def walked(n):
    return [kpi("walked_m", f"w{i}", unit="m", mean=100.0 + i, headline=True) for i in range(n)]


def test_a_figure_of_few_stands_in_front_with_each_of_them():
    rows = walked(MOST)
    assert in_front(rows) == (rows, {})


def test_of_a_figure_of_many_the_whole_stays_and_each_is_folded_away():
    whole = kpi("walked_m", unit="m", headline=True)
    front, folded = in_front([whole, *walked(MOST + 1)])
    assert front == [whole] and len(folded["walked_m"]) == MOST + 1


def test_of_what_nobody_sums_the_most_and_the_least_stay():
    front, _ = in_front(walked(MOST + 5))
    assert [row["subject"] for row in front] == [f"w{MOST + 4}", "w0"]


def test_every_row_of_the_summary_stands_in_a_table_of_seven_columns():
    made = material(summary(kpis=[*summary()["kpis"], *walked(MOST + 1)]))
    front, folded, *_ = tables = [block for block in flat(section(made).blocks) if isinstance(block, Grid)]
    assert front.title == "" and folded.title == f"Walked, each of {MOST + 1}"
    assert front.columns[3] == "95 % interval" and all(len(row) == 7 for table in tables for row in table.rows)
    assert {"work", "blocked"} <= {row[1].split(" · ")[-1] for table in tables for row in table.rows}
