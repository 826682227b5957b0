import re
import xml.etree.ElementTree as ElementTree
from datetime import UTC, datetime

import numpy as np
import pytest
from plans import CELL, queue

from opsim.report.page import Folded, Words
from opsim.report.plot.plotly import at_ms, clock_axis
from opsim.report.plot.svg_canvas import SvgFigure, disc, figure_of, path_of, polygon, taper
from opsim.report.plot.svg_chart import HEIGHT, SmallChart, around, panels
from opsim.report.plot.svg_chart import SMALL_WIDTH as WIDTH
from opsim.report.sections.cycle_times import cycle_times_section as section
from opsim.report.sections.cycle_times import samples
from opsim.report.sections.wip import jobs_inside
from opsim.report.sections.yamazumi import Bar, Look, bar_traces, in_hover
from tests.made.result import SCRIPT, distribution, material, summary
from tests.opsim.report.made_floor import charts, floor, renamed, strings, words

SVG = "{http://www.w3.org/2000/svg}"


def sheet(xlim=(0.0, 2.0), ylim=(0.0, 1.0)):
    figure = SvgFigure((2.0, 1.0))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=xlim, ylim=ylim, aspect="equal")
    return figure, axes


def drawn(figure, tag):
    return list(ElementTree.fromstring(figure.svg()).iter(f"{SVG}{tag}"))


def test_a_point_stands_where_the_limits_put_it_with_y_upwards():
    figure, axes = sheet()
    axes.plot([0, 2], [0, 1], color="#000")
    assert drawn(figure, "path")[0].get("d") == "M0.0 72.0L144.0 0.0"


def test_a_line_breaks_where_a_point_is_not_known():
    figure, axes = sheet()
    axes.plot([0, 1, np.nan, 1, 2], [0, 0, 0, 1, 1], color="#000")
    assert drawn(figure, "path")[0].get("d") == "M0.0 72.0L72.0 72.0M72.0 0.0L144.0 0.0"


def test_what_is_higher_in_the_pile_is_drawn_later():
    figure, axes = sheet()
    axes.plot([0, 1], [0, 0], color="#111", zorder=5)
    axes.fill([0, 1, 1], [0, 0, 1], facecolor="#222", edgecolor="none", lw=0, zorder=4)
    text = figure.svg().decode()
    assert text.index("#222") < text.index("#111")


def test_words_are_escaped_and_the_same_strokes_are_the_same_bytes():
    sheets = []
    for _ in range(2):
        figure, axes = sheet()
        axes.text(1, 0.5, SCRIPT, va="top", size=10, weight="bold", color="#333", parse_math=False)
        sheets.append(figure.svg())
    assert sheets[0] == sheets[1] and SCRIPT.encode() not in sheets[0]
    assert drawn(figure, "text")[0].text == SCRIPT


def test_columns_are_lines_of_their_own():
    figure, axes = sheet()
    axes.plot(np.zeros((2, 3)), np.ones((2, 3)), color="#000", alpha=0.1)
    assert len(drawn(figure, "path")) == 3


def test_a_png_needs_matplotlib_and_says_so(monkeypatch):
    monkeypatch.setattr("opsim.report.page.find_spec", lambda name: None)
    with pytest.raises(ValueError, match=r"pip install opsim\[matplotlib\]"):
        figure_of("png", (2.0, 1.0))
    assert isinstance(figure_of("svg", (2.0, 1.0)), SvgFigure)


def numbers(path):
    return [float(number) for number in re.findall(r"-?\d+\.\d", path)]


def test_a_disc_is_two_half_circles():
    path = disc(np.array([10.0, 20.0]), 4.0)
    assert path.count("A") == 2 and numbers(path)[:2] == [14.0, 20.0] == numbers(path)[-2:] and path.endswith("Z")


