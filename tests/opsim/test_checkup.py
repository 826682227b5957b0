from importlib import metadata

import pytest

from opsim import checkup
from opsim.checkup import NOTE, OK, WRONG, findings
from opsim.engine.fast_engine.machine import code_cache


def found(what):
    return next(one for one in findings() if one.what == what)


def test_here_nothing_is_wrong_and_every_required_package_is_looked_at():
    states = {one.what: one.state for one in findings()}
    assert WRONG not in states.values()
    assert {"Python", "numpy", "simpy", "pydantic", "shipped scenarios", "motion libraries", "processes"} <= set(states)


@pytest.fixture
def unread(monkeypatch):
    """Shipped scenarios and libraries are not looked at."""
    for question in ("_scenarios", "_libraries"):
        monkeypatch.setattr(checkup, question, lambda: iter(()))


def test_a_package_that_is_missing_or_too_old_is_wrong(unread, monkeypatch):
    version = metadata.version

    def other(name):
        if name == "rich":
            raise metadata.PackageNotFoundError
        return "1.9.3" if name == "numpy" else version(name)

    monkeypatch.setattr(metadata, "version", other)
    assert found("rich").state == WRONG and "pip install" in found("rich").said
    assert (found("numpy").state, found("numpy").said) == (WRONG, "1.9.3; 2.0 is needed")
    assert found("scipy").state == OK


def test_a_broken_shipped_scenario_is_wrong(monkeypatch, tmp_path):
    (tmp_path / "libraries").mkdir()
    (tmp_path / "queue.yaml").write_text("opsim: 1\n")
    (tmp_path / "libraries/moves.npz").write_bytes(b"nothing")
    monkeypatch.setattr("opsim.shipped.shipped_folder", lambda: tmp_path)
    assert found("shipped scenarios").state == WRONG and "queue: " in found("shipped scenarios").said
    assert found("motion libraries").state == WRONG and "not a motion library" in found("motion libraries").said


def test_where_nothing_can_be_written_it_is_said_and_not_wrong(unread, monkeypatch):
    monkeypatch.setattr(checkup, "_writable", lambda _: False)
    assert found("compiled code").state == found("this folder").state == NOTE


def test_how_much_of_the_fast_engine_is_compiled_is_said_with_its_place(unread, monkeypatch, tmp_path):
    monkeypatch.setattr(code_cache, "folder", lambda: tmp_path)
    monkeypatch.setattr(code_cache, "shipped", lambda: None)
    assert found("fast engine").said == f"compiled when it is first used, in {tmp_path}"
    code_cache.keep(code_cache.Code({7: "", 8: ""}, (), {}, b""))
    assert found("fast engine").said == f"2 of its steps are compiled, in {tmp_path}"
    monkeypatch.setattr(code_cache, "shipped", lambda: tmp_path / "image")
    assert found("fast engine").said == f"2 of its steps are compiled, in {tmp_path / 'image'} and {tmp_path}"


@pytest.mark.parametrize("name", ["made", "made/in/it"])
def test_a_folder_that_can_be_made_can_be_written(tmp_path, name):
    assert checkup._writable(tmp_path / name)


def test_a_file_is_no_folder(tmp_path):
    (tmp_path / "file").write_text("")
    assert not checkup._writable(tmp_path / "file")


def test_why_there_is_no_fast_engine_is_said(unread, monkeypatch):
    monkeypatch.setattr("opsim.engine.fast_engine.machine.code_cache.folder", lambda: None)
    assert found("fast engine").said == "compiled anew by each command, as it can be kept nowhere"
    monkeypatch.setattr("numba.config.DISABLE_JIT", 1)
    assert found("fast engine").said.startswith("off, as NUMBA_DISABLE_JIT is set")


def test_a_place_for_compiled_code_that_cannot_be_written_is_named(unread, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file"))
    assert found("compiled code").state == NOTE and str(tmp_path / "file") in found("compiled code").said
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert found("compiled code").state == OK
