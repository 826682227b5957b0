"""What a layout study says of what is better, worse, or the same: from made numbers.

Spaghetti diagrams: to scale, escaped, lines as thick as trips, and the same scale for both.
"""

import re
from types import SimpleNamespace as Made
from xml.etree import ElementTree

import numpy as np
import pytest

from opsim.kpi.catalogue import read_asked
from opsim.report.studies.layout_chart import Drawing, Lanes, Line, layout_pictures
from opsim.report.studies.layout_sentences import answer
from opsim.study.compare import paired
from opsim.study.intervals import t_interval
from opsim.study.layout.evaluate import BEST, EACH, EXPOSURE, SHARE, WALKED, Against
from opsim.study.layout.study import gains, losses

RNG = np.random.default_rng(3)
NOW, LUCK = np.linspace(98, 102, 10), RNG.standard_normal(10)


def against(then, now=NOW):
    difference, p, _ = paired(then, now)
    return Against(t_interval(now), t_interval(then), difference, p, p)


MORE, LESS, HARDLY, PERHAPS = (
    against(NOW * 1.05 + 0.1 * LUCK),
    against(NOW * 0.95 + 0.1 * LUCK),
    against(NOW + 0.5 * (LUCK - LUCK.mean())),
    against(NOW + 20 * (LUCK - LUCK.mean())),
)


def said(walked, best, figure="throughput_per_h", clash="", alike=("proposal_1",), **more):
    asked = Made(best=read_asked(figure), exposure=None, floor=Made(at={"saw": "a", "drill": "b"}), replications=10)
    asked.clash = clash
    at = {"saw": "b", "drill": "a"}
    taken = Made(at=at, moved={}, added=(), proposed=True, name="proposal_1")
    asked.exposure = read_asked("rula_from_5_min_per_h") if more else None
    fresh = {WALKED: walked, BEST: best, EACH: walked, SHARE: walked, **more}
    better, worse = gains(fresh, asked.best), losses(fresh, asked.best)
    found = Made(asked=asked, taken=taken, candidates=(taken,), fresh=fresh, compared={}, alike=alike)
    found.gains, found.losses = better, worse
    return answer(found)


def test_a_gain_is_recommended():
    words = said(LESS, MORE)
    assert words[0].startswith("Swap drill and saw: 5.0") and "more parts an hour" in words[0]
    assert not any(" but " in sentence or "Leave" in sentence for sentence in words)


def test_what_is_clearly_worse_in_both_is_not_recommended():
    words = said(MORE, LESS)
    assert words[0].startswith("Leave it as it is") and words[1].startswith("That was to swap drill and saw: ")


def test_more_walking_for_nothing_is_not_recommended():
    words = said(MORE, HARDLY)
    assert words[0].startswith("Leave it as it is") and not any("saved" in sentence for sentence in words)


def test_a_gain_that_costs_something_says_but_and_the_gain_first():
    few_walked, little_out = said(LESS, LESS)[0], said(MORE, MORE)[0]
    assert few_walked.index("less walking") < few_walked.index(", but ") < few_walked.index("less parts an hour")
    assert little_out.index("more parts an hour") < little_out.index(", but ") < little_out.index("more walking")


def test_of_a_figure_of_which_less_is_better_less_is_the_gain():
    assert "but" not in said(LESS, LESS, "less work_in_progress")[0]
    assert said(MORE, MORE, "less work_in_progress")[0].startswith("Leave it as it is")


def test_only_walking_is_saved_where_the_output_is_surely_the_same():
    assert "the output stays the same within 2 %" in said(LESS, HARDLY)[-1]
    assert not any("What is saved" in sentence for sentence in said(LESS, PERHAPS))


def test_metres_of_a_shift_are_those_of_all_people_together():
    assert "in 8 hours by all together" in said(LESS, MORE)[0]


def test_what_is_not_measured_is_not_told_as_no_difference():
    words = said(LESS, MORE, **{EXPOSURE: against(NOW * np.nan, NOW * np.nan)})[0]
    assert "not measured, because no work that is done here has a known posture" in words
    assert "has most of it: no clear difference" not in words


def test_layouts_that_no_test_tells_apart_are_told_by_name():
    words = said(LESS, MORE, alike=("now", "proposal_1", "proposal_2"))
    assert any(
        one.startswith("No test tells the present layout and proposal_2 from proposal_1 by throughput") for one in words
    )


