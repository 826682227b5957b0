import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from opsim.report.plot.svg_canvas import SvgFigure, figure_of
from tests.made_result import SCRIPT

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
