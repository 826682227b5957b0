import pytest

from opsim.report.page import Folded
from opsim.report.sections.scenarios import MOST_VARIANTS
from opsim.report.sections.scenarios import scenarios_section as section
from tests.made_result import SCRIPT, kpi, material, summary
from tests.opsim.report.made_floor import beside, charts, strings, words

KEY = ("throughput_per_h", "", "", "1/h")


class Made:
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
    return beside(material(summary()), base=Made(BASE), **others)


def dots(figure):
    """(x, symbol) of each row from above."""
    found = [(y, x, trace["marker"]["symbol"]) for trace in figure["data"] for x, y in zip(trace["x"], trace["y"])]
    return [(x, symbol) for _, x, symbol in sorted(found)]


def test_one_variant_is_compared_with_nothing():
    assert section(beside(material(summary()), base=Made(BASE))) is None


def test_means_stand_beside_paired_differences_and_what_is_clear_is_full():
    faster = Made([value + 5 + 0.01 * n for n, value in enumerate(BASE)])
    alike = Made([value + luck for value, luck in zip(BASE, reversed(LUCK))])
    made = section(of(faster=faster, alike=alike))
    mean, apart = charts(made).values()
    assert dots(mean)[0] == (pytest.approx(60.6), "diamond")
    assert [symbol for _, symbol in dots(mean)] == ["diamond", "circle", "circle-open"]
    assert dots(apart) == [(pytest.approx(5.045), "circle"), (pytest.approx(0.6), "circle-open")]
    (error,) = (t["error_x"]["array"] for t in apart["data"] if t["marker"]["symbol"] == "circle")
    assert 0 < error[0] < 0.1, "the interval of pairs is narrow, though that of the means is wide"
    assert words(made).startswith("faster is better in throughput (+5.045 ± 0.022 per hour")
    assert (
        any("higher, better" in text for text in strings(apart))
        and "base (this report)" in made.blocks[2].blocks[0].said
    )


def test_the_same_step_in_few_pairs_is_shown_with_how_many():
    few = {"base": Made(BASE[:3]), "tiring": Made([value - 9 for value in BASE[:3]])}
    _, apart = charts(section(beside(material(summary()), **few))).values()
    assert any(
        "-9 in each of 3 pairs: too few to say" in text.replace("\N{MINUS SIGN}", "-") for text in strings(apart)
    )


def test_other_random_numbers_are_shown_and_not_compared():
    made = section(of(other=Made(BASE, seed=8)))
    assert "not compared" in words(made) and [name for name in charts(made) if "apart" in name] == []
    assert len(charts(made)) == 1


def test_of_many_variants_the_best_and_the_worst_are_drawn():
    many = {f"v{n}": Made([value + n / 10 + 0.001 * k for k, value in enumerate(BASE)]) for n in range(-40, 41)}
    made = section(of(**many))
    mean, apart = charts(made).values()
    assert len(dots(mean)) <= MOST_VARIANTS and len(dots(apart)) == len(dots(mean)) - 1
    assert (dots(apart)[0][0], dots(apart)[-1][0]) == (pytest.approx(4.0045), pytest.approx(-3.9955))
    assert "of 82 variants" in made.blocks[2].blocks[0].title


def test_a_figure_that_is_the_same_everywhere_needs_no_picture():
    made = section(of(same=Made(BASE)))
    assert charts(made) == {} and any(isinstance(block, Folded) for block in made.blocks)


def test_hostile_names_are_no_markup():
    made = section(of(**{SCRIPT: Made([value + 5 + 0.01 * n for n, value in enumerate(BASE)])}))
    assert not any("<script" in text for figure in charts(made).values() for text in strings(figure))
