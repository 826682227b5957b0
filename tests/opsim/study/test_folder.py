import json
import shutil
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plans import CELL, loaded

from opsim.scenario import read_scenarios
from opsim.scenario.yaml import read_tree
from opsim.shipped import shipped_folder
from opsim.study import run_scenario
from opsim.study.resolved_scenario import decides_figures, differences, read_resolved, resolved_text, with_run
from opsim.study.results_folder import OtherRun, other_run

SHORT = CELL.replace("horizon: 2 h", "horizon: 20 min")


def run(folder, text=SHORT, **how):
    return run_scenario(loaded(text), folder=folder, processes=1, **how)


def content(folder: Path) -> dict:
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("finished")
    run(folder)
    (folder / "report.html").write_text("of seed 5")
    return folder


@pytest.mark.parametrize(
    "text, seed, said",
    [
        (SHORT, 9, "seed 5, now 9"),
        (SHORT.replace("20 min", "30 min"), None, "run.horizon 20 min, now 30 min"),
        (SHORT.replace("every: 40 s", "every: 50 s"), None, "release.every 40 s, now 50 s"),
    ],
)
def test_another_run_is_refused_and_nothing_is_touched(finished, text, seed, said):
    before = content(finished)
    with pytest.raises(OtherRun, match=f"3 replications of 'cell', variant base, seed 5; not the same: .*{said}"):
        run(finished, text, seed=seed)
    assert content(finished) == before


def test_overwriting_leaves_nothing_of_the_other_run(finished, tmp_path):
    folder = tmp_path / "copy"
    shutil.copytree(finished, folder)
    run(folder, seed=9, replications=1, overwrite=True)
    assert not (folder / "report.html").exists()
    assert [path.name for path in (folder / "events").iterdir()] == ["replication_00000.parquet"]
    assert json.loads((folder / "summary.json").read_text())["seed"] == 9


@pytest.mark.parametrize(
    "change", [("replications: 3", "replications: 4"), ("warm_up: 10 min", "warm_up: 5 min"), ("cell", "room")]
)
def test_more_replications_another_warm_up_or_name_keep_the_rows(finished, tmp_path, change):
    folder = tmp_path / "copy"
    shutil.copytree(finished, folder)
    before = content(folder)
    run(folder, SHORT.replace(*change))
    after = content(folder)
    assert all(after[path] == rows for path, rows in before.items() if path.suffix == ".parquet" and path.parent.name)


STOOPS = """
opsim: 1
name: cell
run: {start: Mon 06:30, horizon: 3 min, seed: 3, replications: 1}
layout: {places: {here: [0 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
tasks: {stoop: {emulator: bench/stoop, load: 2 kg}}
stations: {low: {at: here, tasks: [stoop], buffer: 2}}
products: {p: {route: [low]}}
release: {kind: saturated}
workers: {ana: {skills: {low: 1.0}}}
outputs: [throughput_per_h, rula_mean]
"""


def stoops(folder, *edits):
    from opsim.scenario.read import scenarios_in

    text = STOOPS
    for edit in edits:
        text = text.replace(*edit)
    read = scenarios_in(text.encode(), shipped_folder() / "made.yaml")["base"]
    done = run_scenario(read, folder=folder, processes=1)
    means = {(row["kpi"], row["subject"], row["part"]): row["mean"] for row in done.summary["kpis"]}
    return means, (folder / "events" / "replication_00000.parquet").read_bytes()


def test_another_load_keeps_the_rows_and_makes_figures_anew_of_them(tmp_path):
    light, rows = stoops(tmp_path)
    (tmp_path / "report.html").write_text("of 2 kg")
    heavy, same = stoops(tmp_path, ("load: 2 kg", "load: 20 kg, handling: {grip: poor}"))
    assert same == rows and not (tmp_path / "report.html").exists()
    assert heavy["rula_mean", "", ""] > light["rula_mean", "", ""]
    assert heavy["throughput_per_h", "", ""] == light["throughput_per_h", "", ""]


def test_another_load_is_another_run_where_people_tire_by_it(tmp_path):
    tire = ("release:", "human: {fatigue: {model: 3cc_r}}\nrelease:")
    stoops(tmp_path, tire)
    with pytest.raises(OtherRun, match=r"tasks\.stoop\.load 2 kg, now 20 kg"):
        stoops(tmp_path, tire, ("load: 2 kg", "load: 20 kg"))


def test_a_folder_of_an_unknown_run_is_refused(tmp_path):
    (tmp_path / "events").mkdir()
    (tmp_path / "events" / "replication_00000.parquet").write_bytes(b"rows")
    with pytest.raises(OtherRun, match="1 replication of a run that is not known"):
        run(tmp_path)


def test_a_folder_without_finished_work_may_be_taken(tmp_path):
    (tmp_path / "manifest.json").write_text("{}")
    assert other_run(tmp_path, loaded(SHORT), 5) is None


def test_other_versions_are_named(finished, tmp_path):
    shutil.copytree(finished, tmp_path / "old")
    manifest = json.loads((finished / "manifest.json").read_text())
    manifest["packages"]["numpy"] = "1.0"
    (tmp_path / "old" / "manifest.json").write_text(json.dumps(manifest))
    assert "numpy 1.0, now" in str(other_run(tmp_path / "old", loaded(SHORT), 5))


OWN = """
opsim: 1
name: Own
run: {horizon: 10 min, replications: 1}
libraries: {mine: own.npz}
layout: {places: {here: [0 m, 0 m]}}
tasks: {squat: {emulator: mine/deep_squat}, wait: {recorded: times.csv}}
stations: {pack: {at: here, tasks: [squat, wait], buffer: 1}}
products: {box: {route: [pack]}}
release: {kind: saturated}
workers: {ana: {skills: {pack: 1.0}}}
"""


