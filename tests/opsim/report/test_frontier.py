import math
import re

import numpy as np

from opsim.report.comparison import comparison_html
from opsim.report.sections.pareto import frontier_section, frontier_sentences, frontier_svg
from opsim.study.compare import Comparison
from opsim.study.pareto import Frontier, placed

HARM = '<script>alert("x")</script>'
KEYS = ("throughput_per_h", "", "", "1/h"), ("walked_m", "ana", "", "m")


def frontier(means, **more):
    """Ten pairs of replications about means (throughput, walked)."""
    luck = np.random.default_rng(3).normal(0, 1, (2, 10))
    noise = np.random.default_rng(4)
    values = {name: np.array([[x], [y]]) + luck + noise.normal(0, 0.1, (2, 10)) for name, (x, y) in means.items()}
    return Frontier(*KEYS, "more", "less", placed(values, np.array([1.0, -1.0])), 10, **more)


def test_a_variant_without_a_figure_is_said_with_the_figure():
    values = {"a": np.array([[1.0, 2.0], [1.0, 2.0]]), "plain": np.array([[1.0, 2.0], [np.nan] * 2])}
    found = Frontier(*KEYS, "more", "less", placed(values, np.array([1.0, -1.0])), 2, False, (("plain", ("tired",)),))
    said = frontier_sentences(found)
    assert "Not shown, as there is no tired there: plain." in said and not any("observed" in one for one in said)


THREE = frontier({"floor": (50, 30), "hip": (55, 20), "slow": (40, 10)})


def dots(svg):
    return [(float(x), float(y)) for x, y in re.findall(r'<circle cx="([\d.]+)" cy="([\d.]+)"', svg)]


def test_every_variant_has_a_dot_and_a_bar_each_way_and_more_is_to_the_right_and_up():
    svg = frontier_svg(THREE)
    floor, hip, slow = dots(svg)
    assert floor[0] < hip[0] and floor[1] < hip[1] < slow[1] and slow[0] < floor[0]
    assert len(re.findall(r'stroke-width="2"/>', svg)) == 3 * 2 and svg.count("stroke-dasharray") == 1


def test_the_front_is_joined_by_steps_through_its_variants():
    svg = frontier_svg(THREE)
    _, hip, slow = dots(svg)
    path = re.search(r'<path d="(M[^"]*)" fill="none"', svg).group(1)
    assert path == f"M{slow[0]:.1f} {slow[1]:.1f}V{hip[1]:.1f}H{hip[0]:.1f}"


def test_the_section_says_what_nothing_beats_and_what_is_beaten():
    section = frontier_section(THREE)
    said = " ".join(section["sentences"])
    assert "no variant beats hip and slow" in said and "Clearly beaten: floor by hip." in said and "10 pairs" in said
    assert section["title"] == "Walked · ana against Throughput (good units)"
    assert [words for *_, words in section["legend"]] == ["no other variant beats it", "clearly beaten"]


def test_a_best_in_both_and_a_doubtful_one_are_said_as_such():
    said = frontier_sentences(frontier({"floor": (50.0, 30.0), "hip": (50.02, 20.0)}))
    assert "hip is the best in both" in said[0] and "Behind by the means only: floor by hip" in said[1]


def test_other_hours_and_what_was_never_observed_are_said():
    values = {"a": np.array([[math.nan] * 3, [1.0] * 3]), "b": np.arange(6.0).reshape(2, 3)}
    unknown = Frontier(*KEYS, "more", "less", placed(values, np.array([1.0, -1.0]), tested=False), 3, other_hours=True)
    said = " ".join(frontier_sentences(unknown))
    assert "observed in no replication: a" in said and "different hours" in said
    assert len(dots(frontier_svg(unknown))) == 1 and "nan" not in frontier_svg(unknown)


def test_no_name_becomes_markup_in_page_or_picture():
    page = comparison_html(Comparison("base", 1, 10, ()), "Try", frontier({HARM: (1, 2), "b": (2, 1)}))
    assert "<script" not in page and "&lt;script&gt;" in page and 'id="frontier"' in page
    assert 'id="frontier"' not in comparison_html(Comparison("base", 1, 10, ()), "Try")


def test_axes_have_round_numbers_without_needless_zeros_and_one_unit():
    svg = frontier_svg(frontier({"a": (480.0, 20.0), "b": (400.0, 26.0)}))
    assert ">440<" in svg and ">22<" in svg and "Throughput (good units), per hour (more is better)" in svg
    assert "per scheduled hour (more" in frontier_svg(THREE, hours=True)


def test_of_many_variants_every_one_has_a_dot_and_some_of_the_front_a_name():
    rng = np.random.default_rng(5)
    means = dict(zip((f"v{i}" for i in range(200)), zip(rng.normal(50, 9, 200), rng.normal(20, 9, 200))))
    found = frontier(means)
    svg, front = frontier_svg(found), [point.variant for point in found.points if point.on_front]
    names = re.findall(r">(v\d+)</text>", svg)
    assert svg.count("<circle") == 200 and 0 < len(names) <= 12 and set(names) <= set(front)
    assert len(frontier_sentences(found)[0]) < 400
