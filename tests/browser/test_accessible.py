"""No serious fault by axe-core in pages that README.md and docs do not make (tests/test_readme.py looks at those)."""

import pytest

from opsim.shipped import shipped_folder
from tests.browser.axe import serious
from tests.browser.chromium import Watched, browser
from tests.opsim.cli.calls import opsim

pytestmark = pytest.mark.browser
BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def chromium():
    with browser() as running:
        yield running


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """What bodies go through in two variants, people who move, and a movement alone."""
    folder = tmp_path_factory.mktemp("pages")
    words = ("--horizon", "1 h", "--replications", 2, "--scenario", "in_turn", "--scenario", "least_exposed")
    assert opsim("run", "least_exposed", "-o", folder / "out", *words)[0] == 0
    assert opsim("view", folder / "out", "-o", folder / "replay.html", "--to", "10 min")[0] == 0
    assert opsim("motion", "show", BENCH, "reach", "--video", "-o", folder / "moving.html")[0] == 0
    return folder


def test_a_fault_is_found(tmp_path, chromium):
    path = tmp_path / "bad.html"
    path.write_text(
        "<html lang='en' data-drawn><title>t</title><main><h1>x</h1><img src='data:,'><button></button></main>"
    )
    assert {one.split(":")[0] for one in serious(Watched(chromium, path).page)} == {
        "critical image-alt",
        "critical button-name",
    }


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("name", ["out/in_turn/report.html", "replay.html", "moving.html"])
def test_a_page_has_no_serious_fault(pages, chromium, name, width):
    assert serious(Watched(chromium, pages / name, width).page) == []
