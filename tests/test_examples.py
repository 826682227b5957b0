"""Every example prints what stands beside it in its .out file. ``python tests/test_examples.py`` renews them."""

import io
from contextlib import redirect_stdout
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("*.py"))
LONG = ("03", "07", "08", "09")
"""Which take seconds each, and are run by ``make evidence``."""


def printed(example: Path) -> str:
    """What it prints, run here: a process of its own would load compiled code anew for each."""
    with redirect_stdout(io.StringIO()) as out:
        exec(compile(example.read_text(encoding="utf-8"), str(example), "exec"), {"__name__": "__main__"})
    return out.getvalue()


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
