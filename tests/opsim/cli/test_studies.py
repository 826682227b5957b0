"""``opsim labour`` as its user calls it.

``opsim layout`` as its user calls it.

``opsim select``: a small study from its options and from the file, told on one screen; refusals leave no folder.
"""

import json

import numpy as np
import pytest
import yaml
from click.testing import CliRunner

from opsim.cli import main
from opsim.cli.study_options import vary_of
from opsim.scenario.study_checks import Varied
from tests.opsim.cli.calls import LINE as LINE_of_sweep
from tests.opsim.cli.calls import line, opsim
from tests.opsim.study.labour.made import FEWER, LINE
from tests.opsim.study.layout.made_floor import FLOOR, written

FEW = ("--workforces", "2", "--replications", "2", "--processes", "1")


def file_in(folder, text=FEWER):
    path = folder / "line.yaml"
    path.write_text(text)
    return path


def test_one_screen_a_page_and_a_summary(tmp_path):
    out = tmp_path / "out"
    words = ("--target", "20 a day", "--no-budget", "--no-buy-back")
    code, said, err = opsim("labour", file_in(tmp_path), "-o", out, *FEW, *words)
    assert code == 0, err
    assert len(said.splitlines()) <= 45
    assert "Who is hired moves the output" in said or "There is no sign" in said
    assert "You reach 20 a day (a day is " in said and " h here) with a chance of" in said
    summary = json.loads((out / "summary.json").read_text())
    assert summary["budget"] == [] and summary["bought_back"] is None
    assert summary["day"]["chance"]["n"] == 4
    assert "<svg" in (out / "labour.html").read_text()


def test_budget_and_ways_back_are_told_and_names_are_no_markup(tmp_path):
    text = FEWER.replace("name: Three people", "name: <b>Three</b> people")
    out = tmp_path / "out"
    code, said, err = opsim("labour", file_in(tmp_path, text), "-o", out, *FEW, "--add", "ana", "--most-workers", "1")
    assert code == 0, err
    assert len(said.splitlines()) <= 45
    for words in ("between workers", "what they do to each other", "more like ana", "skills more, in a chain"):
        assert words in said
    page = (out / "labour.html").read_text()
    assert "<b>Three" not in page and page.count("<svg") == 4


@pytest.mark.parametrize(("words", "answer"), [
    (("--workforces", "1"), "at least 2 workforces"),
    (("--replications", "1"), "cannot be told apart"),
    (("--target", "throughput_per_hour >= 3"), "did you mean 'throughput_per_h'"),
    (("--target", "lots"), "480 a day"),
    (("--figure", "walkd_m"), "did you mean 'walked_m'"),
    (("--add", "anna"), "did you mean 'ana'"),
])  # fmt: skip
def test_wrong_options_are_answered_before_the_first_run(tmp_path, words, answer):
    out = tmp_path / "out"
    code, _, err = opsim("labour", file_in(tmp_path), "-o", out, *words)
    assert code == 2 and answer in err, err
    assert not (out / "summary.json").exists()


@pytest.mark.parametrize(("text", "answer"), [
    (LINE.replace(", between_share: 0.5", ""), "between_share"),
    (LINE.replace("seed: 5}", "seed: 5, variability: none}"), "switched off already"),
])  # fmt: skip
def test_people_who_do_not_differ_are_refused_with_the_way_out(tmp_path, text, answer):
    code, _, err = opsim("labour", file_in(tmp_path, text), "-o", tmp_path / "out", *FEW)
    assert code == 2 and answer in err


@pytest.fixture
def file(tmp_path):
    return written(tmp_path)


def test_one_screen_says_what_to_move_and_what_to_paste(file, tmp_path):
    out = tmp_path / "out"
    code, screen, wrong = opsim("layout", file, "--replications", 3, "--swap", "saw,pack", "-o", out, "--processes", 1)
    assert code == 0, wrong
    assert "less walking" in screen and len(screen.splitlines()) <= 40
    block = screen[screen.index("overrides:") : screen.index("Flows now")]
    assert set(yaml.safe_load(block)) == {"overrides", "scenarios"}
    page = (out / "layout.html").read_text(encoding="utf-8")
    assert page.count("<svg") == 2 and "What changes" not in page
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert summary["taken"] in {one["name"] for one in summary["layouts"]}
    assert summary["fresh"]["best"]["low"] > 0


