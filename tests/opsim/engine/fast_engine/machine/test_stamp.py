"""The stamp of the sources: it stands in every type, and is another one as soon as a source is."""

import os

import pytest

from opsim.engine.fast_engine.machine import code_cache
from opsim.engine.fast_engine.machine.structs import Ref


def stamp_now():
    """As a process finds it that begins now."""
    code_cache.stamp_of.cache_clear()
    return code_cache._stamp()


@pytest.fixture
def engine(tmp_path, monkeypatch):
    """A small engine with rules beside it."""
    for name in (
        "engine/fast/machine/table.py",
        "engine/fast/machine/lists.py",
        "engine/fast/a.py",
        "engine/rules/b.py",
    ):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("one = 1\n")
    monkeypatch.setattr(code_cache, "ENGINE", tmp_path / "engine" / "fast")
    monkeypatch.setattr(code_cache, "OPSIM", tmp_path)
    monkeypatch.setattr(code_cache, "COMPILED_TOO", (tmp_path / "engine",))
    monkeypatch.setattr(code_cache, "SINGLE", ())
    return tmp_path / "engine"


@pytest.mark.parametrize("name", ["fast/a.py", "fast/machine/lists.py", "rules/b.py"])
def test_a_source_of_another_content_has_another_stamp_and_one_of_another_time_has_not(engine, name):
    before = stamp_now()
    os.utime(engine / name, (1, 1))
    assert stamp_now() == before
    (engine / name).write_text("two = 1\n")
    os.utime(engine / name, (1, 1))
    assert stamp_now() != before


def test_a_file_counts_as_it_was_when_it_was_first_looked_at(engine):
    """What is compiled is what was imported, also where the file is another one by then."""
    path = str(engine / "fast" / "a.py")
    before = code_cache.stamp_of(path)
    (engine / "fast" / "a.py").write_text("two = 2\n")
    assert code_cache.stamp_of(path) == before
    code_cache.stamp_of.cache_clear()
    assert code_cache.stamp_of(path) != before and code_cache.stamp_of(path + "x") == ""


def test_a_new_source_and_one_that_is_gone_have_another_stamp(engine):
    before = stamp_now()
    (engine / "fast" / "new.py").write_text("")
    assert stamp_now() != before
    (engine / "fast" / "new.py").unlink()
    assert stamp_now() == before


def test_what_is_not_compiled_does_not_count(engine):
    before = stamp_now()
    (engine / "fast" / "machine" / "table.py").write_text("two = 2\n")
    assert stamp_now() == before


def test_the_stamp_stands_in_every_type():
    assert code_cache.STAMP in Ref("Floor").name
