import json

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
        ((), "'times.csv' has 2 columns; add 'column:' with one of: who, seconds"),
        (("--column", "secnds"), "no column 'secnds' in 'times.csv'; did you mean 'seconds'?"),
        (("--column", "seconds", "--worker", "whom"), "no column 'whom' in 'times.csv'; did you mean 'who'?"),
        (("--column", "who"), "'times.csv' line 2: 'w0' is not a positive number of seconds"),
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
