"""Every example prints what stands beside it in its .out file. ``python tests/test_examples.py`` renews them."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("*.py"))
LONG = ("03", "07", "08")
"""Which take seconds each, and are run by ``make evidence``."""


def printed(example: Path) -> str:
    return subprocess.run([sys.executable, str(example)], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize(
    "example",
    [pytest.param(path, marks=pytest.mark.slow) if path.name.startswith(LONG) else path for path in EXAMPLES],
    ids=lambda path: path.name,
)
def test_an_example_prints_what_it_promises(example):
    assert printed(example) == example.with_suffix(".out").read_text()


def test_there_are_examples():
    assert len(EXAMPLES) >= 3


if __name__ == "__main__":
    for path in EXAMPLES:
        path.with_suffix(".out").write_text(printed(path))
        print(path.name, path.with_suffix(".out").read_text(), sep="\n")
