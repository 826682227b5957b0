"""Two figures against each other in the report of one variant."""

import numpy as np
import pytest

from opsim.report.page import Svg
from opsim.report.sections import pareto as frontier_shown
from opsim.report.sections.pareto import usual_pair
from opsim.results import Result
from tests.made_result import SCRIPT, material
from tests.opsim.report.made_material import texts

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
