import pytest

from opsim.results import Result, events_name, lacking_rows, read_object


def result(folder, n, there):
    (folder / "events").mkdir()
    for number in there:
        (folder / "events" / events_name(number)).touch()
    return Result(folder, {"replications": n})


@pytest.mark.parametrize(
    ("there", "said"),
    [
        ((0, 1, 2), ""),
        ((0, 1, 2, 3), ""),
        ((), "no rows of events here, expected events/replication_00000.parquet; run it again"),
        ((1, 2), "found no rows of replication 0, expected 0 to 2"),
        ((1,), "found no rows of replication 0, 2, expected 0 to 2"),
        ((0, 1, 3), "found no rows of replication 2, expected 0 to 2"),
    ],
)
def test_replications_whose_rows_are_gone_are_named(tmp_path, there, said):
    found = lacking_rows(result(tmp_path, 3, there))
    assert said in found and bool(said) == bool(found)


@pytest.mark.parametrize("written", [b"{\n", b"\xff\xfe", b"", b"[]"])
def test_a_file_that_is_no_json_object_is_named(tmp_path, written):
    (tmp_path / "manifest.json").write_bytes(written)
    with pytest.raises(ValueError, match=r"manifest\.json: .*the manifest of a run"):
        read_object(tmp_path / "manifest.json", "the manifest of a run")


def test_an_object_is_read_as_it_was_written(tmp_path):
    (tmp_path / "x.json").write_text('{"a": [1, "é"]}', encoding="utf-8")
    assert read_object(tmp_path / "x.json", "anything") == {"a": [1, "é"]}
