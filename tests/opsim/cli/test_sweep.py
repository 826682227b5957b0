import json

import numpy as np
import pytest

from opsim.cli.study_options import vary_of
from tests.opsim.cli.calls import LINE, line, opsim

GRID = (
    LINE.replace("horizon: 20 min", "horizon: 3 h")
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


def test_which_factor_matters_by_salib(swept, tmp_path):
    asked = ("--vary", "tasks.drill.fixed=10 s..40 s", "--vary", "stations.saw.buffer=1..4", "--replications", 1)
    for design in ("morris", "sobol_indices"):
        code, shown, _ = opsim(
            "sweep", swept[0], *asked, "--design", design, "--points", 4, "-o", tmp_path / design, "--json"
        )
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