def test_changes_that_clash_are_said_to_be_left_out():
    assert (
        "left out, since they clash: a and b would stand at c."
        in said(LESS, MORE, clash="a and b would stand at c")[-1]
    )


PLACES = {"a": (0.0, 0.0), "b": (10.0, 0.0), "c": (10.0, 6.0), "d": (0.0, 6.0)}
NAMES = {"a": "saw", "b": "drill <1>", "d": "pack"}


def drawn(*lines, **more):
    return layout_pictures([Drawing("Now", PLACES, NAMES, lines, **more)])


LINE = re.compile(r'<path d="(M[^"]*)"[^>]*stroke-width="([0-9.]+)" stroke-opacity="[0-9.]+" stroke-linejoin')


def strokes(picture):
    """(width, d) of every line between places."""
    return [(float(width), way) for way, width in LINE.findall(picture)]


def test_the_picture_is_well_formed_and_names_are_escaped():
    picture = drawn(Line("a", "b", 10.0), Line("b", "d", 3.0, driven=True), others={"c": "store & <x>"})
    ElementTree.fromstring(picture)
    assert "drill &lt;1&gt;" in picture and "<1>" not in picture


def test_lines_are_as_thick_as_trips():
    (thick, _), (thin, _) = strokes(drawn(Line("a", "b", 40.0), Line("a", "d", 10.0)))
    assert thick == pytest.approx(4 * thin, abs=0.25)


def test_two_floors_have_one_scale_for_ways_and_for_lines():
    one = Drawing("Now", PLACES, NAMES, [Line("a", "b", 40.0)])
    two = Drawing("Then", PLACES, NAMES, [Line("a", "b", 20.0)], moved=frozenset("b"))
    (first, d), (second, e) = strokes(layout_pictures([one, two]))
    assert first == pytest.approx(2 * second, abs=0.1) and d == e


def test_vehicles_are_told_from_people_without_colour():
    assert 'stroke-dasharray="9 6"' in drawn(Line("a", "b", 1.0, driven=True))
    assert 'stroke-dasharray="9 6"' not in drawn(Line("a", "b", 1.0))


def test_along_paths_trips_add_up_on_each_piece():
    ways = {("a", "c"): ("a", "b", "c"), ("a", "b"): ("a", "b")}
    lines = strokes(drawn(Line("a", "c", 10.0), Line("a", "b", 10.0), distance="paths", ways=ways))
    assert [width for width, _ in lines] == [15.0, 7.5]


def test_a_way_goes_around_what_stands_between():
    marks = [(x - 20.0, -13.0, x + 20.0, 13.0) for x in (0.0, 100.0, 200.0)]
    corners = Lanes(marks, (50.0, 40.0)).way((0.0, 0.0), (200.0, 0.0), 4.0)
    assert len(corners) == 4 and all(abs(y) > 13 for _, y in corners[1:3])


def test_two_ways_between_the_same_rows_run_beside_each_other():
    lanes = Lanes([], (50.0, 40.0))
    one, two = (lanes.way((0.0, 0.0), (100.0, 0.0), 4.0) for _ in range(2))
    assert one != two


@pytest.mark.parametrize(
    "places", [{"a": (0.0, 0.0)}, {"a": (0.0, 0.0), "b": (7.0, 0.0)}, {"a": (3.0, 1.0), "b": (3.0, 9.0)}]
)
def test_floors_of_one_place_or_one_row_are_drawn_too(places):
    lines = [Line("a", "b", 2.0)] if len(places) > 1 else []
    ElementTree.fromstring(layout_pictures([Drawing("Now", places, {"a": "saw"}, lines)]))


def test_long_names_stay_in_their_boxes_and_are_shortened_alike_now_and_then():
    long = {"a": "verpackung mit langem Namen", "b": "mmmmmmmmmmmmmmmmmmmmmm"}
    now, then = Drawing("Now", PLACES, long, []), Drawing("Then", {**PLACES, "e": (9.0, 0.0)}, long, [])
    marks = re.findall(
        r'width="([0-9.]+)" height="26.0".*?text-anchor="middle">([^<]*…[^<]*)<', layout_pictures([now, then])
    )
    assert len(marks) == 4 and [name for _, name in marks[:2]] == [name for _, name in marks[2:]]
    assert all(float(wide) > 15 * 0.6 * len(name) for wide, name in marks)
