"""Machine code on disk is that of today's sources: whatever is compiled into steps counts for the stamp."""

import ast
from importlib.util import find_spec
from pathlib import Path

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
    files = [*ENGINE.rglob("*.py"), *(ENGINE.parent / "floor").rglob("*.py")]
    steps = [path for path in files if "@step" in path.read_text(encoding="utf-8")]
    assert len(steps) > 40
    known = set(sources())
    lacking = {
        str(other)
        for path in steps
        for other in imported(path)
        if other not in known and other.parent != ENGINE / "machine" and other.name != "__init__.py"
    }
    assert lacking == set()
