import json
import re

import pytest

from opsim.export.ocel import write_ocel_json
from tests.json_schema import complaints
from tests.opsim.export.hostile import HARMFUL, hostile
from tests.opsim.export.made_export import MANY, made, ran
from tests.opsim.export.ocel20_schema import SCHEMA

DATE_TIME = re.compile(r"[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}\.[0-9]{6}Z")


def without_format(schema):
    """The words that our validator knows; times are looked at by themselves."""
    if isinstance(schema, dict):
        return {key: without_format(value) for key, value in schema.items() if key != "format"}
    return schema


@pytest.fixture(scope="module", params=[*MANY, "hostile"])
def document(request, tmp_path_factory):
    log, plan = ran(MANY[0] if request.param == "hostile" else request.param)
    if request.param == "hostile":
        log, plan = hostile(log, plan)
    found, path = made(log, plan), tmp_path_factory.mktemp("ocel") / "log.jsonocel"
    write_ocel_json(found, path)
    return found, json.loads(path.read_text(encoding="utf-8")), path


def test_it_is_what_the_published_schema_asks_for(document):
    _, read, _ = document
    assert list(complaints(read, without_format(SCHEMA))) == []
    times = [one["time"] for one in read["events"]]
    times += [value["time"] for one in read["objects"] for value in one["attributes"]]
    assert all(DATE_TIME.fullmatch(time) for time in times)


def test_it_holds_every_event_and_object_as_they_are(document):
    found, read, _ = document
    assert [one.id for one in found.events()] == [one["id"] for one in read["events"]]
    assert [one.id for one in found.things()] == [one["id"] for one in read["objects"]]
    some = dict(zip([one.id for one in found.events()], found.events()))
    for one in read["events"][::97]:
        event = some[one["id"]]
        assert {value["name"]: value["value"] for value in one["attributes"]} == {
            name: value if isinstance(value, str) else repr(value) for name, value in event.values
        }
        assert tuple((near["objectId"], near["qualifier"]) for near in one["relationships"]) == event.objects


def test_the_same_log_gives_the_same_bytes(document, tmp_path):
    found, _, path = document
    write_ocel_json(found, tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == path.read_bytes()


def test_harmful_names_come_back_as_they_were(tmp_path):
    log, plan = hostile(*ran("pump_plant"))
    write_ocel_json(made(log, plan), tmp_path / "log.json")
    read = json.loads((tmp_path / "log.json").read_text(encoding="utf-8"))
    names = {one["id"] for one in read["objects"]}
    assert {f"worker {name}" for name in HARMFUL} <= names
    assert [path.name for path in tmp_path.iterdir()] == ["log.json"]


def test_nothing_is_left_where_it_cannot_be_finished(tmp_path):
    log, plan = ran("pump_plant")
    (tmp_path / "folder").mkdir()
    with pytest.raises(OSError, match="folder"):
        write_ocel_json(made(log, plan), tmp_path / "folder")
    assert list((tmp_path).iterdir()) == [tmp_path / "folder"]
