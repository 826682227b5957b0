import pytest

from opsim.problems import ScenarioError
from opsim.shipped import find_scenario, shipped_folder, shipped_scenarios


def test_a_file_that_exists_is_itself(tmp_path):
    file = tmp_path / "queue.yaml"
    file.write_text("opsim: 1\n")
    assert find_scenario(file) == file


def test_a_shipped_scenario_is_found_by_its_name(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("opsim.shipped.shipped_folder", lambda: tmp_path / "shipped")
    (tmp_path / "shipped").mkdir()
    (tmp_path / "shipped/queue.yaml").write_text("opsim: 1\n")
    assert shipped_scenarios() == ["queue"]
    for name in ("queue", "queue.yaml", "scenarios/queue.yaml"):
        assert find_scenario(name) == tmp_path / "shipped/queue.yaml"
    with pytest.raises(ScenarioError, match=r"did you mean 'queue\.yaml'"):
        find_scenario("queu.yaml")
    (tmp_path / "low.yaml").touch()
    with pytest.raises(ScenarioError, match=r"here are low\.yaml; 'opsim init --list' shows those that come with"):
        find_scenario("nope.yaml")  # only its ending is like that of the others
    with pytest.raises(ScenarioError, match="no such file"):
        find_scenario("other/queue.yaml")
    with pytest.raises(ScenarioError, match="no such file"):
        find_scenario("a\0b")


def test_the_shipped_folder_is_there():
    assert shipped_folder().is_dir()
