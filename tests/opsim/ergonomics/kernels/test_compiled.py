"""Kernels kept on disk: compiled anew when a file changes whose functions are compiled into them."""

import os
import sys
from importlib import import_module

import numba
import pytest

from opsim.ergonomics.kernels import compiled as compiling
from opsim.ergonomics.kernels.compiled import called_from_c, compiled

HEAD = "from opsim.ergonomics.kernels.compiled import compiled\n\n"
INNERMOST = HEAD + "@compiled()\ndef weight():\n    return 2\n"
INNER = HEAD + "from innermost import weight\n\n@compiled()\ndef times(x):\n    return weight() * x\n"
OUTER = HEAD + "from inner import times\n\n@compiled()\ndef kernel(x):\n    return times(x) + 1\n"


@pytest.fixture
def files(tmp_path, monkeypatch):
    for name, text in (("innermost", INNERMOST), ("inner", INNER), ("outer", OUTER)):
        (tmp_path / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    yield tmp_path
    forgotten()


def forgotten():
    """As a process begins."""
    compiling._content_of.cache_clear()
    for name in ("innermost", "inner", "outer"):
        sys.modules.pop(name, None)


def asked():
    """(answer, how many were read from disk) of a process that begins now."""
    forgotten()
    kernel = import_module("outer").kernel
    return kernel(5), sum(kernel.stats.cache_hits.values())


def test_a_kernel_is_kept_until_a_file_changes_that_it_is_made_of(files):
    assert asked() == (11, 0)
    assert asked() == (11, 1)
    (files / "innermost.py").write_text(INNERMOST.replace("return 2", "return 3"))
    os.utime(files / "innermost.py", (1e9, 1e9))
    assert asked() == (16, 0)
    assert asked() == (16, 1)


def test_where_numba_keeps_it_otherwise_a_kernel_is_compiled_all_the_same():
    def double(x):
        return 2 * x

    assert compiling._seeing_helpers(3, double) == 3
    assert compiled()(double)(4) == 8


def test_what_is_wrong_besides_the_cache_is_said(monkeypatch):
    def fails(*_words, **_options):
        raise RuntimeError("out of luck")

    monkeypatch.setattr(numba, "njit", fails)
    with pytest.raises(RuntimeError, match="out of luck"):
        compiled()(lambda x: x)


CALLED = "def double(x):\n    return 2.0 * x\n"


def test_what_c_calls_is_kept_and_where_no_cache_can_be_written_compiled_all_the_same(tmp_path, monkeypatch):
    (tmp_path / "called.py").write_text(CALLED)
    monkeypatch.syspath_prepend(str(tmp_path))
    for hits, name in ((0, "double"), (1, "double")):
        sys.modules.pop("called", None)
        made = called_from_c(getattr(import_module("called"), name), "float64(float64)")
        assert (made.ctypes(4.0), made.cache_hits) == (8.0, hits)
    space = {}
    exec(CALLED, space)  # of no file: numba has no place for it
    assert called_from_c(space["double"], "float64(float64)").ctypes(4.0) == 8.0
