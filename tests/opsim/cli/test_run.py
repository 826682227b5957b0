import json

import pytest

from opsim.cli import run as run_module
from tests.opsim.cli.calls import LINE, line, opsim

TWO = LINE + "overrides: {wide: {stations.press.servers: 2}}\nscenarios: {base: [], wider: [wide]}\n"


def test_run_prints_a_column_a_variant_and_where_the_reports_are(tmp_path):
    code, shown, progress = opsim("run", line(tmp_path, TWO), "-o", tmp_path / "out")
    assert code == 0
    assert "base" in shown and "wider" in shown and "Throughput" in shown and "±" in shown
    assert f"report wider: {tmp_path / 'out' / 'wider' / 'report.html'}" in shown
    assert "run base: 2 of 2" in progress
    assert (tmp_path / "out" / "base" / "report.html").stat().st_size > 1e6


def test_run_as_json_is_json(tmp_path):
    code, shown, _ = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--json")
    (result,) = json.loads(shown)["results"]
    assert code == 0
    assert result["summary"]["replications"] == 2 and result["report"].endswith("report.html")


def test_only_the_named_variant_is_run(tmp_path):
    opsim("run", line(tmp_path, TWO), "-o", tmp_path / "out", "--scenario", "wider")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["wider"]


def test_replications_seed_and_horizon_of_the_call_replace_those_of_the_file(tmp_path):
    words = ("--replications", 1, "--seed", 9, "--horizon", "10 min", "--json")
    _, shown, _ = opsim("run", line(tmp_path), "-o", tmp_path / "out", *words)
    summary = json.loads(shown)["results"][0]["summary"]
    assert (summary["replications"], summary["seed"], summary["window_s"]) == (1, 9, [0, 600])
    assert "10 min" in (tmp_path / "out" / "base" / "scenario.resolved.yaml").read_text()


def test_the_default_folder_carries_the_name_of_the_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    opsim("run", line(tmp_path), "--replications", 1)
    assert (tmp_path / "results" / "line" / "base" / "summary.json").is_file()


@pytest.mark.parametrize("horizon, said", [("10", "unit"), ("8 hours", "h"), ("-5 min", "horizon"), ("x", "time")])
def test_a_wrong_horizon_is_a_mistake(tmp_path, horizon, said):
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--horizon", horizon)
    assert code == 2 and said in complaint


def test_a_folder_that_cannot_be_written_is_a_mistake(tmp_path):
    (tmp_path / "out").write_text("a file, not a folder")
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out")
    assert code == 2 and "out" in complaint


def test_control_c_leaves_with_130_and_says_what_is_kept(tmp_path, monkeypatch):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("opsim.study.run_scenario", stopped)
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out")
    assert code == 130 and "finished replications are kept in" in complaint


def test_a_bug_of_ours_is_not_dressed_up_as_a_mistake(tmp_path, monkeypatch):
    def broken(*_, **__):
        raise ValueError("a bug")

    monkeypatch.setattr("opsim.study.run_scenario", broken)
    with pytest.raises(AssertionError, match="a bug"):
        opsim("run", line(tmp_path), "-o", tmp_path / "out")


def test_repeated_names_of_a_figure_are_left_out():
    rows = [("A", "x"), ("A", "y"), ("B", "x")]
    assert run_module._without_repeats(rows) == [("A", "x"), ("", "y"), ("B", "x")]


def test_emulated_tasks_come_with_their_strips(tmp_path):
    words = ("--scenario", "base", "--replications", 1, "--horizon", "40 min", "-o", tmp_path / "out")
    code, _, _ = opsim("run", "repack_cell", *words)
    report = (tmp_path / "out" / "base" / "report.html").read_text(encoding="utf-8")
    assert code == 0 and report.count("data:image/svg+xml;base64,") == 3
