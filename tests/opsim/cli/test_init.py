import json

import pytest

from opsim.scenario.json_schema import schema_text
from opsim.shipped import shipped_scenarios
from tests.opsim.cli.calls import opsim


@pytest.mark.parametrize("template", shipped_scenarios())
def test_what_init_writes_is_right(tmp_path, monkeypatch, template):
    monkeypatch.chdir(tmp_path)
    code, shown, _ = opsim("init", template)
    assert code == 0 and f"next: opsim check {template}.yaml" in shown
    assert opsim("check", f"{template}.yaml")[0] == 0


def test_the_schema_lies_beside_it_and_is_named_in_the_first_line(tmp_path):
    opsim("init", "queue", "-o", tmp_path / "mine" / "first.yaml")
    first, second, *_ = (tmp_path / "mine" / "first.yaml").read_text(encoding="utf-8").splitlines()
    assert first == "# yaml-language-server: $schema=./opsim.schema.json"
    assert second.startswith("# The oldest known answer")
    assert (tmp_path / "mine" / "opsim.schema.json").read_text(encoding="utf-8") == schema_text()


def test_without_a_template_it_is_a_short_commented_one(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert json.loads(opsim("init", "--json")[1]) == {
        "scenario": "starter.yaml",
        "template": "starter",
        "schema": "opsim.schema.json",
    }
    lines = (tmp_path / "starter.yaml").read_text(encoding="utf-8").splitlines()
    assert len(lines) < 40
    sections = [line for line in lines if (line[:1].isalpha() and line.endswith(":")) or "  # " in line]
    assert sections and all("  # " in line for line in sections)  # each section says what goes there


def test_the_short_one_is_checked_and_runs_as_it_stands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    opsim("init", "-o", "my.yaml")
    assert opsim("check", "my.yaml")[0] == 0
    assert opsim("run", "my.yaml", "-o", "out", "--replications", 2)[0] == 0
    assert {one.parent.name for one in tmp_path.glob("out/*/report.html")} == {"base", "busy", "busy_with_three"}


def test_no_file_is_written_over(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("mine")
    code, _, complaint = opsim("init", "-o", path)
    assert code == 2 and complaint.startswith(f"{path} is there already")
    assert [one.name for one in tmp_path.iterdir()] == ["mine.yaml"] and path.read_text() == "mine"


def test_a_schema_that_is_there_is_left_as_it_is(tmp_path):
    (tmp_path / "opsim.schema.json").write_text("{}")
    assert opsim("init", "-o", tmp_path / "mine.yaml")[0] == 0
    assert (tmp_path / "opsim.schema.json").read_text() == "{}"


def test_an_unknown_template_gets_the_nearest_word(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = opsim("init", "serialline")
    assert (code, complaint) == (2, "no template 'serialline'; did you mean 'serial_line'?\n")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_made_is_a_mistake(tmp_path):
    (tmp_path / "file").write_text("")
    code, _, complaint = opsim("init", "-o", tmp_path / "file" / "mine.yaml")
    assert code == 2 and "file" in complaint


def test_the_templates_say_what_they_are(tmp_path):
    code, shown, _ = opsim("init", "--list")
    assert code == 0 and "A saturated line of three people" in shown
    templates = json.loads(opsim("init", "--list", "--json")[1])["templates"]
    assert set(templates) == set(shipped_scenarios()) and all(templates.values())
