"""Two figures against each other in the report of one variant."""

import math
import re

import numpy as np
import pytest

from opsim.report.comparison import comparison_html
from opsim.report.page import Folded, Svg
from opsim.report.sections import pareto as frontier_shown
from opsim.report.sections.pareto import DIGIT, frontier_section, frontier_sentences, frontier_svg, usual_pair
from opsim.report.sections.scenarios import MOST_VARIANTS
from opsim.report.sections.scenarios import scenarios_section as section
from opsim.results import Result
from opsim.study.compare import Comparison
from opsim.study.pareto import Frontier, placed
from tests.made.result import SCRIPT, kpi, material, summary
from tests.opsim.report.made_floor import beside, charts, strings, words
from tests.opsim.report.made_material import texts

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


@pytest.mark.parametrize("width", [1e-4, 1.0, 1e4])
def test_long_numbers_move_the_picture_away_from_the_name_of_the_axis(width):
    values = {name: np.array([[50.0, 51.0], [at, at * 1.1]]) for name, at in (("a", width), ("b", 1.5 * width))}
    svg = frontier_svg(Frontier(*KEYS, "more", "less", placed(values, np.array([1.0, -1.0])), 2))
    numbers = re.findall(r'<text x="([\d.]+)"[^>]*text-anchor="end"[^>]*>([^<]*)</text>', svg)
    assert len(numbers) > 2 and all(float(x) - DIGIT * len(words) >= 21 for x, words in numbers), numbers


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


RATE, STRAIN = ("throughput_per_h", "", "", "1/h"), ("rula_from_5_min_per_h", "", "", "min/h")


class Made(Result):
    def kpis(self):
        return {key: dict(enumerate(values)) for key, values in self.summary["table"].items()}


def made(folder, name, rate, strain, seed=1, **more):
    table = {RATE: np.array([0.0, 1.0, 2.0, 1.0]) + rate, STRAIN: np.array([0.1, 0.0, 0.2, 0.1]) + strain}
    kpis = [
        {"kpi": key[0], "subject": "", "part": "", "unit": key[3], "mean": float(np.mean(values)), "headline": True}
        for key, values in table.items()
    ]
    content = {"variant": name, "seed": seed, "kpis": kpis, "replications": 4, "window_s": [0, 3600], "table": table}
    return Made(folder, content | more)


@pytest.fixture
def variants(tmp_path):
    return {
        "base": made(tmp_path, "base", 60, 20),
        "raised": made(tmp_path, "raised", 61, 12),
        SCRIPT: made(tmp_path, SCRIPT, 70, 18),
    }


def section_of(variants, name, **more):
    return frontier_shown.pareto_section(
        material({**variants[name].summary, "tasks": [], **more}, siblings=tuple(variants.items()))
    )


def test_output_stands_against_exposure_where_nobody_asked(variants):
    assert [one.kpi for one in usual_pair(variants)] == ["throughput_per_h", "rula_from_5_min_per_h"]
    section = section_of(variants, "base")
    assert section.id == "frontier" and "asks for no two figures" in texts(section)


def test_the_variant_of_the_report_is_marked_and_said(variants):
    found = {name: next(b for b in section_of(variants, name).blocks if isinstance(b, Svg)).text for name in variants}
    assert "raised, this report" in found["raised"] and "base, this report" in found["base"]
    assert all(svg.count('r="10.5"') == 2 for svg in found.values())  # in the picture and in its key
    assert not any("<script" in svg for svg in found.values())


def test_what_the_scenario_asks_for_is_drawn(variants):
    asked = ["less throughput_per_h", "rula_from_5_min_per_h"]
    section = section_of(variants, "base", frontier=asked)
    assert "throughput" in section.title.lower() and "asks for no two" not in texts(section)
    assert "(less is better)" in next(block for block in section.blocks if isinstance(block, Svg)).text


def test_where_variants_are_not_comparable_it_is_said_only_where_it_was_asked(variants, tmp_path):
    variants["raised"] = made(tmp_path, "raised", 61, 12, seed=2)
    assert section_of(variants, "base") is None
    asked = section_of(variants, "base", frontier=["throughput_per_h", "rula_from_5_min_per_h"])
    assert "seeds" in texts(asked)