def test_a_limb_goes_round_its_larger_end_the_long_way():
    """From radius 3 to 1 the outline turns by more than half a circle at the first, less at the second."""
    path = taper(np.zeros(2), np.array([10.0, 0.0]), 3.0, 1.0)
    near_b, near_a = re.findall(r"A(\S+) \S+ 0 (\d) 0", path)
    assert near_b == ("1.0", "0") and near_a == ("3.0", "1")


def test_a_limb_that_points_at_the_viewer_is_a_disc():
    assert taper(np.zeros(2), np.array([0.5, 0.0]), 3.0, 1.0) == disc(np.zeros(2), 3.0)
    assert taper(np.zeros(2), np.array([0.5, 0.0]), 1.0, 3.0) == disc(np.array([0.5, 0.0]), 3.0)


def area(path):
    x, y = np.array(numbers(path)).reshape(-1, 2).T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2


def test_corners_run_the_same_way_round_whichever_way_they_were_given():
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]])
    assert area(polygon(corners)) == area(polygon(corners[::-1])) == pytest.approx(-8.0)


def test_shapes_are_told_by_their_kind():
    assert path_of("disc", (np.zeros(2), 1.0)) == disc(np.zeros(2), 1.0)
    assert path_of("inside", np.eye(3, 2)) == polygon(np.eye(3, 2))
    ends = (np.zeros(2), np.ones(2), 0.2, 0.1)
    assert path_of("taper", ends) == taper(*ends)


def chart(**how):
    return SmallChart("a <b>", (0.0, 10.0), (0.0, 4.0), "x & y", '"said"', **how)


def test_points_lie_where_the_axes_say():
    one = chart()
    one.line([0, 10], [0, 4], "#000")
    (points,) = re.findall(r'points="([^"]*)"', one.svg())
    (x0, y0), (x1, y1) = (map(float, point.split(",")) for point in points.split())
    assert x0 < x1 <= WIDTH and HEIGHT > y0 > y1 > 0


def test_what_lies_beyond_the_frame_stands_on_its_edge():
    assert chart().at_y(99.0) == chart().at_y(4.0) and chart().at_y(-5.0) == chart().at_y(0.0)


def test_words_are_escaped_and_marks_are_round_numbers():
    svg = chart().svg()
    assert "<b>" not in svg and "x &amp; y" in svg and "&quot;said&quot;" in svg
    assert re.findall(r">([\d.]+)</text>", svg) == ["0", "1", "2", "3", "4", "0", "2", "4", "6", "8", "10"]
    assert panels([chart(), chart()]).count("<svg") == 2


def test_a_span_shows_all_values_and_a_constant_has_one_too():
    low, high = around([1.0, 3.0])
    assert low < 1 and high > 3 and around([2.0, 5.0], with_zero=True)[0] == 0
    low, high = around([1.0, 1.0])
    assert low < 1 < high


def test_bars_of_one_look_are_one_trace():
    at_work, waits = Look("work", "#000000"), Look("waits", "#ffffff", pattern="/")
    traces = bar_traces([Bar(at_work, 0, 1, 2), Bar(waits, 0, 3, 1), Bar(at_work, 1, 4, 2.5)])
    assert [(trace["name"], trace["base"], trace["x"], trace["y"]) for trace in traces] == [
        ("work", [1, 4], [2, 2.5], [0, 1]),
        ("waits", [3], [1], [0]),
    ]
    assert "pattern" not in traces[0]["marker"] and traces[1]["marker"]["pattern"]["shape"] == "/"


def test_a_hostile_name_is_no_markup_and_fills_nothing_in():
    (trace,) = bar_traces([Bar(Look(SCRIPT, "#000000"), 0, 0, 1, SCRIPT, SCRIPT)])
    assert "<" not in trace["name"] + trace["text"][0] + trace["customdata"][0]
    assert "%{x}" not in in_hover("%{x}<b>") and "<" not in in_hover("<b>")


def test_a_pattern_shows_in_its_legend_too():
    looks = [Look("a", "#123456", pattern=pattern) for pattern in ("", "/", "\\", "x", ".")]
    assert len({look.swatch for look in looks}) == 5 and all("#123456" in look.swatch[0] for look in looks)


