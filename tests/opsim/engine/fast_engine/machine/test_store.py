"""Machine code on disk: whole or not at all, found by what it was compiled from, and forgotten when others came."""

import os

import pytest

from opsim.engine.fast_engine.machine import code_cache
from opsim.engine.fast_engine.machine.code_cache import MOST_FOLDERS, PREFIX, Code

CODE = Code("some_function", ("exp", "memset"), b"\x00\x01 machine code \n and more")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(code_cache, "folder", lambda: tmp_path / f"{PREFIX}now")
    monkeypatch.setattr(code_cache, "shipped", lambda: None)
    return tmp_path / f"{PREFIX}now"


def a_step(n):
    return n


def test_what_is_kept_is_read_again(folder):
    path = code_cache.path_of(a_step, 7)
    assert code_cache.read(path) is None
    assert code_cache.keep(path, CODE)
    assert code_cache.read(path) == CODE
    assert [one.name for one in folder.iterdir()] == [path.name]  # nothing is left beside it


@pytest.mark.parametrize("harm", [lambda data: data[:-1], lambda data: b"", lambda data: data[:40] + b"?" + data[41:]])
def test_a_file_that_is_not_whole_is_as_none(folder, harm):
    path = code_cache.path_of(a_step, 7)
    code_cache.keep(path, CODE)
    path.write_bytes(harm(path.read_bytes()))
    assert code_cache.read(path) is None
    code_cache.keep(path, CODE)
    assert code_cache.read(path) == CODE


@pytest.fixture
def image(tmp_path, monkeypatch, folder):
    """A step that was shipped, and the folder where that is."""
    code_cache.keep(code_cache.path_of(a_step, 7), CODE)
    there = folder.rename(tmp_path / "shipped")
    monkeypatch.setattr(code_cache, "shipped", lambda: there)
    return there


@pytest.mark.parametrize("writable", [True, False])
def test_what_an_image_holds_is_read_by_who_cannot_write_there_and_not_changed(image, folder, monkeypatch, writable):
    if not writable:
        monkeypatch.setattr(code_cache, "folder", lambda: None)
    path = code_cache.path_of(a_step, 7)
    assert code_cache.is_kept(path) and code_cache.read(path) == CODE and not folder.exists()
    before = [(one.name, one.stat().st_mtime_ns) for one in image.iterdir()]
    assert code_cache.keep(path, Code("newer", (), b"")) == writable
    assert code_cache.read(path).name == ("newer" if writable else CODE.name)
    assert [(one.name, one.stat().st_mtime_ns) for one in image.iterdir()] == before


def test_a_shipped_file_that_is_not_whole_is_as_none_and_its_better_is_kept_apart(image):
    path = code_cache.path_of(a_step, 7)
    (image / path.name).write_bytes(b"half")
    assert code_cache.read(path) is None
    assert code_cache.keep(path, CODE) and code_cache.read(path) == CODE


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


def test_where_nothing_can_be_written_nothing_is_kept(monkeypatch):
    monkeypatch.setattr(code_cache, "folder", lambda: None)
    monkeypatch.setattr(code_cache, "shipped", lambda: None)
    path = code_cache.path_of(a_step, 7)
    assert path is None
    assert not code_cache.keep(path, CODE)
    assert code_cache.read(path) is None


def test_a_place_that_turns_out_to_be_none_is_no_mistake(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setattr(code_cache, "folder", lambda: tmp_path / "file" / "steps-x")
    assert not code_cache.keep(code_cache.path_of(a_step, 7), CODE)


def test_a_changed_source_has_another_file(folder, monkeypatch):
    before = code_cache.path_of(a_step, 7)
    monkeypatch.setattr(code_cache, "stamp_of", lambda file: "changed")
    assert code_cache.path_of(a_step, 7) != before


@pytest.mark.parametrize("change", ["sources", "numba", "python"])
def test_another_stamp_or_version_has_another_folder(monkeypatch, change):
    before = code_cache._key()
    assert code_cache._key() == before
    if change == "sources":
        monkeypatch.setattr(code_cache, "STAMP", "another")
    elif change == "numba":
        monkeypatch.setattr("numba.__version__", "0.0.1")
    else:
        monkeypatch.setattr(code_cache.sys, "version", "4.0.0")
    assert code_cache._key() != before


def test_of_many_folders_those_not_used_for_longest_are_removed(tmp_path, monkeypatch):
    for age in range(10):
        (tmp_path / f"{PREFIX}{age}").mkdir()
        os.utime(tmp_path / f"{PREFIX}{age}", (1e9 - age, 1e9 - age))
    (tmp_path / "others").mkdir()
    monkeypatch.setattr(code_cache, "folder", lambda: tmp_path / f"{PREFIX}new")
    code_cache.keep(code_cache.path_of(a_step, 7), CODE)
    left = {one.name for one in tmp_path.iterdir()}
    assert left == {"others", f"{PREFIX}new", *(f"{PREFIX}{age}" for age in range(MOST_FOLDERS - 1))}
