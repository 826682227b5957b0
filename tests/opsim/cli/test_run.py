import json

import pytest

from opsim.cli.run import without_repeats
from opsim.engine.endless import EndlessInstant
from opsim.laws import BrokenLog
from opsim.pool import ProcessLost
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


def test_a_folder_of_another_run_is_refused_before_anything_is_run(tmp_path):
    words = ("run", line(tmp_path, TWO), "-o", tmp_path / "out", "--replications", 1)
    opsim(*words)
    code, _, complaint = opsim(*words, "--seed", 8)
    assert code == 2 and "base holds 1 replication" in complaint and "wider holds 1 replication" in complaint
    assert "seed 3, now 8" in complaint and "--overwrite" in complaint
    assert opsim(*words)[0] == 0
    assert opsim(*words, "--seed", 8, "--overwrite")[0] == 0


@pytest.mark.parametrize(
    "error, said",
    [
        (BrokenLog("replication 1: job 3 is gone twice"), "mistake in opsim"),
        (EndlessInstant("t = 0 s: over 10000 rounds"), "does not move on in time"),
        (ProcessLost("a process was killed (out of memory?)"), "try --processes 1"),
        (MemoryError(), "out of memory"),
    ],
)
def test_what_is_nobodys_mistake_in_the_file_is_said_in_words_with_exit_code_1(tmp_path, monkeypatch, error, said):
    def fails(*_, **__):
        raise error

    monkeypatch.setattr("opsim.study.run_scenario", fails)
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out")
    assert code == 1 and said in complaint and "finished replications are kept in" in complaint


def test_a_wanted_precision_decides_the_number_of_replications(tmp_path):
    words = ("run", line(tmp_path), "-o", tmp_path / "out", "--precision", "throughput_per_h=5%")
    code, shown, _ = opsim(*words)
    assert code == 0 and "throughput_per_h is known within" in shown and "wanted: 5 %" in shown
    code, shown, _ = opsim(*words, "--replications", 2)
    assert code == 0 and "after 2 replications" in shown and "not reached" in shown


@pytest.mark.parametrize(
    "wanted, said", [("throughput=1%", "throughput_per_h"), ("throughput_per_h/x=1%", "no figure"), ("x", "PER CENT")]
)
def test_a_wrong_precision_is_a_mistake(tmp_path, wanted, said):
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--precision", wanted)
    assert code == 2 and said in complaint


def test_a_bug_of_ours_is_not_dressed_up_as_a_mistake(tmp_path, monkeypatch):
    def broken(*_, **__):
        raise ValueError("a bug")

    monkeypatch.setattr("opsim.study.run_scenario", broken)
    with pytest.raises(AssertionError, match="a bug"):
        opsim("run", line(tmp_path), "-o", tmp_path / "out")


def test_repeated_names_of_a_figure_are_left_out():
    rows = [("A", "x"), ("A", "y"), ("B", "x")]
    assert without_repeats(rows) == [("A", "x"), ("", "y"), ("B", "x")]


def test_emulated_tasks_come_with_their_strips(tmp_path):
    words = ("--scenario", "base", "--replications", 1, "--horizon", "40 min", "-o", tmp_path / "out")
    code, _, _ = opsim("run", "repack_cell", *words)
    report = (tmp_path / "out" / "base" / "report.html").read_text(encoding="utf-8")
    strips = report.split("Movements behind the times")[-1].count("data:image/svg+xml;base64,")
    assert code == 0 and strips == 3