@pytest.mark.parametrize(
    "options, words",
    [
        (["--swap", "saw,dril"], "did you mean 'drill'?"),
        (["--fixed", "saw,drill,pack"], "no station may be moved"),
        (["--places", "p1,p2"], "3 stations"),
        (["--place", "saw=p5"], "would stand at one place"),
        (["--proposals", "0"], "no proposals and no change"),
        (["--move", "p1=6, 1 m"], "6 has no unit"),
        (["--exposure", "throughput_per_h"], "of throughput_per_h more is better"),
        (["--shard", "1/2"], "not known beforehand"),
        (["--best", "worker_states/ana/walk"], "less worker_states/ana/walk"),
    ],
)
def test_what_makes_no_sense_is_refused_before_anything_is_written(file, tmp_path, options, words):
    out = tmp_path / "out"
    code, _, wrong = opsim("layout", file, *options, "-o", out)
    assert code == 2 and words in wrong
    assert not out.exists()


def test_options_lie_over_the_block_of_the_file(tmp_path):
    file = written(tmp_path, FLOOR + "studies: {layout: {proposals: 0, replications: 2, swap: ['saw,pack']}}\n")
    code, text, wrong = opsim("layout", file, "-o", tmp_path / "out", "--processes", 1, "--json")
    assert code == 0, wrong
    found = json.loads(text)["summary"]
    assert [one["name"] for one in found["layouts"]] == ["swap saw,pack"] and found["replications"] == 2


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
                    "tasks.cut.mean=50 s..70 s", "--search", "--trials", "6", "--replications", "5",
                    "-o", tmp_path / "found")  # fmt: skip
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
    assert block.subject_to == ["rula_from_5_min_per_h/worst <= 21"] and block.indifference == 2


GRID = (
    LINE_of_sweep.replace("horizon: 20 min", "horizon: 3 h")
    + """
studies:
  sweep:
    vary: {stations.press.buffer: [1, 3], tasks.cut.mean: {from: 15 s, to: 30 s, levels: 3}}
    figures: [throughput_per_h, station_states/saw/work]
    replications: 4
"""
)


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    folder = tmp_path_factory.mktemp("swept")
    file = line(folder, GRID)
    code, shown, _ = opsim("sweep", file, "-o", folder / "out", "--processes", 1)
    assert code == 0
    return file, folder / "out", shown


def test_the_answer_is_said_as_an_engineer_would_on_one_screen(swept):
    _, out, shown = swept
    assert "Throughput (good units) goes up most with tasks.cut.mean: +" in shown and "from 30 s to 15 s" in shown
    assert "of the 6 points" in shown and len(shown.splitlines()) <= 40
    page = (out / "sweep.html").read_text(encoding="utf-8")
    assert page.count("<svg") >= 4 and "<script" not in page


def test_the_difference_is_that_of_the_paired_means(swept):
    summary = json.loads((swept[1] / "summary.json").read_text())
    figure = summary["figures"][0]
    mean = {tuple(point.values()): of["mean"] for point, of in zip(summary["points"], figure["points"])}
    cut = next(factor for factor in figure["factors"] if factor["path"] == "tasks.cut.mean")
    fast, slow = (np.mean([mean[buffer, time] for buffer in (1, 3)]) for time in ("15 s", "30 s"))
    assert cut["difference"]["mean"] == pytest.approx(fast - slow) and cut["clear"]


def test_a_sweep_gone_on_with_and_one_in_shards_are_the_same_bytes(swept, tmp_path):
    file, out, _ = swept
    for shard in ("1/2", "2/2"):
        assert opsim("sweep", file, "-o", tmp_path / "again", "--shard", shard, "--processes", 1)[0] == 0
    assert opsim("sweep", file, "-o", tmp_path / "again", "--processes", 1)[0] == 0
    for name in ("summary.json", "sweep.html", "figures.parquet"):
        assert (out / name).read_bytes() == (tmp_path / "again" / name).read_bytes()


def test_options_replace_what_the_file_asks(swept, tmp_path):
    asked = ("--vary", "tasks.drill.fixed=20 s,25 s", "--vary", "run.variability=full,none", "--replications", 2)
    code, shown, _ = opsim("sweep", swept[0], *asked, "--figure", "less time_in_system_s", "-o", tmp_path, "--json")
    summary = json.loads(shown)["summary"]
    assert code == 0 and len(summary["points"]) == 4 and summary["figures"][0]["best"]["better"] == "less"


