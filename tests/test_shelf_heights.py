"""The shipped ``shelf_heights.yaml``: what its variants claim, through the command line."""

import json

import pytest

from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from tests.opsim.cli.calls import opsim

KPIS = ("throughput_per_h", "rula_from_5_min_per_h", "rula_from_7_min_per_h", "exposure_by_region")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder, how = tmp_path_factory.mktemp("shelf"), ("--replications", 3, "--processes", 1)
    code, *_ = opsim("run", "shelf_heights", "-o", folder, "--scenario", "base", "--scenario", "hip_height", *how)
    assert code == 0
    return folder


@pytest.mark.slow
def test_a_shelf_at_hip_height_gives_more_and_takes_exposure_away_in_paired_intervals(results):
    code, shown, _ = opsim("compare", results, *(word for kpi in KPIS for word in ("--kpi", kpi)), "--json")
    found = {(d["kpi"], d["subject"], d["part"]): d for d in json.loads(shown)["differences"]}
    rate, five, seven = (found[kpi, "", ""] for kpi in KPIS[:3])
    assert code == 0 and rate["low"] > 0.03 * rate["base"]
    assert five["high"] < -2.0 and seven["high"] < -0.4 * seven["base"]
    spine = [found["exposure_by_region", region, "rula_from_7"] for region in ("trunk", "neck")]
    assert sum(one["high"] for one in spine) < -1.0, "neck and trunk are what a low shelf asks for"
    front = {one["variant"]: one["on_front"] for one in json.loads(shown)["frontier"]["variants"]}
    assert front == {"base": False, "hip_height": True}


@pytest.mark.slow
def test_the_report_says_who_when_and_which_region_and_keeps_the_worst_postures(results):
    page = (results / "base" / "report.html").read_text(encoding="utf-8")
    assert "is exposed most" in page and "worst hour is that from" in page and "What brings them to RULA 7" in page
    assert "The worst postures" in page and page.count('class="posture"') == 4
    assert json.loads((results / "base" / "postures.json").read_text())["worst"][0]["rula"] == [7, 7]


@pytest.mark.slow
def test_who_tires_brings_out_less():
    rates = []
    for variant in ("base", "tiring"):
        plan = compile_plan(read_scenarios("shelf_heights", [variant])[variant])
        rates.append(next(f.value for f in figures(run_plan(plan, 0), plan) if f.kpi == "throughput_per_h"))
    assert 0.9 * rates[0] < rates[1] < rates[0]
