"""What variability costs, from variants without it."""

import numpy as np
import pytest
from plans import HERE

from opsim.report.material import Material
from opsim.report.page import Grid, Panels
from opsim.report.sections import variability as budget
from opsim.report.sections.variability import budget_of
from opsim.scenario.read import scenarios_in
from opsim.study import run_scenario
from opsim.study.run import opened
from tests.opsim.report.made_material import texts

KEY = ("throughput_per_h", "", "", "1/h")
TEXT = """
opsim: 1
name: switches
run: {horizon: 30 min, replications: 3, seed: 5, staffing: redrawn}
layout: {places: {a: [0 m, 0 m]}}
tasks: {label: {dist: lognormal, mean: 12 s, cv: 0.3, between_share: 0.6}}
stations: {one: {at: a, tasks: [label], buffer: 3}}
products: {box: {route: [one]}}
release: {kind: saturated}
workers: {ana: {skills: {one: 1.0}}}
overrides:
  w: {run.variability: within_only}
  b: {run.variability: between_only}
  n: {run.variability: none}
  m: {workers.ana.skills: {one: 1.1}}
scenarios: {base: [], alike: [w], steady: [b], neither: [n], quicker: [m]}
outputs: [throughput_per_h, time_in_system_s]
"""


def test_parts_and_what_they_do_to_each_other_add_up_to_the_whole():
    rng = np.random.default_rng(3)
    values = {switch: rng.normal(50, 5, 12) for switch in ("full", "within_only", "between_only", "none")}
    one = budget_of(KEY, values)
    assert one.whole.mean == pytest.approx(one.all_off.mean - one.full.mean)
    assert sum(part.mean for part in one.parts.values()) + one.interaction.mean == pytest.approx(one.whole.mean)
    assert one.parts["between workers"].mean == pytest.approx((values["within_only"] - values["full"]).mean())


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("switches")
    read = scenarios_in(TEXT.encode(), HERE / "switches.yaml")
    results = {name: run_scenario(one, folder=folder / name, processes=1) for name, one in read.items()}
    return {name: Material(opened(results[name], read[name]), results) for name in read}


def test_each_switch_is_told_with_its_interval_and_a_waterfall_is_drawn(runs):
    section = budget.variance_budget_section(runs["base"])
    said = texts(section)
    assert "People alike: " in " ".join(section.blocks[0].items) and "other people and other days" in said
    assert "both off is the variant neither" in said and "quicker" not in said
    panels = next(block for block in section.blocks if isinstance(block, Panels))
    assert panels.blocks and "what they do to each other" in panels.blocks[0].text
    table = next(block for block in section.blocks if isinstance(block, Grid))
    assert table.columns == ("Figure", "as it is", "people alike", "each steady", "both off")


def test_all_who_differ_by_a_switch_say_the_same_and_others_nothing(runs):
    assert texts(budget.variance_budget_section(runs["neither"])) == texts(budget.variance_budget_section(runs["base"]))
    assert budget.variance_budget_section(runs["quicker"]) is None


def test_one_variant_has_no_budget(runs):
    base = runs["base"]
    assert budget.variance_budget_section(Material(base.run, {"base": base.result})) is None
