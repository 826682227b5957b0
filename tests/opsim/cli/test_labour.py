"""``opsim labour`` as its user calls it."""

import json

import pytest

from tests.opsim.cli.calls import opsim
from tests.opsim.study.labour.made import FEWER, LINE

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
