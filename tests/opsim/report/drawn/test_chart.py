"""Charts as SVG files: known places, the same bytes, words as text, and nothing left out unsaid."""

import xml.etree.ElementTree as ElementTree

import pytest

from opsim.report.page import Chart
from opsim.report.plot import plotly as figures
from opsim.report.plot.matplotlib_chart import chart_svg
from tests.made.result import BOLD, SCRIPT, states

matplotlib = pytest.importorskip("matplotlib")
SVG = "{http://www.w3.org/2000/svg}"
AXES = {"xaxis": {"range": [0, 10]}, "yaxis": {"range": [0, 10]}}


def chart(*data, title="", legend=(), **layout):
    return Chart("one", {"data": list(data), "layout": {"height": 300, **AXES, **layout}}, "said", title, legend)


def root(made, **other):
    return ElementTree.fromstring(chart_svg(made, **other))


def words(made):
    return [of.text for of in root(made).iter(f"{SVG}text")]


def test_the_same_chart_gives_the_same_bytes_without_a_date():
    made = Chart("states", figures.states(states("worker_states", "ana", work=0.6, wait=0.4)), "said", "Workers")
    first = chart_svg(made, [("#0072B2", "work")])
    assert first == chart_svg(made, [("#0072B2", "work")]) and b"dc:date" not in first


def test_words_are_text_and_no_name_is_markup_or_a_formula():
    said = words(chart({"type": "scatter", "x": [1], "y": [1]}, title=SCRIPT, legend=[("#000", BOLD)]))
    assert SCRIPT in said and BOLD in said


def test_names_of_the_page_stand_as_they_were_before_they_were_escaped():
    shown = figures.states(states("worker_states", "<b>&", work=1.0))
    assert "<b>&" in words(Chart("x", shown, "said"))


@pytest.mark.parametrize(
    "trace",
    [
        {
            "type": "bar",
            "x": ["a", "b"],
            "y": [3, 4],
            "error_y": {"type": "data", "array": [1, 1], "arrayminus": [2, 1]},
        },
        {
            "type": "bar",
            "orientation": "h",
            "y": [0, 1],
            "x": [3, 4],
            "base": [1, 2],
            "marker": {"pattern": {"shape": "/"}},
        },
        {"type": "scatter", "mode": "lines+markers+text", "x": [1, None, 3], "y": [1, 2, 3], "text": ["a", "b", "c"]},
        {
            "type": "scatter",
            "mode": "markers",
            "x": [1, 2],
            "y": [1, 2],
            "marker": {"symbol": ["circle-open", "line-ns"]},
        },
        {"type": "scatter", "x": [1, 2], "y": [1, 2], "fill": "toself", "line": {"shape": "hv", "dash": "4px,3px"}},
        {"type": "heatmap", "z": [[1, None], [2, 3]], "colorscale": [[0, "#ffffff"], [1, "#0072B2"]]},
        {"type": "violin", "x": [1.0, 2.0, 2.5, 4.0], "y0": 3, "orientation": "h", "side": "positive"},
        {"type": "box", "x": [1], "lowerfence": [1], "q1": [2], "median": [3], "q3": [4], "upperfence": [5]},
    ],
)
def test_every_kind_of_chart_is_drawn(trace):
    axes = {} if trace["type"] == "bar" and "base" not in trace else AXES
    made = Chart("one", {"data": [trace], "layout": {"height": 240, **axes}}, "said")
    assert len(list(root(made).iter(f"{SVG}path"))) > 2


def test_what_is_not_known_is_refused_instead_of_left_out():
    for trace in ({"type": "pie"}, {"type": "scatter", "x": [1], "y": [1], "fill": "tonextx"}):
        with pytest.raises(ValueError, match="no drawing of"):
            chart_svg(chart(trace))
    with pytest.raises(ValueError, match="no drawing of a shape 'path'"):
        shape = {"type": "path", "x0": 0, "x1": 1, "y0": 0, "y1": 1}
        chart_svg(chart({"type": "scatter", "x": [1], "y": [1]}, shapes=[shape]))


def test_words_that_are_wider_than_their_bar_are_left_out():
    bar = {"type": "bar", "orientation": "h", "x": [0.05, 8], "y": [1, 2], "text": ["no room", "room"]}
    said = words(chart(bar))
    assert "room" in said and "no room" not in said


def test_times_are_read_from_milliseconds_on_the_clock_of_the_first_week():
    monday = 4 * 86400_000
    axis = {"type": "date", "range": [monday, monday + 4 * 3600_000], "tickformat": "%H:%M\n%a"}
    line = {"type": "scatter", "x": [monday, monday + 7200_000], "y": [1, 2]}
    said = words(chart(line, xaxis=axis))
    assert "02:00" in said and "Mon" in said and "Thu" not in said


def test_a_second_axis_stands_on_the_other_side_over_the_first():
    lines = [
        {"type": "scatter", "x": [1, 2], "y": [1, 2]},
        {"type": "scatter", "x": [1, 2], "y": [500, 900], "yaxis": "y2"},
    ]
    said = words(chart(*lines, yaxis2={"overlaying": "y", "side": "right", "range": [0, 1000], "dtick": 250}))
    assert "750" in said and "10" in said


def test_shapes_and_notes_stand_where_the_page_has_them():
    line = {"type": "line", "x0": 5, "x1": 5, "y0": 0, "y1": 1, "yref": "paper"}
    note = {"x": 5, "y": 1, "yref": "paper", "text": "a <b>takt</b><br>&lt;of&gt; 60 s", "showarrow": False}
    said = words(chart({"type": "scatter", "x": [1], "y": [1]}, shapes=[line], annotations=[note]))
    assert "a takt" in said and "<of> 60 s" in said
