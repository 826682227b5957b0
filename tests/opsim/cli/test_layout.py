"""``opsim layout`` as its user calls it."""

import json

import pytest
import yaml

from tests.opsim.cli.calls import opsim
from tests.opsim.study.layout.made_floor import FLOOR, written


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
