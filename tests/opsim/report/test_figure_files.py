import xml.etree.ElementTree as ElementTree

import pytest

from opsim.report.page import Card, Chart, Folded, Panels, Picture, Section, Svg
from opsim.report.plot import plotly as figures
from opsim.report.render import Contents, Part, figures_of, safe, write_figures
from tests.made_result import NAMES, states

pytest.importorskip("matplotlib")
CHART = figures.states(states("worker_states", "ana", work=1.0))
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
