"""Machine code on disk: whole or not at all, found by what it was compiled from, and forgotten when others came."""

import os

import pytest

from opsim.engine.fast_engine.machine import code_cache
from opsim.engine.fast_engine.machine.code_cache import MOST_FOLDERS, PREFIX, Code, keep, kept

CODE = Code({7: "a", 3: "b"}, (5, 6), {9: ("OverflowError", "too many")}, b"\x00\x01 machine code \n and more")
OTHER = Code({8: "a"}, (), {}, b"more of it")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(code_cache, "folder", lambda: tmp_path / f"{PREFIX}now")
    monkeypatch.setattr(code_cache, "shipped", lambda: None)
    return tmp_path / f"{PREFIX}now"


def test_what_is_kept_is_read_again(folder):
    assert kept() == []
    assert keep(CODE) and keep(OTHER)
    assert {one.name: one for one in kept()} == {CODE.name: CODE, OTHER.name: OTHER}
    assert len(list(folder.iterdir())) == 2  # nothing is left beside them


def test_the_same_steps_of_another_file_take_the_place_of_the_old_ones(folder):
    newer = Code({7: "c", 3: "b"}, (), {}, b"newer")
    keep(CODE)
    keep(newer)
    assert kept() == [newer]


@pytest.mark.parametrize("harm", [lambda data: data[:-1], lambda data: b"", lambda data: data[:40] + b"?" + data[41:]])
def test_a_file_that_is_not_whole_is_as_none(folder, harm):
    keep(CODE)
    (path,) = folder.iterdir()
    path.write_bytes(harm(path.read_bytes()))
    assert kept() == []
    keep(CODE)
    assert kept() == [CODE]


@pytest.fixture
def image(tmp_path, monkeypatch, folder):
    """The folder where a file was shipped."""
    keep(CODE)
    there = folder.rename(tmp_path / "shipped")
    monkeypatch.setattr(code_cache, "shipped", lambda: there)
    return there


@pytest.mark.parametrize("writable", [True, False])
def test_what_an_image_holds_is_read_by_who_cannot_write_there_and_not_changed(image, folder, monkeypatch, writable):
    if not writable:
        monkeypatch.setattr(code_cache, "folder", lambda: None)
    assert kept() == [CODE] and not folder.exists()
    before = [(one.name, one.stat().st_mtime_ns) for one in image.iterdir()]
    assert keep(OTHER) == writable
    assert kept() == ([OTHER, CODE] if writable else [CODE])
    assert [(one.name, one.stat().st_mtime_ns) for one in image.iterdir()] == before


def test_a_shipped_file_that_is_not_whole_is_as_none_and_its_better_is_kept_apart(image):
    (path,) = image.iterdir()
    path.write_bytes(b"half")
    assert kept() == []
    assert keep(CODE) and kept() == [CODE] and path.read_bytes() == b"half"


@pytest.mark.parametrize("named", [True, False])
def test_machine_code_is_shipped_beside_the_sources_unless_it_is_said_where_to_look(tmp_path, monkeypatch, named):
    monkeypatch.setattr(code_cache, "__file__", str(tmp_path / "store.py"))
    there = tmp_path / "__pycache__" / (PREFIX + code_cache._key())
    there.mkdir(parents=True)
    monkeypatch.setattr("numba.config.CACHE_DIR", "elsewhere" if named else "")
    monkeypatch.setattr(code_cache, "folder", lambda: tmp_path / "home")
    assert code_cache.shipped.__wrapped__() == (None if named else there)
    monkeypatch.setattr(code_cache, "folder", lambda: there)
    assert code_cache.shipped.__wrapped__() is None


@pytest.mark.parametrize("there", ["none", "a file"])
def test_where_nothing_can_be_written_nothing_is_kept(tmp_path, monkeypatch, there):
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setattr(code_cache, "folder", lambda: None if there == "none" else tmp_path / "file" / "steps-x")
    monkeypatch.setattr(code_cache, "shipped", lambda: None)
    assert not keep(CODE) and kept() == []
    code_cache.mark("luck")
    assert not code_cache.is_marked("luck")


def test_what_is_compiled_besides_is_noted(folder):
    assert not code_cache.is_marked("luck")
    code_cache.mark("luck")
    assert code_cache.is_marked("luck") and not code_cache.is_marked("emulated")


@pytest.mark.parametrize("change", ["sources", "numba", "llvmlite", "python"])
def test_another_stamp_or_version_has_another_folder(monkeypatch, change):
    before = code_cache._key()
    assert code_cache._key() == before
    if change == "sources":
        monkeypatch.setattr(code_cache, "STAMP", "another")
    elif change == "python":
        monkeypatch.setattr(code_cache.sys, "version", "4.0.0")
    else:
        monkeypatch.setattr(f"{change}.__version__", "0.0.1")
    assert code_cache._key() != before


def test_of_many_folders_those_not_used_for_longest_are_removed(tmp_path, monkeypatch):
    for age in range(10):
        (tmp_path / f"{PREFIX}{age}").mkdir()
        os.utime(tmp_path / f"{PREFIX}{age}", (1e9 - age, 1e9 - age))
    (tmp_path / "others").mkdir()
    monkeypatch.setattr(code_cache, "folder", lambda: tmp_path / f"{PREFIX}new")
    keep(CODE)
    left = {one.name for one in tmp_path.iterdir()}
    assert left == {"others", f"{PREFIX}new", *(f"{PREFIX}{age}" for age in range(MOST_FOLDERS - 1))}
