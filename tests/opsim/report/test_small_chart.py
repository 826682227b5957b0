import re

from opsim.report.plot.svg_chart import HEIGHT, SmallChart, around, panels
from opsim.report.plot.svg_chart import SMALL_WIDTH as WIDTH


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
