import json

from opsim.scenario.json_schema import json_schema
from tests.opsim.cli.calls import opsim


def test_the_schema_is_printed():
    code, shown, _ = opsim("schema")
    assert code == 0 and json.loads(shown) == json_schema()


def test_the_schema_is_written_to_a_file(tmp_path):
    path = tmp_path / "opsim.schema.json"
    assert opsim("schema", "-o", path) == (0, f"schema {path}\n", "")
    assert json.loads(path.read_text(encoding="utf-8")) == json_schema()
    assert json.loads(opsim("schema", "-o", path, "--json")[1]) == {"schema": str(path)}


def test_a_file_that_cannot_be_written_is_a_mistake(tmp_path):
    code, _, complaint = opsim("schema", "-o", tmp_path)
    assert code == 2 and str(tmp_path) in complaint
