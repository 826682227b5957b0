"""Where the public recordings lie: beside the checkout, or where OPSIM_DATA says. They are not part of the project."""

import os
from pathlib import Path

import pytest


def data_folder():
    """The folder with ``motion`` and ``reference`` in it; it need not exist."""
    given = os.environ.get("OPSIM_DATA")
    return Path(given) if given else Path(__file__).resolve().parents[1].parent / "shared" / "data"


def _file(*parts):
    path = data_folder().joinpath(*parts)
    if not path.exists():
        pytest.skip(f"needs {'/'.join(parts)} in ../shared/data or in $OPSIM_DATA")
    return path


def recording(name):
    """The path of ``motion/<name>.npz``; skips the test where the recordings are not at hand."""
    return _file("motion", f"{name}.npz")


def reference(name):
    """The path of ``reference/<name>``; skips the test where it is not at hand."""
    return _file("reference", name)


def raw(name):
    """The path of ``motion/raw/<name>``, a file as its producer wrote it; skips the test where it is not at hand."""
    return _file("motion", "raw", name)