def test_the_resolved_scenario_of_a_users_own_library_runs_again_from_the_folder(tmp_path):
    shutil.copy(shipped_folder() / "libraries" / "public_movements.npz", tmp_path / "own.npz")
    (tmp_path / "times.csv").write_text("3\n4\n5\n")
    (tmp_path / "own.yaml").write_text(OWN)
    first = run_scenario(read_scenarios(tmp_path / "own.yaml")["base"], folder=tmp_path / "out", processes=1)
    for name in ("own.yaml", "own.npz", "times.csv"):
        (tmp_path / name).unlink()
    again = read_scenarios(tmp_path / "out" / "scenario.resolved.yaml")["base"]
    second = run_scenario(again, folder=tmp_path / "again", processes=1)
    assert second.summary["kpis"] == first.summary["kpis"]
    assert run_scenario(again, folder=tmp_path / "out", processes=1).summary["kpis"] == first.summary["kpis"]
    assert str(tmp_path) not in (tmp_path / "out" / "manifest.json").read_text()


TEXTS = st.one_of(
    st.text(st.characters(exclude_categories=("Cs", "Cc", "Cf", "Co", "Cn", "Zl", "Zp")), max_size=40),
    st.from_regex(r"\A[-+.0-9eExoOaAnNuUlLtTrR~: ]{0,8}\Z"),
    st.sampled_from(["1e5", "2E1", "0o17", "0x1f", "no", "null", "~", ".inf", "10:30", "+.5", "1.", "-0", "=", "<<"]),
)
HANDS = ("loaded.from", "handling.grip")
VALUES = st.one_of(TEXTS, st.integers(), st.floats(allow_nan=False), st.booleans(), st.none())
KEYS = TEXTS.filter(lambda key: key != "<<")


@pytest.mark.parametrize("text", ["1e5", "2E1", "0o17", "1.", ".5", "no", "yes", "10:30", "2026-01-01", "0x1f", ""])
def test_a_text_that_looks_like_a_number_is_read_back_as_text(text):
    assert read_resolved(resolved_text({"name": text, "libraries": {text: text}})) == {
        "name": text,
        "libraries": {text: text},
    }


@settings(max_examples=80, deadline=None)
@given(st.dictionaries(KEYS, st.one_of(VALUES, st.lists(VALUES, max_size=4), st.dictionaries(KEYS, VALUES))))
def test_whatever_was_resolved_is_read_back_the_same(resolved):
    root, problems = read_tree(resolved_text(resolved).encode(), "scenario.resolved.yaml")
    assert root.plain() == resolved and not problems


def test_what_two_entries_share_is_written_twice():
    shared = {"walk": "1 m/s"}
    assert "&" not in resolved_text({"ana": shared, "ben": shared})


def test_differences_are_named_by_path_and_what_decides_no_row_is_none():
    run = {"horizon": "8 h", "seed": 1}
    before = {"name": "a", "run": run, "outputs": ["x"], "workers": {"ana": {}}}
    now = {"name": "b", "run": {**run, "horizon": "4 h", "warm_up": "1 h", "seed": 2}, "workers": {"ana": {}, "eva": 1}}
    assert differences(before, now) == ["run.horizon 8 h, now 4 h", "workers.eva not there, now 1"]
    assert differences(before, before) == []


BODIES = {
    "ergonomics": {"rate": 12},
    "tasks": {"lift": {"load": "8 kg", "loaded": {"from": "grasp"}, "handling": {"grip": "fair"}}},
}
OTHER_BODIES = {
    "ergonomics": {"rate": 4, "waiting": "upright"},
    "tasks": {"lift": {"load": "9 kg", "loaded": {"from": "start"}, "handling": {"grip": "poor"}}},
}
SCORES, LOADS = {"ergonomics.rate", "ergonomics.waiting"}, {f"tasks.lift.{k}" for k in ("load", *HANDS)}


@pytest.mark.parametrize(
    "asks, decide",
    [
        ({}, set()),
        ({"human": {"fatigue": {"model": "lffrm", "by": "even"}}}, set()),
        ({"human": {"fatigue": {"model": "lffrm"}, "learning": {"model": "wright"}}}, set()),
        ({"allocation": {"rule": "nearest"}, "rotations": {"r": {"rule": "in_turn"}}}, set()),
        ({"human": {"fatigue": {"model": "lffrm", "by": "posture"}}}, LOADS),
        ({"human": {"fatigue": {"model": "3cc_r"}}}, LOADS),
        ({"allocation": {"rule": "least_exposed"}}, SCORES | LOADS),
        ({"rotations": {"r": {"rule": "least_exposed"}}}, SCORES | LOADS),
    ],
)
def test_loads_and_scores_decide_rows_only_where_something_asks_for_them(asks, decide):
    before, now = {**BODIES, **asks}, {**OTHER_BODIES, **asks}
    assert {words.split(" ")[0] for words in differences(before, now)} == decide
    assert set(decides_figures(now)) == (SCORES | LOADS) - decide
    for one in (before, now):
        assert decide.isdisjoint(decides_figures(one))


def test_a_task_that_is_named_like_a_key_is_a_task():
    before, now = ({"tasks": {"load": {"fixed": seconds}, "a.load": {"fixed": "1 s"}}} for seconds in ("1 s", "2 s"))
    assert differences(before, now) == ["tasks.load.fixed 1 s, now 2 s"]


def test_the_file_says_the_seed_and_the_number_that_were_used():
    assert with_run({"run": {"horizon": "8 h", "seed": 1}}, 9, 3)["run"] == {
        "horizon": "8 h",
        "seed": 9,
        "replications": 3,
    }
