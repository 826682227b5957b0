"""Machine code on disk is that of today's sources: whatever is compiled into steps counts for the stamp.

The stamp of the sources is another one as soon as a source is.
"""

import ast
import os
from importlib.util import find_spec
from pathlib import Path

import pytest

from opsim.engine.fast_engine.lowering import written
from opsim.engine.fast_engine.machine import code_cache
from opsim.engine.fast_engine.machine.code_cache import ENGINE, sources


def imported(path: Path) -> set[Path]:
    """The files of opsim that a file takes names from, at its top."""
    found = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("opsim."):
            names = [node.module, *(f"{node.module}.{one.name}" for one in node.names)]
            found |= {Path(spec.origin) for name in names if (spec := _spec(name)) is not None and spec.origin}
    return found


def _spec(name):
    try:
        return find_spec(name)
    except ModuleNotFoundError:  # a name in a module, not a module
        return None


def test_every_file_that_steps_take_names_from_counts():
    files = [*ENGINE.rglob("*.py"), *written().values()]
    steps = [path for path in files if "@step" in path.read_text(encoding="utf-8")]
    assert len(steps) > 30
    known = set(sources())
    assert all(path.is_file() for path in known), "a file that was moved counts no more"
    lacking = {
        str(other)
        for path in steps
        for other in imported(path)
        if other not in known and other.parent != ENGINE / "machine" and other.name != "__init__.py"
    }
    assert lacking == set()


def stamp_now():
    """As a process finds it that begins now."""
    code_cache.source_of.cache_clear()
    return code_cache._stamp()


@pytest.fixture
def engine(tmp_path, monkeypatch):
    """A small engine with rules beside it."""
    for name in (
        "engine/fast/machine/arena.py",
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
    code_cache.source_of.cache_clear()
    assert code_cache.stamp_of(path) != before and code_cache.stamp_of(path + "x") == ""


def test_a_new_source_and_one_that_is_gone_have_another_stamp(engine):
    before = stamp_now()
    (engine / "fast" / "new.py").write_text("")
    assert stamp_now() != before
    (engine / "fast" / "new.py").unlink()
    assert stamp_now() == before


def test_what_is_not_compiled_does_not_count(engine):
    before = stamp_now()
    (engine / "fast" / "machine" / "arena.py").write_text("two = 2\n")
    assert stamp_now() == before