def test_one_variant_or_a_figure_that_is_the_same_everywhere_tells_nothing(variants, tmp_path):
    assert section_of({"base": variants["base"]}, "base") is None
    alike = {name: made(tmp_path, name, 60, 20 + n) for n, name in enumerate(("base", "other"))}
    assert section_of(alike, "base") is None


KEY = ("throughput_per_h", "", "", "1/h")


class ForestMade:
    """What a comparison needs of a Result: ten replications of one figure."""

    def __init__(self, values, seed=7):
        mean = sum(values) / len(values)
        rows = [kpi("throughput_per_h", unit="1/h", mean=mean, half_width=1.0, headline=True, n=len(values))]
        self.summary = {**summary(), "kpis": rows, "seed": seed, "scenario": "Made line"}
        self.values = values

    def kpis(self):
        return {KEY: dict(enumerate(self.values))}


LUCK = [0.0, 3.0, -2.0, 1.0, 4.0, -3.0, 0.5, 2.0, -1.0, 1.5]
BASE = [60 + luck for luck in LUCK]


def of(**others):
    return beside(material(summary()), base=ForestMade(BASE), **others)


def forest_dots(figure):
    """(x, symbol) of each row from above."""
    found = [(y, x, trace["marker"]["symbol"]) for trace in figure["data"] for x, y in zip(trace["x"], trace["y"])]
    return [(x, symbol) for _, x, symbol in sorted(found)]


def test_one_variant_is_compared_with_nothing():
    assert section(beside(material(summary()), base=ForestMade(BASE))) is None


def test_means_stand_beside_paired_differences_and_what_is_clear_is_full():
    faster = ForestMade([value + 5 + 0.01 * n for n, value in enumerate(BASE)])
    alike = ForestMade([value + luck for value, luck in zip(BASE, reversed(LUCK))])
    made = section(of(faster=faster, alike=alike))
    mean, apart = charts(made).values()
    assert forest_dots(mean)[0] == (pytest.approx(60.6), "diamond")
    assert [symbol for _, symbol in forest_dots(mean)] == ["diamond", "circle", "circle-open"]
    assert forest_dots(apart) == [(pytest.approx(5.045), "circle"), (pytest.approx(0.6), "circle-open")]
    (error,) = (t["error_x"]["array"] for t in apart["data"] if t["marker"]["symbol"] == "circle")
    assert 0 < error[0] < 0.1, "the interval of pairs is narrow, though that of the means is wide"
    assert words(made).startswith("faster is better in throughput (+5.045 ± 0.022 per hour")
    assert (
        any("higher, better" in text for text in strings(apart))
        and "base (this report)" in made.blocks[2].blocks[0].said
    )


def test_the_same_step_in_few_pairs_is_shown_with_how_many():
    few = {"base": ForestMade(BASE[:3]), "tiring": ForestMade([value - 9 for value in BASE[:3]])}
    _, apart = charts(section(beside(material(summary()), **few))).values()
    assert any(
        "-9 in each of 3 pairs: too few to say" in text.replace("\N{MINUS SIGN}", "-") for text in strings(apart)
    )


def test_other_random_numbers_are_shown_and_not_compared():
    made = section(of(other=ForestMade(BASE, seed=8)))
    assert "not compared" in words(made) and [name for name in charts(made) if "apart" in name] == []
    assert len(charts(made)) == 1


def test_of_many_variants_the_best_and_the_worst_are_drawn():
    many = {f"v{n}": ForestMade([value + n / 10 + 0.001 * k for k, value in enumerate(BASE)]) for n in range(-40, 41)}
    made = section(of(**many))
    mean, apart = charts(made).values()
    assert len(forest_dots(mean)) <= MOST_VARIANTS and len(forest_dots(apart)) == len(forest_dots(mean)) - 1
    assert (forest_dots(apart)[0][0], forest_dots(apart)[-1][0]) == (pytest.approx(4.0045), pytest.approx(-3.9955))
    assert "of 82 variants" in made.blocks[2].blocks[0].title


def test_a_figure_that_is_the_same_everywhere_needs_no_picture():
    made = section(of(same=ForestMade(BASE)))
    assert charts(made) == {} and any(isinstance(block, Folded) for block in made.blocks)


def test_hostile_names_are_no_markup():
    made = section(of(**{SCRIPT: ForestMade([value + 5 + 0.01 * n for n, value in enumerate(BASE)])}))
    assert not any("<script" in text for figure in charts(made).values() for text in strings(figure))
