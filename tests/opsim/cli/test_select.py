"""``opsim select``: a small study from its options and from the file, told on one screen; refusals leave no folder."""

import json

import pytest
from click.testing import CliRunner

from opsim.cli import main
from opsim.scenario.study_checks import Varied

SHORT = ["--horizon", "3 h", "--processes", "1", "--replications", "8", "--indifference", "2"]


def called(*words):
    return CliRunner().invoke(main, ["select", *map(str, words)])


@pytest.fixture(scope="module")
def once(tmp_path_factory):
    out = tmp_path_factory.mktemp("select") / "line"
    return called("serial_line", *SHORT, "-o", out), out


def test_the_best_is_told_on_one_screen_and_written(once):
    result, out = once
    assert result.exit_code == 0, result.output
    assert (
        "confidence 'buffers_of_five' is the best of 3, or (by experience, not proof) within 2 per hour"
        in result.output
    )
    assert len(result.stdout.splitlines()) <= 35
    assert {"select.html", "summary.json", "figures.parquet", "study.json"} <= {path.name for path in out.iterdir()}
    summary = json.loads((out / "summary.json").read_text())
    assert summary["winner"] == "buffers_of_five" and summary["fresh"]["replications"] == 8


def test_the_same_command_goes_on_from_what_is_there_and_says_the_same(once):
    _, out = once
    before = (out / "summary.json").read_bytes(), (out / "select.html").read_bytes()
    again = called("serial_line", *SHORT, "-o", out, "--json")
    assert json.loads(again.stdout)["summary"]["winner"] == "buffers_of_five"
    assert ((out / "summary.json").read_bytes(), (out / "select.html").read_bytes()) == before


def test_a_search_is_run_from_the_options(tmp_path):
    result = called("serial_line", *SHORT, "--vary", "stations.drilling.buffer=0..6", "--vary",
                    "tasks.cut.mean=50 s..70 s", "--search", "--trials", "6", "-o", tmp_path / "found")  # fmt: skip
    assert result.exit_code == 0, result.output
    assert "The search tried 6 points on 3 replications each; the best 5 went on" in result.output


@pytest.mark.parametrize(("words", "said"), [
    (["queue", "--indifference", "1"], "only 'base' is there: nothing to choose from"),
    (["serial_line", "--indifference", "0"], "expected more than 0, found"),
    (["serial_line", "--indifference", "2 s"], "throughput_per_h is per hour: write 2"),
    (["serial_line", "--indifference", "1", "--confidence", "0.2"], "33.3 %, which a guess among 3 has"),
    (["serial_line", "--indifference", "1", "--most", "4"], "4 is not in the range x>=5"),
    (["serial_line", "--indifference", "1", "--search"], "a search needs to know what it may vary"),
    (["serial_line", "--indifference", "1", "--shard", "1/2"], "depends on the answers so far"),
    (["serial_line", "--indifference", "1", "--among", "base,bufers_of_two"], "did you mean 'buffers_of_two'"),
    (["serial_line", "--indifference", "1", "--subject-to", "walked <= 3"], "did you mean 'walked_m'"),
])  # fmt: skip
def test_a_wrong_question_is_refused_and_leaves_no_folder(words, said, tmp_path):
    result = called(*words, "-o", tmp_path / "none")
    assert (result.exit_code, (tmp_path / "none").exists()) == (2, False)
    assert said in result.output and "Traceback" not in result.output


def test_shelf_heights_asks_for_the_most_output_that_backs_can_bear():
    """What comes of it, in a run of half a minute: longer_break, the only one of five that keeps the limit."""
    block = Varied.read("shelf_heights").with_changes({}).scenario.studies.select
    assert block.subject_to == ["rula_from_5_min_per_h/worst <= 20"] and block.indifference == 2
