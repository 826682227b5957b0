"""The stamp of the sources: it stands in every type, and is another one as soon as a source is."""

import os

import pytest

from opsim.engine.fast_engine.machine import stamp
from opsim.engine.fast_engine.machine.structs import Ref


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
    monkeypatch.setattr(stamp, "ENGINE", tmp_path / "engine" / "fast")
    monkeypatch.setattr(stamp, "OPSIM", tmp_path)
    monkeypatch.setattr(stamp, "COMPILED_TOO", (tmp_path / "engine",))
    monkeypatch.setattr(stamp, "SINGLE", ())
    monkeypatch.delenv("OPSIM_STAMP", raising=False)
    return tmp_path / "engine"


@pytest.mark.parametrize("name", ["fast/a.py", "fast/machine/lists.py", "rules/b.py"])
def test_a_source_of_another_size_or_time_has_another_stamp(engine, name):
    before = stamp._stamp()
    assert stamp._stamp() == before
    (engine / name).write_text("one = 100\n")
    larger = stamp._stamp()
    os.utime(engine / name, (1, 1))
    assert len({before, larger, stamp._stamp()}) == 3


def test_a_new_source_and_one_that_is_gone_have_another_stamp(engine):
    before = stamp._stamp()
    (engine / "fast" / "new.py").write_text("")
    assert stamp._stamp() != before
    (engine / "fast" / "new.py").unlink()
    assert stamp._stamp() == before


def test_what_is_not_compiled_does_not_count(engine):
    before = stamp._stamp()
    (engine / "fast" / "machine" / "table.py").write_text("two = 2\n")
    assert stamp._stamp() == before


def test_the_stamp_stands_in_every_type():
    assert stamp.STAMP in Ref("Floor").name
