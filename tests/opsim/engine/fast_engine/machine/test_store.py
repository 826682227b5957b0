"""Machine code on disk: whole or not at all, found by what it was compiled from, and forgotten when others came."""

import os

import pytest

from opsim.engine.fast_engine.machine import store
from opsim.engine.fast_engine.machine.store import MOST_FOLDERS, PREFIX, Code

CODE = Code("some_function", ("exp", "memset"), b"\x00\x01 machine code \n and more")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "folder", lambda: tmp_path / f"{PREFIX}now")
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


def test_where_nothing_can_be_written_nothing_is_kept(monkeypatch):
    monkeypatch.setattr(store, "folder", lambda: None)
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
    monkeypatch.setattr(store, "_stamp_of", lambda file: "changed")
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