def test_one_factor_at_a_time_is_against_the_scenario_as_it_is(swept, tmp_path):
    asked = ("--vary", "tasks.drill.fixed=20 s..25 s", "--vary", "stations.saw.buffer=1..4", "--replications", 2)
    code, shown, _ = opsim("sweep", swept[0], *asked, "--design", "one_at_a_time", "-o", tmp_path, "--json")
    figure = json.loads(shown)["summary"]["figures"][0]
    assert code == 0 and figure["against"] == "base" and len(figure["points"]) == 5
    drill = next(factor for factor in figure["factors"] if factor["path"] == "tasks.drill.fixed")
    assert [level["value"] for level in drill["levels"]] == ["20 s", "25 s"]  # the second is what the scenario has


@pytest.mark.parametrize("design", ["morris", pytest.param("sobol_indices", marks=pytest.mark.slow)])
def test_which_factor_matters_by_salib(swept, tmp_path, design):
    asked = ("--vary", "tasks.drill.fixed=10 s..40 s", "--vary", "stations.saw.buffer=1..4", "--replications", 1)
    code, shown, _ = opsim("sweep", swept[0], *asked, "--design", design, "--points", 4, "-o", tmp_path, "--json")
    found = {one["path"]: one["total"] for one in json.loads(shown)["summary"]["figures"][0]["sensitivity"]}
    assert code == 0 and found["tasks.drill.fixed"] > found["stations.saw.buffer"]


@pytest.mark.parametrize(
    "words, said",
    [
        (["--vary", "stations.prss.buffer=1,2"], "did you mean stations.press.buffer?"),
        (["--vary", "tasks.cut.mean=-15 s,30 s"], "must be more than 0 s"),
        (["--vary", "tasks.cut.mean=15 s..1 min"], "need the same unit"),
        (["--vary", "tasks.cut.mean=30 s..15 s"], "the wrong way round"),
        (["--vary", "tasks.cut.mean"], "expected a path, '=' and values"),
        (
            ["--vary", "tasks.cut.mean=15 s..30 s", "--design", "grid"],
            "how many values the range of tasks.cut.mean has",
        ),
        (["--figure", "throughput"], "did you mean 'throughput_per_h'?"),
        (["--figure", "station_states/press2"], "did you mean 'press'?"),
        (["--figure", "station_states"], "it is of each station: say which, such as station_states/saw"),
    ],
)
def test_mistakes_are_answered_before_anything_is_run(swept, tmp_path, words, said):
    code, shown, wrong = opsim("sweep", swept[0], *words, "-o", tmp_path / "none")
    assert (code, shown) == (2, "") and said in wrong and not (tmp_path / "none").exists()


def test_all_mistakes_of_factors_are_said_at_once(swept, tmp_path):
    words = ("--vary", "stations.prss.buffer=1,2", "--vary", "tasks.cut.mean=-15 s,0 s")
    code, _, wrong = opsim("sweep", swept[0], *words, "-o", tmp_path / "none")
    assert code == 2 and wrong.count("tasks.cut.mean: must be") == 2 and "stations.press.buffer" in wrong


def test_a_file_that_asks_nothing_says_how_to_ask(tmp_path):
    code, _, wrong = opsim("sweep", line(tmp_path), "-o", tmp_path / "none")
    assert code == 2 and "nothing says what is varied" in wrong


@pytest.mark.slow
def test_the_sweep_of_a_shipped_scenario_runs(tmp_path):
    code, shown, _ = opsim("sweep", "serial_line", "--horizon", "6 h", "--replications", 2, "-o", tmp_path, "--json")
    summary = json.loads(shown)["summary"]
    assert code == 0 and len(summary["points"]) == 12 and summary["figures"][1]["kpi"] == "time_in_system_s"
    assert summary["figures"][0]["response"]["r2_predicted"] > 0.9


@pytest.mark.parametrize(
    "text, found",
    [
        ("a.b=1,2,4", [1, 2, 4]),
        ("a.b=full,none", ["full", "none"]),
        ("a.b=[6 m, 1 m],[9 m, 1 m]", [["6 m", "1 m"], ["9 m", "1 m"]]),
        ("a.b= 40 s .. 60 s", {"from": "40 s", "to": "60 s"}),
        ("a.b=0.5..1.5", {"from": 0.5, "to": 1.5}),
        ("a.b=[0 m, 0 m]..[4 m, 0 m]", {"from": ["0 m", "0 m"], "to": ["4 m", "0 m"]}),
    ],
)
def test_values_are_read_as_a_file_would_have_them(text, found):
    assert vary_of([text]) == {"a.b": found}


def test_mistakes_of_options_are_said_together():
    with pytest.raises(ValueError) as error:
        vary_of(["a.b", "a.b=1..2..3", "a.c=[1", "a.d=1", "a.d=2"])
    assert len(str(error.value).splitlines()) == 4
