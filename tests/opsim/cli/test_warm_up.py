import json

import pytest

from tests.opsim.cli.calls import LINE, line, opsim

TWO = LINE + "overrides: {wide: {stations.press.servers: 2}}\nscenarios: {base: [], wider: [wide]}\n"


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("warm")
    opsim("run", line(folder, TWO), "-o", folder / "out")
    return folder / "out"


def test_each_variant_gets_its_suggestion(results):
    code, shown, _ = opsim("warm-up", results)
    assert code == 0 and "base" in shown and "wider" in shown and "Jobs inside" in shown and "MSER-5" in shown


def test_one_variant_as_json(results):
    code, shown, _ = opsim("warm-up", results / "base", "--json")
    (found,) = json.loads(shown)["variants"]
    assert code == 0 and found["replications"] == 2 and found["own_warm_up_s"] == 0
    assert [of["kpi"] for of in found["series"]] == ["work_in_progress", "throughput_per_h"]


def test_a_picture_is_drawn_for_each_variant(results, tmp_path):
    code, shown, _ = opsim("warm-up", results, "--picture", tmp_path / "warm.svg")
    assert code == 0 and "picture:" in shown
    assert {path.name for path in tmp_path.iterdir()} == {"warm_base.svg", "warm_wider.svg"}
    assert "<svg" in (tmp_path / "warm_base.svg").read_text(encoding="utf-8")


def test_wrong_calls_are_mistakes(results, tmp_path):
    assert opsim("warm-up", tmp_path)[0] == 2
    code, _, complaint = opsim("warm-up", results, "--picture", tmp_path / "warm.pdf")
    assert code == 2 and "a .png or a .svg file" in complaint
