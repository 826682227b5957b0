"""What is shipped: scenarios that run, libraries that say where they are from."""

from dataclasses import replace

import pytest

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import CHECKS, audit
from opsim.libraries import load_library
from opsim.log import FINISH
from opsim.plan import compile_plan
from opsim.plan.loads import station_loads
from opsim.scenario import read_scenarios
from opsim.shipped import shipped_folder, shipped_scenarios

LIBRARIES = {"public_movements": 7, "bench_work": 9, "walking": 1, "handling": 1}
MADE = ("bench_work", "walking", "handling")


@pytest.mark.parametrize("name", shipped_scenarios())
def test_a_shipped_scenario_runs_in_every_variant(name):
    for loaded in read_scenarios(name).values():
        made = compile_plan(loaded)  # where there are shifts, the first hour may be one in which nobody works
        plan = replace(made, horizon_s=made.horizon_s if made.shifts else 3600.0, warm_up_s=0.0)
        log = run_plan(plan)
        assert audit(log, plan) == CHECKS
        assert len(log.of(FINISH)) > 5
        assert all(row.load is None or row.load < 1 for row in station_loads(plan))


@pytest.mark.parametrize("name", shipped_scenarios())
def test_a_shipped_scenario_fits_on_a_page(name):
    path = shipped_folder() / (name if name.endswith(".yaml") else f"{name}.yaml")
    assert len(path.read_text().splitlines()) < 80


@pytest.mark.parametrize("name", LIBRARIES)
def test_a_shipped_library_says_who_is_behind_it_and_what_made_it(name):
    from emulator.model.library import read_header

    header = read_header(shipped_folder() / "libraries" / f"{name}.npz")
    assert len(header["tasks"]) == LIBRARIES[name]
    library = load_library(shipped_folder() / "libraries" / f"{name}.npz")
    for task in header["tasks"]:
        report = library[task].report
        assert report.source.startswith("UI-PRMD" if name == "public_movements" else "synthetic")
        assert "public domain" in report.licence.lower() or "Public Domain" in report.licence or name in MADE
        assert report.where.replace(" ", "") == "cov_correct==1" or name in MADE
        assert report.command and "/" not in report.command


def test_shipped_libraries_are_small():
    assert sum(path.stat().st_size for path in (shipped_folder() / "libraries").glob("*.npz")) < 10e6
