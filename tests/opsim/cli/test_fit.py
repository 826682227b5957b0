import json
import shutil

import numpy as np
import pytest

from opsim.tasks import Erlang, Lognormal
from tests.opsim.cli.calls import LINE, line, opsim


@pytest.fixture
def times(tmp_path):
    """Recorded times of twelve workers who differ."""
    model, rng = Lognormal(20.0, 0.4, 0.5), np.random.default_rng(4)
    rows = [f"w{w},{x:.3f}" for w in range(12) for x in model.sample(30, rng, worker=model.draw_worker(rng)).duration_s]
    (tmp_path / "times.csv").write_text("\n".join(["who,seconds", *rows]) + "\n")
    return tmp_path / "times.csv"


def test_the_line_that_is_printed_is_a_task_of_a_scenario(tmp_path, times):
    code, shown, _ = opsim("fit", times, "--column", "seconds", "--worker", "who")
    said = shown.splitlines()[-1].removeprefix("in a scenario: ")
    assert code == 0 and "lognormal" in shown and "between_share: 0." in said
    path = line(tmp_path, LINE.replace("{fixed: 25 s, automatic: true}", said.replace("}", ", automatic: true}")))
    assert opsim("check", path)[0] == 0


def test_as_json_it_says_the_same(times):
    found = json.loads(opsim("fit", times, "--column", "seconds", "--worker", "who", "--json")[1])
    assert found["n"] == 360 and 0.2 < found["between_share"] < 0.8
    assert found["families"][0]["aic"] == min(one["aic"] for one in found["families"])
    assert found["said"].startswith(found["families"][0]["said"])


def test_times_of_no_family_are_taken_as_they_are(tmp_path):
    rng = np.random.default_rng(0)
    seen = np.r_[Erlang(10.0, 99).sample(100, rng).duration_s, Erlang(30.0, 99).sample(100, rng).duration_s]
    (tmp_path / "two.csv").write_text("\n".join(f"{x:.3f}" for x in seen))
    _, shown, _ = opsim("fit", tmp_path / "two.csv")
    assert "no family fits well" in shown and "follow each other are alike" in shown
    assert shown.endswith("in a scenario: {recorded: two.csv, by: smooth}\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "'times.csv' has 2 columns; add '--column' with one of: who, seconds"),
        (("--column", "secnds"), "no column 'secnds' in 'times.csv'; did you mean 'seconds'?"),
        (("--column", "seconds", "--worker", "whom"), "no column 'whom' in 'times.csv'; did you mean 'who'?"),
    ],
)
def test_a_wrong_call_is_answered_with_what_is_right(times, words, said):
    assert opsim("fit", times, *words)[::2] == (2, f"{said}\n")


def test_a_file_that_is_not_there_is_a_mistake(tmp_path):
    code, _, complaint = opsim("fit", tmp_path / "no.csv")
    assert code == 2 and "no.csv" in complaint


def test_the_column_beside_that_of_the_workers_need_not_be_named(tmp_path):
    rng = np.random.default_rng(3)
    rows = [f"w{i % 4},{value:.3f}" for i, value in enumerate(rng.lognormal(3, 0.3, 60))]
    (tmp_path / "t.csv").write_text("\n".join(["who,seconds", *rows]) + "\n")
    code, shown, _ = opsim("fit", tmp_path / "t.csv", "--worker", "who")
    assert code == 0
    assert "of the variance of log time lies between workers" in shown


def test_times_and_workers_are_not_one_column(tmp_path):
    (tmp_path / "t.csv").write_text("who,seconds\na,1\nb,2\n")
    code, _, error = opsim("fit", tmp_path / "t.csv", "--worker", "who", "--column", "who")
    assert code == 2
    assert "two columns" in error


def test_two_heaps_of_times_fit_no_family(tmp_path):
    rng = np.random.default_rng(2)
    times = np.where(np.arange(100) % 2, rng.normal(5, 0.5, 100), rng.normal(50, 2, 100))
    (tmp_path / "t.csv").write_text("t\n" + "\n".join(f"{value:.3f}" for value in times) + "\n")
    assert "by: smooth" in opsim("fit", tmp_path / "t.csv")[1]


TWO = LINE + "overrides: {wide: {stations.press.servers: 2}}\nscenarios: {base: [], wider: [wide]}\n"


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("long")
    code, shown, _ = opsim("long-run", line(folder, TWO), "--horizon", "6 h", "-o", folder / "out")
    assert code == 0 and "1 replication of 6 h" in shown
    return folder / "out"