def test_the_clock_of_a_run_reads_as_that_of_its_weekday():
    seen = datetime.fromtimestamp(at_ms(86_400 + 6 * 3600, 90.5).item() / 1000, tz=UTC)
    assert seen.strftime("%a %H:%M:%S") == "Tue 06:01:30"


def test_an_axis_that_may_move_stays_within_its_time():
    still, moves = clock_axis(0, 0, 3600), clock_axis(0, 0, 3600, zoomed=True)
    assert still["fixedrange"] and not moves["fixedrange"]
    assert [moves["minallowed"], moves["maxallowed"]] == moves["range"] and "minallowed" not in still


@pytest.fixture(scope="module")
def cell():
    return section(floor(CELL))


def test_samples_have_the_quantiles_of_the_histogram():
    row = distribution("duration_s", "lift")
    drawn = samples(row, 1000)
    assert (np.count_nonzero(drawn < 2.5), np.count_nonzero(drawn < 5)) == (206, 722)  # 20 and 70 of 97
    assert drawn.min() > 0 and drawn.max() < 10 and np.all(np.diff(drawn) >= 0)


def test_the_dot_is_the_median_and_the_line_goes_from_p10_to_p90():
    figure = charts(section(material(summary())))["violins-duration_s-0"]
    violin, dot = figure["data"]
    assert violin["type"] == "violin" and len(violin["x"]) <= 400
    assert (dot["x"], dot["error_x"]["array"], dot["error_x"]["arrayminus"]) == ([5.0], [3.0], [3.0])


def test_what_never_varies_is_a_word_and_no_violin(cell):
    assert all("press" not in figure["layout"]["yaxis"]["ticktext"] for figure in charts(cell).values())
    assert "Always the same: press 30.00 s." in words(cell)


def test_stations_stand_along_the_flow(cell):
    assert charts(cell)["violins-cycle_time_s-0"]["layout"]["yaxis"]["ticktext"] == [
        "unload",
        "repack1",
        "repack2",
        "store",
    ]


def test_long_times_do_not_press_short_ones_flat():
    rows = [distribution("duration_s", name) for name in ("a", "b", "c")]
    for row, times in zip(rows, (1.0, 1.2, 40.0)):
        row["quantiles"] = {q: value * times for q, value in row["quantiles"].items()}
        row["histogram"] = {**row["histogram"], "edges": [edge * times for edge in row["histogram"]["edges"]]}
    made = section(material(summary(distributions=rows)))
    names = [figure["layout"]["yaxis"]["ticktext"] for figure in charts(made).values()]
    assert names == [["a", "b"], ["c"]]


def test_every_time_is_in_a_table(cell):
    tables = [block.blocks[0] for block in cell.blocks if isinstance(block, Folded)]
    assert [len(table.rows) for table in tables] == [2, 4, 4]
    assert tables[0].columns[1:8] == ("P5", "P10", "P25", "median", "P75", "P90", "P95")


def test_jobs_that_are_still_inside_are_told_of_where_they_are_many(cell):
    """Every 30 s one comes, every 60 s one leaves: of 960 that come in 8 h some 480 leave."""
    over = floor(queue(horizon="8 h", warm_up="0 s", every="30 s", mean="60 s"))
    inside = int(jobs_inside(over.log).level[-1])
    assert inside > 400 and f"{inside} jobs were still inside, against " in words(section(over))
    assert "still inside" not in words(cell)
    assert words(cell).startswith("Of the jobs") and "that left, half were through within" in words(cell)


def test_without_times_there_is_no_section():
    assert section(material(summary(distributions=[]))) is None
    assert isinstance(section(material(summary())).blocks[-1], Words)


def test_hostile_names_are_no_markup():
    made = section(renamed(floor(CELL), unload=SCRIPT, lift=SCRIPT))
    assert not any("<script" in text for figure in charts(made).values() for text in strings(figure))
