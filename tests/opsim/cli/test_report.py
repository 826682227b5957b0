"""``opsim report``: the same page again from what lies in a run's folder, and its figures as files."""

import json
import shutil
import sys

import pytest

from opsim.report import render as contents
from tests.opsim.cli.calls import opsim
from tests.opsim.cli.test_view import cell


def without_matplotlib(patch):
    """No module of it can be imported."""
    for name in {"matplotlib", *(name for name in sys.modules if name.startswith("matplotlib."))}:
        patch.setitem(sys.modules, name, None)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Results of both variants, which no test changes, made without matplotlib."""
    folder = tmp_path_factory.mktemp("report")
    with pytest.MonkeyPatch.context() as patch:
        without_matplotlib(patch)
        code, _, complaint = opsim("run", cell(folder), "-o", folder / "out", "--processes", 1)
    assert code == 0 and "could not be made" not in complaint, complaint
    return folder / "out"


@pytest.fixture
def results(run, tmp_path):
    """The same in a folder of one's own."""
    return shutil.copytree(run, tmp_path / "out")


def pages(folder):
    return {path.parent.name: path.read_bytes() for path in folder.glob("*/report.html")}


def test_the_report_made_again_is_the_one_the_run_made(results):
    made = pages(results)
    for path in results.glob("*/report.html"):
        path.unlink()
    code, shown, complaint = opsim("report", results)
    assert code == 0 and complaint == "" and f"report together: {results / 'together' / 'report.html'}" in shown
    assert pages(results) == made and len(made) == 2


def test_the_report_of_a_variants_own_folder_knows_what_stands_beside_it(results):
    made = pages(results)["alone"]
    (results / "alone" / "report.html").unlink()
    code, *_ = opsim("report", results / "alone")
    assert code == 0 and pages(results)["alone"] == made


def test_one_variant_goes_into_the_file_that_is_asked_for(results, tmp_path):
    code, shown, _ = opsim("report", results, "--scenario", "alone", "-o", tmp_path / "deep" / "mine.html", "--json")
    assert code == 0 and (tmp_path / "deep" / "mine.html").read_bytes() == pages(results)["alone"]
    assert json.loads(shown) == {"reports": [{"variant": "alone", "report": str(tmp_path / "deep" / "mine.html")}]}


def test_every_figure_of_the_report_becomes_an_svg_file(results, tmp_path):
    pytest.importorskip("matplotlib")
    code, shown, _ = opsim("report", results, "--scenario", "alone", "--svg", tmp_path / "svg", "--json")
    assert code == 0 and len(json.loads(shown)["reports"][0]["figures"]) > 5
    assert {"worker_states.svg", "movements-1.svg"} <= {path.name for path in (tmp_path / "svg").iterdir()}


def test_figures_of_several_variants_have_a_folder_each(results, tmp_path, monkeypatch):
    monkeypatch.setattr("opsim.report.plot.matplotlib_chart.chart_svg", lambda chart, legend=(): b"<svg/>")
    code, shown, _ = opsim("report", results, "--svg", tmp_path / "svg")
    assert code == 0 and f"files in {tmp_path / 'svg' / 'together'}" in shown
    assert {path.name for path in (tmp_path / "svg").iterdir()} == {"alone", "together"}


def test_without_matplotlib_it_is_said_how_to_get_it_before_anything_is_written(results, tmp_path, monkeypatch):
    monkeypatch.setattr("opsim.report.page.find_spec", lambda name: None)
    code, _, complaint = opsim("report", results, "--svg", tmp_path / "svg")
    assert code == 2 and "pip install opsim[matplotlib]" in complaint and not (tmp_path / "svg").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--scenario", "alonne", "--scenario", "x"), "no variant 'alonne'; did you mean 'alone'?"),
        (("-o", "one.html"), "is for one report, and there are 2: alone, together; --scenario says which"),
    ],
)
def test_mistakes_are_said_in_words(results, words, said):
    code, _, complaint = opsim("report", results, *words)
    assert code == 2 and said in complaint


@pytest.mark.parametrize(
    ("out", "said"),
    [
        ("alone/kpis.parquet", "found the ending '.parquet', expected .html"),
        ("alone/summary.json", "found the ending '.json', expected .html"),
        ("alone/scenario.resolved.yaml", "found the ending '.yaml', expected .html"),
        ("events.html", "found the result that is read, expected another file to write"),
        ("folder.html", "found a folder, expected the name of a file"),
    ],
)
def test_a_report_is_not_written_over_the_results(results, out, said):
    (results / "folder.html").mkdir()
    (results / "events.html").symlink_to(results / "together" / "events" / "replication_00001.parquet")
    before = {path: path.read_bytes() for path in results.rglob("*") if path.is_file()}
    code, _, complaint = opsim("report", results, "--scenario", "alone", "-o", results / out)
    assert code == 2 and f"{results / out}: {said}" in complaint
    assert {path: path.read_bytes() for path in results.rglob("*") if path.is_file()} == before


def test_figures_are_not_written_into_a_file(results, tmp_path):
    (tmp_path / "svg").write_text("mine")
    for names in (("--scenario", "alone"), ()):
        code, _, complaint = opsim("report", results, *names, "--svg", tmp_path / "svg")
        assert code == 2 and f"{tmp_path / 'svg'}: found a file, expected a folder to write into" in complaint
    assert (tmp_path / "svg").read_text() == "mine"


def test_a_replication_that_is_gone_is_not_passed_over(results):
    (results / "alone" / "events" / "replication_00000.parquet").unlink()
    code, _, complaint = opsim("report", results, "--scenario", "alone")
    assert code == 2 and "found no rows of replication 0, expected 0 to 1; run it again" in complaint


def test_a_broken_manifest_is_named(results):
    (results / "alone" / "manifest.json").write_text("{\n")
    for verb in ("report", "view"):
        code, _, complaint = opsim(verb, results, "--scenario", "alone")
        assert code == 2 and f"{results / 'alone' / 'manifest.json'}: found no JSON" in complaint


def test_what_is_no_run_is_said_to_be_none(tmp_path):
    code, _, complaint = opsim("report", tmp_path)
    assert code == 2 and "no results here" in complaint


def test_another_library_than_that_of_the_run_is_refused(results):
    library = results / "alone" / "bench_work.npz"
    library.write_bytes(library.read_bytes() + b"\0")
    code, _, complaint = opsim("report", results, "--scenario", "alone")
    assert code == 2 and "the library bench has changed since it was run" in complaint


def test_a_section_that_cannot_be_made_is_a_warning_and_the_report_is_there(results, monkeypatch):
    from opsim.report.sections import gantt

    def broken(material):
        raise ValueError("no clock here")

    monkeypatch.setattr(gantt, "gantt_section", broken)
    code, _, complaint = opsim("report", results, "--scenario", "alone")
    assert code == 0
    assert complaint == "warning: alone: the report lacks gantt, which could not be made: no clock here\n"
    assert b"This report lacks gantt" in pages(results)["alone"]


def test_every_section_of_the_contents_can_be_imported_and_is_named_once():
    names = [name for of in contents.PARTS.values() for name in of]
    assert len(names) == len(set(names))


def test_a_run_and_its_report_need_no_matplotlib(run, monkeypatch):
    assert b"Movements behind the times" in pages(run)["alone"]
    without_matplotlib(monkeypatch)
    with pytest.raises(ImportError):
        import matplotlib.figure  # noqa: F401
