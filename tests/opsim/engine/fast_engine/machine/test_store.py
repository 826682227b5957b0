"""Machine code on disk: whole or not at all, found by what it was compiled from, and forgotten when others came."""

import os

import pytest

from opsim.engine.fast_engine.machine import store
from opsim.engine.fast_engine.machine.store import MOST_FOLDERS, PREFIX, Code

CODE = Code("some_function", ("exp", "memset"), b"\x00\x01 machine code \n and more")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "folder", lambda: tmp_path / f"{PREFIX}now")
    monkeypatch.setattr(store, "shipped", lambda: None)
    return tmp_path / f"{PREFIX}now"


def a_step(n):
    return n


def test_what_is_kept_is_read_again(folder):
    path = store.path_of(a_step, 7)
    assert store.read(path) is None
    assert store.keep(path, CODE)
    assert store.read(path) == CODE
    assert [one.name for one in folder.iterdir()] == [path.name]  # nothing is left beside it


@pytest.mark.parametrize("harm", [lambda data: data[:-1], lambda data: b"", lambda data: data[:40] + b"?" + data[41:]])
def test_a_file_that_is_not_whole_is_as_none(folder, harm):
    path = store.path_of(a_step, 7)
    store.keep(path, CODE)
    path.write_bytes(harm(path.read_bytes()))
    assert store.read(path) is None
    store.keep(path, CODE)
    assert store.read(path) == CODE


@pytest.fixture
def image(tmp_path, monkeypatch, folder):
    """A step that was shipped, and the folder where that is."""
    store.keep(store.path_of(a_step, 7), CODE)
    there = folder.rename(tmp_path / "shipped")
    monkeypatch.setattr(store, "shipped", lambda: there)
    return there


@pytest.mark.parametrize("writable", [True, False])
def test_what_an_image_holds_is_read_by_who_cannot_write_there_and_not_changed(image, folder, monkeypatch, writable):
    if not writable:
        monkeypatch.setattr(store, "folder", lambda: None)
    path = store.path_of(a_step, 7)
    assert store.is_kept(path) and store.read(path) == CODE and not folder.exists()
    before = [(one.name, one.stat().st_mtime_ns) for one in image.iterdir()]
    assert store.keep(path, Code("newer", (), b"")) == writable
    assert store.read(path).name == ("newer" if writable else CODE.name)
    assert [(one.name, one.stat().st_mtime_ns) for one in image.iterdir()] == before


def test_a_shipped_file_that_is_not_whole_is_as_none_and_its_better_is_kept_apart(image):
    path = store.path_of(a_step, 7)
    (image / path.name).write_bytes(b"half")
    assert store.read(path) is None
    assert store.keep(path, CODE) and store.read(path) == CODE


@pytest.mark.parametrize("named", [True, False])
def test_machine_code_is_shipped_beside_the_sources_unless_it_is_said_where_to_look(tmp_path, monkeypatch, named):
    monkeypatch.setattr(store, "__file__", str(tmp_path / "store.py"))
    there = tmp_path / "__pycache__" / (PREFIX + store._key())
    there.mkdir(parents=True)
    monkeypatch.setattr("numba.config.CACHE_DIR", "elsewhere" if named else "")
    monkeypatch.setattr(store, "folder", lambda: tmp_path / "home")
    assert store.shipped.__wrapped__() == (None if named else there)
    monkeypatch.setattr(store, "folder", lambda: there)
    assert store.shipped.__wrapped__() is None


def test_where_nothing_can_be_written_nothing_is_kept(monkeypatch):
    monkeypatch.setattr(store, "folder", lambda: None)
    monkeypatch.setattr(store, "shipped", lambda: None)
    path = store.path_of(a_step, 7)
    assert path is None
    assert not store.keep(path, CODE)
    assert store.read(path) is None


def test_a_place_that_turns_out_to_be_none_is_no_mistake(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setattr(store, "folder", lambda: tmp_path / "file" / "steps-x")
    assert not store.keep(store.path_of(a_step, 7), CODE)


def test_a_changed_source_has_another_file(folder, monkeypatch):
    before = store.path_of(a_step, 7)
    monkeypatch.setattr(store, "stamp_of", lambda file: "changed")
    assert store.path_of(a_step, 7) != before


@pytest.mark.parametrize("change", ["sources", "numba", "python"])
def test_another_stamp_or_version_has_another_folder(monkeypatch, change):
    before = store._key()
    assert store._key() == before
    if change == "sources":
        monkeypatch.setattr(store, "STAMP", "another")
    elif change == "numba":
        monkeypatch.setattr("numba.__version__", "0.0.1")
    else:
        monkeypatch.setattr(store.sys, "version", "4.0.0")
    assert store._key() != before


def test_of_many_folders_those_not_used_for_longest_are_removed(tmp_path, monkeypatch):
    for age in range(10):
        (tmp_path / f"{PREFIX}{age}").mkdir()
        os.utime(tmp_path / f"{PREFIX}{age}", (1e9 - age, 1e9 - age))
    (tmp_path / "others").mkdir()
    monkeypatch.setattr(store, "folder", lambda: tmp_path / f"{PREFIX}new")
    store.keep(store.path_of(a_step, 7), CODE)
    left = {one.name for one in tmp_path.iterdir()}
    assert left == {"others", f"{PREFIX}new", *(f"{PREFIX}{age}" for age in range(MOST_FOLDERS - 1))}