def test_a_file_is_run_once_and_told_on_one_screen_and_as_a_page(results):
    code, shown, _ = opsim("long-run", results)
    assert code == 0 and len(shown.splitlines()) <= 30
    assert "Jobs finished: 138" in shown and "batches of" in shown and "Figures of the steady state" in shown
    assert [path.name for path in results.iterdir()] == ["base"]
    page = (results / "base" / "long_run.html").read_text(encoding="utf-8")
    assert page.count("<svg") >= 12 and "<script" not in page and "Welch" in page


def test_it_is_the_same_for_machines_and_the_same_bytes_again(results):
    first = (results / "base" / "long_run.json").read_bytes()
    code, shown, _ = opsim("long-run", results / "base", "--json")
    found = json.loads(shown)
    assert code == 0 and (results / "base" / "long_run.json").read_bytes() == first
    series = {one["kpi"]: one for one in found["series"]}
    rows = json.loads((results / "base" / "summary.json").read_text())["kpis"]
    own = next(row["mean"] for row in rows if row["kpi"] == "throughput_per_h")
    assert series["throughput_per_h"]["mean"] == pytest.approx(own, rel=0.01)
    assert found["study"] == "long_run" and isinstance(found["believable"], bool)


def test_another_variant_another_warm_up_and_replications(tmp_path):
    words = ("--scenario", "wider", "--horizon", "1 h", "--replications", 2, "--warm-up", "10 min")
    code, shown, _ = opsim("long-run", line(tmp_path, TWO), *words, "-o", tmp_path / "out")
    assert code == 0 and "wider: long run" in shown and "2 replications of 60 min" in shown
    assert "leaving out the first 10 min (as asked)" in shown


@pytest.mark.parametrize(
    "words, said",
    [
        (["--warm-up", "10"], "--warm-up: "),
        (["--warm-up", "-1 s"], "--warm-up: "),
        (["--warm-up", "6 h"], "nothing is left"),
        (["--scenario", "wide"], "no variant 'wide'"),
        (["--horizon", "3 h"], "--horizon: only where a scenario FILE is run"),
    ],
)
def test_a_wrong_call_is_answered_with_what_is_right_of_long_run(results, words, said):
    code, shown, complaint = opsim("long-run", results, *words)
    assert code == 2 and said in complaint and not shown


def test_wrong_files_folders_and_variants_are_mistakes(tmp_path):
    assert opsim("long-run", tmp_path)[0] == 2 and opsim("long-run", tmp_path / "nothing.yaml")[0] == 2
    code, _, complaint = opsim("long-run", line(tmp_path, TWO), "--scenario", "wide", "-o", tmp_path / "out")
    assert code == 2 and "did you mean 'wider'" in complaint and not (tmp_path / "out").exists()


def test_a_run_in_which_hardly_anything_finishes_says_so(tmp_path):
    code, shown, _ = opsim("long-run", line(tmp_path), "--horizon", "3 min", "-o", tmp_path / "out")
    assert (code == 0 and "make the run longer" in shown) or "Not believable" in shown


def test_where_no_page_can_be_written_it_is_told_all_the_same(results, monkeypatch):
    def refuse(path, _):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("opsim.report.page.write_text", refuse)
    code, shown, complaint = opsim("long-run", results)
    assert code == 1 and "Jobs finished" in shown and "cannot be written: Permission denied" in complaint


def test_the_folder_of_a_study_is_answered_with_a_clear_word(results, tmp_path):
    (tmp_path / "summary.json").write_text(json.dumps({"study": "sweep", "scenario": "Line", "seed": 1}))
    (tmp_path / "sweep.html").write_text("")
    for verb in ("compare", "warm-up", "long-run"):
        code, _, complaint = opsim(verb, tmp_path)
        assert code == 2 and "a folder of 'opsim sweep', which keeps figures and no runs" in complaint
        assert "sweep.html" in complaint
    (tmp_path / "summary.json").unlink()
    (tmp_path / "study.json").write_text("{}")
    assert "a folder of a study" in opsim("compare", tmp_path)[2]


def test_rows_that_are_gone_or_damaged_are_named(results, tmp_path):
    shutil.copytree(results / "base", tmp_path / "base")
    (events,) = (tmp_path / "base" / "events").glob("*.parquet")
    events.write_bytes(b"PAR1")
    code, _, complaint = opsim("long-run", tmp_path / "base")
    assert code == 2 and events.name in complaint
    events.unlink()
    assert "no events here" in opsim("long-run", tmp_path / "base")[2]
