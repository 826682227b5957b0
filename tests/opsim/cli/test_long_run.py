import json
import shutil

import pytest

from tests.opsim.cli.calls import LINE, line, opsim

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
def test_a_wrong_call_is_answered_with_what_is_right(results, words, said):
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
