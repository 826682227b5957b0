"""What comes in by files: told on the assumption sheet, copied beside the results, part of what makes a run."""

import pytest

from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from opsim.study import run_scenario
from opsim.study.assumptions.flow import released, station_model
from opsim.study.results_folder import OtherRun

TEXT = """
opsim: 1
name: files
run: {horizon: 100 s, replications: 1}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 1 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}}
products: {a: {route: [s1]}, b: {route: [s1]}}
sources:
  plan: {kind: schedule, file: lists/orders.csv}
  mixed: {kind: renewal, every: {recorded: gaps.csv, by: trace}, sequence: mix.csv}
cards: {few: {n: 3, to: s1, products: a}}
"""


@pytest.fixture
def file(tmp_path):
    (tmp_path / "lists").mkdir()
    (tmp_path / "lists" / "orders.csv").write_text("time,product,quantity\n5,a,2\n200,b,1\n")
    (tmp_path / "gaps.csv").write_text("10\n20\n")
    (tmp_path / "mix.csv").write_text("product\nb\n")
    (tmp_path / "files.yaml").write_text(TEXT)
    return tmp_path / "files.yaml"


def test_files_go_along_so_that_the_resolved_scenario_runs_from_its_folder(file, tmp_path):
    out = tmp_path / "out"
    run_scenario(read_scenarios(file)["base"], folder=out, processes=1)
    for name in ("lists/orders.csv", "gaps.csv", "mix.csv"):
        assert (out / name).read_bytes() == (tmp_path / name).read_bytes()
    again = tmp_path / "again"
    run_scenario(read_scenarios(out / "scenario.resolved.yaml")["base"], folder=again, processes=1)
    rows = "events/replication_00000.parquet"
    assert (again / "kpis.parquet").read_bytes() == (out / "kpis.parquet").read_bytes()
    assert (again / rows).exists()


@pytest.mark.parametrize("name", ["lists/orders.csv", "gaps.csv", "mix.csv"])
def test_a_list_that_has_changed_is_another_run(name, file, tmp_path):
    run_scenario(read_scenarios(file)["base"], folder=tmp_path / "out", processes=1)
    changed = tmp_path / name
    changed.write_text(changed.read_text() + changed.read_text().splitlines()[-1] + "\n")
    with pytest.raises(OtherRun, match="has changed"):
        run_scenario(read_scenarios(file)["base"], folder=tmp_path / "out", processes=1)


def test_the_assumption_sheet_says_how_jobs_come_in_and_what_holds_them_back(file):
    said = dict(released(compile_plan(read_scenarios(file)["base"])))
    assert said["cards"] == "few: at most 3 jobs of a at once; a job gives its card back when it leaves s1, in no time"
    lines = [line for _, line in released(compile_plan(read_scenarios(file)["base"]))]
    late = "1 of its 2 orders come at the horizon or later"
    assert lines[1] == f"plan: 2 jobs come at the times of the file, none early or late; {late}"
    assert lines[0].startswith(
        "mixed: jobs come with gaps of their own distribution (renewal), one every 15 s on average"
    )


def test_due_dates_of_a_file_are_said_to_be_counted_from_the_start(file, tmp_path):
    (tmp_path / "lists" / "orders.csv").write_text("time,product,due\n5,a,60\n200,b,\n")
    lines = [line for _, line in station_model(compile_plan(read_scenarios(file)["base"]))]
    assert "plan: orders are due when their file says, counted from the start" in lines
